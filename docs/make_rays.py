#!/usr/bin/env python3
"""Writes the tables of docs/techniques.md about lights with a size: maps and few rays on the same pixels, still and in time.

docs/make_rays.py [PROGRAM]    the program to ask; build/release/app/gnomon where none is named
"""
import json
import subprocess
import sys

PROGRAM = sys.argv[1] if len(sys.argv) > 1 else "build/release/app/gnomon"
RATES = "docs/examples/rates/geforce-rtx-2070.json"
SCENES = [("penumbra", []), ("fence", ["--light-size", "0.53"]), ("courtyard", ["--light-size", "1"]),
          ("floating-box", ["--light-size", "2"]), ("wires", ["--light-size", "1"]), ("thin-wall", ["--light-size", "2"])]
MAPS = [("`hard`", ["hard"]), ("`pcf`", ["pcf"]), ("`pcss`", ["pcss"]), ("`pcss`, 4096", ["pcss", "--map-size", "4096"]), ("`vsm`", ["vsm"])]
RAYS = [(f"1 ray, `{name}`", ["rays", "--denoiser", name]) for name in ("none", "penumbra", "atrous", "svgf", "fidelityfx")]
RAYS += [("1 ray, `penumbra`, history 8", ["rays", "--history", "8"]), ("4 rays, `penumbra`", ["rays", "--rays", "4"]),
         ("16 rays, `none`", ["rays", "--rays", "16", "--denoiser", "none"])]
FILMED = [("`pcss`", ["pcss"]), ("1 ray, `none`", ["rays", "--denoiser", "none"]), ("1 ray, `penumbra`", ["rays"]),
          ("1 ray, `penumbra`, history 8", ["rays", "--history", "8"]), ("1 ray, `svgf`, history 8", ["rays", "--denoiser", "svgf", "--history", "8"])]


def asked(*words):
    done = subprocess.run([PROGRAM, *words, "--quiet", "--json", "-"], check=True, capture_output=True, text=True)
    return json.loads(done.stdout)["lights"][0]


def steps(budget, total):
    """The steps that make more than a tenth of the error, the largest first. The bias takes back what the slope in a texel adds."""
    sizes = {step["cause"].replace("_", " "): step["absolute"] for step in budget if step["cause"] not in ("slope", "bias")}
    sizes["slope and bias"] = abs(sum(step["signed"] for step in budget if step["cause"] in ("slope", "bias")))
    told = sorted((name for name in sizes if sizes[name] > 0.1 * total), key=lambda name: -sizes[name])
    return ", ".join(f"{name} {100 * sizes[name]:.2f}" for name in told)


def estimate(ms):
    return "–" if ms is None else f"{1000 * ms:.0f}"


def row(scene, size, name, technique):
    light = asked("compare", scene, *size, "--size", "480x270", "--samples", "256", "--runs", "1", "--rates", RATES, "--technique", *technique)
    cast, error = light["map"].get("rays"), light["error"]
    if cast:
        work = f"{cast['rays'] / cast['receivers']:.3g} | {cast['taps'] / cast['receivers']:.3g}"
    else:
        work = f"{light['lookups']['per_pixel']:.3g} | "
    print(f"| {name} | {100 * error['mean_absolute']:.3f} | {steps(light['budget'], error['mean_absolute'])} | "
          f"{100 * error['wrong_fraction']:.2f} | {error['flip']:.4f} | {work} | {estimate(light['estimate']['light_moves']['map_ms'])} |", flush=True)


def film(scene, size, name, technique):
    def told(*path):
        light = asked("shimmer", scene, *size, "--size", "320x180", "--samples", "64", "--frames", "16", *path, "--technique", *technique)
        return f"{100 * light['error']['absolute']:.3f} | {steps(light['budget'], light['error']['absolute'])}"
    print(f"| {name} | {told('--path', 'still')} | {told('--move', 'light', '--path', 'sun', '--speed', '0.05')} |", flush=True)


def main():
    for scene, size in SCENES:
        print(f"\n### {' '.join([scene, *size])}\n\n| | mean error, % | its largest steps, % | wrong, % | FLIP | lookups or rays a pixel | taps a pixel | estimate, µs |")
        print("|---|---:|---|---:|---:|---:|---:|---:|")
        for name, technique in MAPS + RAYS:
            row(scene, size, name, technique)
    print("\n### In time\n\n| courtyard --light-size 1 | still, % | its steps, % | the sun moves, % | its steps, % |\n|---|---:|---|---:|---|")
    for name, technique in FILMED:
        film("courtyard", ["--light-size", "1"], name, technique)


main()
