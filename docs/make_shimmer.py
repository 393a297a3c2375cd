#!/usr/bin/env python3
"""Writes the table of docs/techniques.md that sets what every technique does in time beside its still error.

docs/make_shimmer.py [PROGRAM]    the program to ask; build/release/app/gnomon where none is named
"""
import json
import subprocess
import sys

PROGRAM = sys.argv[1] if len(sys.argv) > 1 else "build/release/app/gnomon"
SIZE = ["--size", "640x360", "--map-size", "1024"]
FILM = ["--frames", "30", "--path", "orbit"]
ROWS = [(f"`{name}`", [name], []) for name in ("hard", "pcf", "pcss", "vsm", "esm", "evsm", "msm", "second-depth", "midpoint")]
ROWS += [("`hard`, snapped", ["hard"], ["--snap"]), ("`pcf`, snapped", ["pcf"], ["--snap"])]
ROWS += [("`csm`", ["csm"], []), ("`csm`, blended", ["csm"], ["--cascade-blend", "0.1"]),
         ("`csm`, not snapped", ["csm"], ["--no-snap"])]
ROWS += [("`lispsm`", ["lispsm"], []), ("`lispsm`, snapped", ["lispsm"], ["--snap"])]
ROWS += [("`izb`", ["izb"], []), ("`hybrid`", ["hybrid"], [])]


def asked(*words):
    done = subprocess.run([PROGRAM, *words, "--quiet", "--json", "-"], check=True, capture_output=True, text=True)
    return json.loads(done.stdout)["lights"][0]


def still(scene, technique, more):
    light = asked("compare", scene, *SIZE, "--runs", "1", "--technique", *technique, *more)
    error, texel = light["error"], light["map"]["texel_world"]["median"]
    seams = light.get("seams")
    return (f"{100 * error['wrong_fraction']:.3f} | {error['mean_absolute']:.5f} | {1000 * texel:.1f} | "
            f"{seams['changed'] if seams else ''}")


def row(scene, name, technique, more):
    film = asked("shimmer", scene, *SIZE, *FILM, "--technique", *technique, *more)
    steps = {step["cause"]: step["absolute"] for step in film["budget"]}
    mostly = max(film["by_label"], key=film["by_label"].get).replace("_", " ") if film["flips"] else ""
    return (f"| {name} | {still(scene, technique, more)} | {film['flips']} | {film['flips_per_receiver_second']:.4f} | "
            f"{film['error']['absolute']:.5f} | {film['edges']['drawn_texels_per_frame']:.3f} | {mostly} | "
            f"{steps['filter']:.5f} |")


def main():
    print("| technique | still: wrong % | still: mean error | texel, thousandths | still: seams | flips | per receiver and second | mean temporal error | "
          "edges, texels a frame | mostly by | filter step |\n|---|---:|---:|---:|---:|---:|---:|---:|---:|---|---:|")
    for name, technique, more in ROWS:
        print(row("courtyard", name, technique, more), flush=True)


main()
