#!/usr/bin/env python3
"""Drives the shadow lab through many random changes and watches its memory.

usage: lab_endurance.py GNOMON SCENE [CHANGES [SIZE]]      10000 changes at 640x360 unless said otherwise

Needs a display (Xvfb will do). Prints the program's own figures (frames, the longest, how quickly it answered) and
its resident memory after each of ten rounds of the same changes. Exit code 1 when the program fails or says anything of OpenGL.
"""
import os
import random
import re
import subprocess
import sys
import tempfile


rounds = 10


def change(rng):
    """One step of a script, of every kind that a lecture makes."""
    number = rng.uniform
    return rng.choice([
        lambda: f"set bias {number(0, 4):.3f}texel",
        lambda: f"set slope-bias {number(0, 2):.3f}",
        lambda: f"set normal-offset {number(0, 2):.3f}",
        lambda: f"set map-size {rng.choice([128, 256, 512, 1024])}",
        lambda: f"set technique {rng.choice(['hard', 'pcf', 'vsm', 'msm', 'second-depth', 'csm', 'hybrid'])}",
        lambda: f"set depth-format {rng.choice(['d16', 'd24', 'd32f'])}",
        lambda: f"set light-azimuth {number(-180, 180):.2f}",
        lambda: f"set light-elevation {number(10, 80):.2f}",
        lambda: f"set camera-orbit {number(-180, 180):.2f} {number(5, 60):.2f}",
        lambda: f"set view {rng.choice(['raster', 'raytrace', 'difference', 'labels', 'truth', 'gap', 'texels', 'depth'])}",
        lambda: f"set layout {rng.choice(['single', 'swipe', 'quad'])}",
        lambda: f"set theme {rng.choice(['dark', 'light'])}",
        lambda: f"set probe {rng.randrange(300)} {rng.randrange(200)}",
        lambda: f"set zoom {number(1, 8):.2f}",
        lambda: f"set ui-scale {rng.choice([1, 1.5, 2])}",
        lambda: f"set panels {rng.choice(['on', 'on', 'on', 'off'])}",
    ])()


def script(changes, size, seed=1):
    """Ten rounds of the same changes: after each the window shows the same, and what it holds more than before is lost."""
    lines = [f"set size {size}", "wait done"]
    for _ in range(rounds):
        rng = random.Random(seed)
        for i in range(changes // rounds):
            lines += [change(rng), f"wait {rng.randrange(1, 4)}"]
            if i % 100 == 99:
                lines.append("wait done")
        lines += ["wait done", "print"]
    return "\n".join(lines + ["quit"]) + "\n"


def resident_mb(pid):
    with open(f"/proc/{pid}/status", encoding="ascii") as status:
        return int(re.search(r"VmRSS:\s+(\d+)", status.read()).group(1)) / 1024


def main():
    gnomon, scene = sys.argv[1:3]
    changes = int(sys.argv[3]) if len(sys.argv) > 3 else 10000
    size = sys.argv[4] if len(sys.argv) > 4 else "640x360"
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "changes.txt")
        with open(path, "w", encoding="ascii") as file:
            file.write(script(changes, size))
        with open(os.path.join(folder, "stderr.txt"), "w+", encoding="utf-8") as stderr:
            program = subprocess.Popen([gnomon, "view", scene, "--script", path], stdout=subprocess.PIPE, stderr=stderr,
                                       text=True)
            after = []
            for _ in program.stdout:  # a command is printed after each round
                try:
                    after.append(resident_mb(program.pid))
                except (OSError, AttributeError):
                    break
                print(f"{after[-1]:.0f}", end=" ", flush=True)
            code = program.wait()
            stderr.seek(0)
            said = stderr.read()
    print("MB resident after each round")
    print(said.strip())
    return 0 if code == 0 and len(after) == rounds and "OpenGL" not in said and "GL_" not in said else 1


if __name__ == "__main__":
    sys.exit(main())
