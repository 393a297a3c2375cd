#!/usr/bin/env python3
"""Gives random scenes and options to `gnomon compare`, and each of them again with other threads, bands and structures.

usage: random_compare.py GNOMON [RUNS [SEED]]      100 runs from seed 0 unless said otherwise

Prints what fails, hangs, does not add up, or is not the same to the last bit, with the seed that makes it again, and then how
many runs there were. Exit code 1 when there was any such. Left out are counts of work, which depend on the structure.
"""
import json
import math
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile

from same_results import differences, files_below

TECHNIQUES = ("hard", "pcf", "pcss", "vsm", "esm", "evsm", "msm", "second-depth", "midpoint", "csm", "lispsm", "cube", "izb", "hybrid")
WITHOUT_MAP, MOMENTS = ("izb", "hybrid"), ("vsm", "esm", "evsm", "msm")
PLANE_APPLIES = ("hard", "second-depth", "midpoint", "csm", "lispsm", "cube")
WORK = ("_per_ray", "accel", "ray_tests", "soft_shadow_rays", "triangle_test", "bytes", "costs")
SECONDS = 120


def number(rng, low, high):
    """Often a multiple of 1/4, so that things touch."""
    value = rng.uniform(low, high)
    return round(4 * value) / 4 if rng.random() < 0.5 else value


def place(rng):
    return [number(rng, -2, 2), number(rng, 0.25, 2.25), number(rng, -2, 2)]


def axis(rng):
    return rng.choice([[0, 1, 0], [1, 0, 0], [0, -1, 0], [1, 1, 0], [rng.gauss(0, 1), 1, rng.gauss(0, 1)]])


def material(rng, name):
    made = {"name": name, "diffuse": [rng.random() for _ in range(3)]}
    if rng.random() < 0.3:
        made["mirror"] = rng.choice([0.3, 0.7, 1])
    elif rng.random() < 0.2:
        made |= {"transmission": rng.choice([0.5, 1]), "ior": rng.choice([1, 1.33, 1.5])}
    if rng.random() < 0.3:
        made["texture"] = {"generate": {"kind": "checker"}, "scale": rng.choice([0.5, 3]), "filter": rng.choice(["bilinear", "nearest"])}
    if rng.random() < 0.2:
        made["double_sided"] = False
    if rng.random() < 0.1:
        made |= {"emission": rng.random(), "unlit": rng.random() < 0.5}
    return made


def shape(rng, name):
    cut = {"base": place(rng), "axis": axis(rng), "radius": 0.5, "height": 1, "closed": rng.random() < 0.5}
    functions = ["x^2+y^2+z^2-0.5", "x^2+y^2-z^2-0.1", "sin(3*x)*cos(3*y)+z", "max(abs(x),abs(y))-0.5+z*z"]
    kinds = {
        "sphere": {"center": place(rng), "radius": rng.choice([0.25, 0.5, 1])},
        "plane": {"point": [0, 0, 0], "normal": rng.choice([[0, 1, 0], [1, 3, 0]])},
        "ellipsoid": {"center": place(rng), "radii": [0.25, 1, 0.5], "rotate": {"axis": axis(rng), "degrees": 37}},
        "cylinder": cut, "cone": cut | {"top_radius": rng.choice([0, 0.25])}, "paraboloid": cut,
        "hyperboloid": {"center": place(rng), "axis": axis(rng), "radius": 0.5, "waist": 0.2, "height": 1},
        "torus": {"center": place(rng), "axis": axis(rng), "major_radius": 0.7, "minor_radius": 0.2},
        "implicit": {"function": rng.choice(functions), "box": [[-1, -1, -1], [1, 1, 1]], "center": place(rng)},
    }
    kind = rng.choice(list(kinds))
    return {"material": name, kind: kinds[kind]}


def mesh(rng, name):
    count = rng.randint(3, 30)
    loose = {"vertices": [place(rng) for _ in range(count)], "triangles": [rng.sample(range(count), 3) for _ in range(count)]}
    return {"name": name} | rng.choice([
        loose,
        {"generate": {"kind": "box", "size": [rng.choice([0.25, 1, 2]) for _ in range(3)]}},
        {"generate": {"kind": "teapot", "height": 1, "divisions": 3}},
        {"generate": {"kind": "tree", "height": 2, "trunk_radius": 0.1, "levels": 1, "leaves": 40, "leaf_size": 0.3, "spread": 1}},
    ])


def instance(rng, mesh_name, material_name):
    made = {"mesh": mesh_name, "material": material_name, "translate": place(rng)}
    if rng.random() < 0.5:
        made["rotate"] = {"axis": axis(rng), "degrees": rng.choice([90, 37, 180])}
    if rng.random() < 0.3:
        made["scale"] = rng.choice([0.5, [1, 2, 0.5], [-1, 1, 1]])
    if rng.random() < 0.3:
        made["repeat"] = {"count": [rng.randint(1, 4), rng.randint(1, 4)], "spacing": 1.2, "jitter": 0.3, "turn": True, "seed": 3}
    return made


def light(rng, name, kinds):
    kind = rng.choice(kinds)
    made = {"name": name, "type": kind, "intensity": 2 if kind == "directional" else 20}
    if kind == "directional":
        made["direction"] = [number(rng, -1, 1), -1, number(rng, -1, 1)]
    else:
        made["position"] = [number(rng, -3, 3), number(rng, 1, 5), number(rng, -3, 3)]
    if kind == "spot":
        made |= {"target": [number(rng, -1, 1), 0, number(rng, -1, 1)], "outer_angle_degrees": rng.choice([20, 40, 70])}
    if rng.random() < 0.3:
        size = {"angular_diameter_degrees": rng.choice([0.5, 30])} if kind == "directional" else {"sphere": {"radius": 0.2}}
        made |= size | {"shadow_samples": rng.choice([1, 4, 16])}
    return made


def scene(rng, technique):
    kinds = {"csm": ["directional"], "lispsm": ["directional"], "cube": ["point"]}.get(technique, ["directional", "point", "spot"])
    materials = [material(rng, f"m{i}") for i in range(rng.randint(1, 5))]
    names = [m["name"] for m in materials]
    meshes = [mesh(rng, f"mesh{i}") for i in range(rng.randint(0, 3))]
    floor = {"plane": {"point": [0, 0, 0], "normal": [0, 1, 0]}, "material": names[0]}
    return {
        "schema": "gnomon/scene/1",
        "camera": {"eye": [number(rng, 3, 5), number(rng, 1, 4), number(rng, 2, 5)], "target": [number(rng, -1, 1), 0.5, 0],
                   "vertical_fov_degrees": rng.choice([20, 40, 90])},
        "lights": [light(rng, f"l{i}", kinds) for i in range(rng.choice([1, 1, 1, 2, 3]))],
        "materials": materials, "meshes": meshes,
        "instances": [instance(rng, m["name"], rng.choice(names)) for m in meshes],
        "shapes": [floor] + [shape(rng, rng.choice(names)) for _ in range(rng.randint(0, 3))],
        "ambient": rng.choice([0, 0.1]), "background": rng.choice([0, 0.3]),
    }


def options(rng, technique):
    words = ["--technique", technique, "--size", rng.choice(["64x48", "97x61", "33x70"])]

    def maybe(chance, *more, when=True):
        if rng.random() < chance and when:
            words.extend(more)

    mapped = technique not in WITHOUT_MAP
    maybe(1, "--map-size", rng.choice(["16", "64", "100", "333"]), when=mapped)
    maybe(0.4, "--bias", rng.choice(["0", "0.5texel", "0.01", "-0.01", "3texel"]), when=mapped)
    maybe(0.3, "--slope-bias", rng.choice(["0", "1", "3"]), when=mapped)
    maybe(0.3, "--normal-offset", rng.choice(["0.5", "2"]), when=mapped)
    maybe(0.3, "--depth-format", rng.choice(["d16", "d24", "d32f", "d32f-reversed"]), when=mapped)
    maybe(0.3, "--cull", rng.choice(["front", "back"]), when=mapped and technique != "second-depth")
    maybe(0.2, "--receiver-plane", when=technique in PLANE_APPLIES)
    maybe(0.2, "--adaptive-bias", when=mapped and technique not in MOMENTS)
    maybe(0.2, "--caster-bias", rng.choice(["0.02", "1.5texel", "-0.5texel"]), when=mapped and technique != "midpoint")
    maybe(0.2, "--caster-slope-bias", rng.choice(["0.5", "2"]), when=mapped and technique != "midpoint")
    maybe(0.2, "--snap", when=mapped and technique not in ("csm", "cube"))
    maybe(0.7, "--filter-kernel", rng.choice(["box", "hardware", "vogel", "optimised"]), when=technique == "pcf")
    maybe(0.5, "--blur-radius", rng.choice(["0", "1", "5"]), when=technique in MOMENTS)
    maybe(0.5, "--mipmaps", rng.choice(["on", "off"]), when=technique in MOMENTS)
    maybe(0.5, "--cascades", rng.choice(["1", "2", "6"]), when=technique == "csm")
    maybe(0.3, "--cascade-fit", when=technique == "csm")
    maybe(0.2, "--precision", "exact")
    maybe(0.2, "--samples", rng.choice(["1", "3", "20"]))
    maybe(0.2, "--tessellate", rng.choice(["4", "9"]))
    return words


def other_ways(rng, technique):
    """What shall change nothing."""
    structure = rng.choice(["bvh-median", "kdtree", "kdtree-cyclic", "octree", "grid", "grid-textbook", "bsp", "two-level", "brute"])
    ways = [["--threads", "1"], ["--threads", "5"], ["--memory", "3M"], ["--instances", "flatten"], ["--accel", structure]]
    if technique != "izb":
        ways.append(["--instances", "keep"])
    return rng.sample(ways, 2)


def sums(result):
    """What does not add up."""
    for entry in result["lights"]:
        pixels, error, name = entry["pixels"], entry["error"], entry["light"]["name"]
        parts = ("background", "facing_away", "silhouette", "uncertain", "compared")
        if pixels["total"] != sum(pixels[part] for part in parts):
            yield f"{name}: pixels {pixels}"
        if error["wrong"] != error["false_shadow"] + error["missed_shadow"]:
            yield f"{name}: wrong pixels {error}"
        if not error["fractional"] and error["wrong"] != sum(entry["classes"].values()):
            yield f"{name}: {error['wrong']} wrong pixels, labels {entry['classes']}"
        rungs = [rung["mean"] for rung in entry["ladder"] if rung["mean"] is not None]
        signed = sum(step["signed"] for step in entry["budget"])
        if rungs and not math.isclose(abs(rungs[-1] - rungs[0]), abs(signed), abs_tol=1e-6):
            yield f"{name}: steps of the budget {signed}, of the ladder {rungs[-1] - rungs[0]}"
        if entry["map"]["technique"] in WITHOUT_MAP and error["wrong"] != entry["classes"]["light_size"]:
            yield f"{name}: {error['wrong']} pixels wrong with {entry['map']['technique']}"


def compare(program, words, folder, name):
    """What went wrong, or nothing."""
    words = [program, "compare", *words, "-o", folder / name, "--aov", folder / f"{name}.exr", "--quiet"]
    try:
        done = subprocess.run(words, capture_output=True, text=True, timeout=SECONDS)
    except subprocess.TimeoutExpired:
        return f"not done after {SECONDS} seconds"
    return "" if done.returncode == 0 else f"exit code {done.returncode}: {done.stderr.strip()}"


def changes(folder):
    for path in sorted(files_below(folder / "here") | files_below(folder / "there")):
        found = differences(folder / "here" / path, folder / "there" / path)
        yield from (f"{path}: {what}" for what in found if not any(word in what for word in WORK))
    for path in folder.glob("here*.exr"):
        yield from (f"{path.name}: {what}" for what in differences(path, folder / path.name.replace("here", "there")))


def faults(program, rng, folder):
    technique = rng.choice(TECHNIQUES)
    file = folder / "scene.json"
    file.write_text(json.dumps(scene(rng, technique)))
    words = [file, *options(rng, technique)]
    failed = compare(program, words, folder, "here")
    if failed:
        yield f"{' '.join(words[1:])}: {failed}"
        return
    yield from sums(json.loads((folder / "here" / "result.json").read_text()))
    for way in other_ways(rng, technique):
        failed = compare(program, [*words, *way], folder, "there")
        for what in [failed] if failed else changes(folder):
            yield f"{' '.join(words[1:])}, {' '.join(way)}: {what}"
        shutil.rmtree(folder / "there", ignore_errors=True)


def main():
    program, *rest = sys.argv[1:]
    runs, seed = (int(word) for word in (rest + ["100", "0"][len(rest):])[:2])
    failed = 0
    for i in range(seed, seed + runs):
        with tempfile.TemporaryDirectory() as folder:
            found = list(faults(program, random.Random(i), pathlib.Path(folder)))
        for what in found:
            print(f"seed {i}: {what}", flush=True)
        failed += bool(found)
    print(f"{runs} runs, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
