#!/usr/bin/env python3
"""Holds one built gnomon to another: the same results, pictures and channels, to the last bit.

    tests/tools/same_results.py BASE NEW [--size 160x90] [--data ../shared/data] [--leave-out KEY] [SCENE...]

BASE and NEW are programs. Each renders every scene (all built-in ones and ten model files, or those that
are named) by compare, raytrace and raster; what differs is printed, and the exit code is then 1. Left out
are times, versions, and what a run says about itself (command, machine, dates). Where a hierarchy is built
otherwise, --leave-out boxes_per_ray --leave-out primitives_per_ray leaves out what counts its nodes and leaves.
"""

import argparse
import json
import pathlib
import struct
import subprocess
import sys
import tempfile
import zlib

MODELS = [
    "common_organic/suzanne.obj",
    "common_organic/stanford-bunny.obj",
    "cornell_obj/cornell_box.obj",
    "cornell_bevy/CornellBox.glb",
    "lowpoly_tree/low-poly-tree.glb",
    "no_index_building/no_indices_3storybuilding.glb",
    "transmission_roughness_test/TransmissionRoughnessTest.glb",
    "alpha_blend_mode_test/AlphaBlendModeTest.glb",
    "stanford_dragon/dragon_vrip_res4.ply",
    "gltf_lights_basic/Lights.glb",
]

# Keys of result.json that say when, where, by what or how fast; `_ms` besides.
NOT_RESULTS = {"command", "version", "commit", "machine", "threads", "times_ms", "time_budget", "process"}
# Attributes of EXR headers and chunks of PNG files that do the same.
NOT_CHANNELS = {b"gnomon_command", b"gnomon_version", b"capDate", b"DateTime", b"Software", b"ImageDescription", b"comments", b"history"}
NOT_PIXELS = {b"tEXt", b"iTXt", b"zTXt", b"tIME"}

RUNS = {
    "compare": ["compare", "{scene}", "-o", "{name}", "--aov", "{name}-aov.exr"],
    "raytrace": ["raytrace", "{scene}", "-o", "{name}-raytrace.exr"],
    "picture": ["raytrace", "{scene}", "-o", "{name}-raytrace.png"],
    "antialiased": ["raytrace", "{scene}", "-o", "{name}-antialiased.png", "--aa", "2"],
    "raster": ["raster", "{scene}", "-o", "{name}-raster.exr"],
}


def differing_keys(base, new, path=""):
    if isinstance(base, dict) and isinstance(new, dict):
        for key in sorted(base.keys() | new.keys()):
            if key in NOT_RESULTS or key.endswith("_ms"):
                continue
            where = f"{path}.{key}" if path else key
            if key not in base:
                yield f"{where}: new"
            elif key not in new:
                yield f"{where}: gone"
            else:
                yield from differing_keys(base[key], new[key], where)
    elif isinstance(base, list) and isinstance(new, list) and len(base) == len(new):
        for i, (a, b) in enumerate(zip(base, new)):
            yield from differing_keys(a, b, f"{path}[{i}]")
    elif base != new or type(base) is not type(new):
        yield f"{path}: {json.dumps(base)[:60]} -> {json.dumps(new)[:60]}"


def exr_parts(data):
    """The header's attributes by name, and the chunks as they were before they were compressed."""
    at, attributes = 8, {}
    while data[at] != 0:
        name = data[at : data.index(b"\0", at)]
        at += len(name) + 1
        at = data.index(b"\0", at) + 1
        (size,) = struct.unpack_from("<i", data, at)
        attributes[name] = data[at + 4 : at + 4 + size]
        at += 4 + size
    (at,) = struct.unpack_from("<Q", data, at + 1)
    chunks = []
    while at < len(data):
        row, size = struct.unpack_from("<ii", data, at)
        chunk = data[at + 8 : at + 8 + size]
        at += 8 + size
        try:
            chunks.append((row, zlib.decompress(chunk)))
        except zlib.error:  # what does not shrink is stored as it is
            chunks.append((row, chunk))
    return {k: v for k, v in attributes.items() if k not in NOT_CHANNELS}, chunks


def png_parts(data):
    at, chunks, pixels = 8, [], b""
    while at < len(data):
        (size,) = struct.unpack_from(">I", data, at)
        kind, content = data[at + 4 : at + 8], data[at + 8 : at + 8 + size]
        if kind == b"IDAT":  # by what it holds: how well it is compressed is no result
            pixels += content
        elif kind not in NOT_PIXELS:
            chunks.append((kind, content))
        at += 12 + size
    return chunks, zlib.decompress(pixels)


def differences(base, new):
    if not new.exists() or not base.exists():
        return [f"only {'before' if base.exists() else 'now'}"]
    if base.suffix == ".json":
        return list(differing_keys(json.loads(base.read_text()), json.loads(new.read_text())))
    parts = {".exr": exr_parts, ".png": png_parts}.get(base.suffix)
    if parts is None or parts(base.read_bytes()) == parts(new.read_bytes()):
        return []
    return ["pixels differ"]


def run(program, scene, name, size, folder):
    codes = {}
    for verb, words in RUNS.items():
        words = [word.format(scene=scene, name=name) for word in words]
        done = subprocess.run([program, *words, "--size", size, "--quiet"], cwd=folder, capture_output=True, text=True)
        codes[verb] = (done.returncode, done.stderr)
    return codes


def files_below(folder):
    return {path.relative_to(folder) for path in folder.rglob("*") if path.is_file()}


def compare_scene(programs, scene, name, size):
    with tempfile.TemporaryDirectory() as work:
        folders = [pathlib.Path(work, side) for side in ("base", "new")]
        codes = []
        for program, folder in zip(programs, folders):
            folder.mkdir()
            codes.append(run(program, scene, name, size, folder))
        found = [f"{verb}: {codes[0][verb]} -> {codes[1][verb]}" for verb in RUNS if codes[0][verb] != codes[1][verb]]
        files = sorted(files_below(folders[0]) | files_below(folders[1]))
        for file in files:
            found += [f"{file}: {what}" for what in differences(folders[0] / file, folders[1] / file)]
        failed = [verb for verb, (code, _) in codes[0].items() if code != 0]
        return found, len(files), failed


def builtin_scenes(program):
    listed = subprocess.run([program, "scenes", "--json", "-"], capture_output=True, text=True, check=True)
    return [entry["name"] for entry in json.loads(listed.stdout)["scenes"]]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("base", type=pathlib.Path)
    parser.add_argument("new", type=pathlib.Path)
    parser.add_argument("scenes", nargs="*", help="default: all built-in scenes and ten models")
    parser.add_argument("--size", default="160x90", help="pixels (default %(default)s)")
    parser.add_argument("--leave-out", action="append", default=[], metavar="KEY", help="a key of result.json")
    parser.add_argument("--data", type=pathlib.Path, help="folder of the models (default: ../shared/data)")
    options = parser.parse_args()
    NOT_RESULTS.update(options.leave_out)
    programs = [options.base.resolve(), options.new.resolve()]
    data = (options.data or pathlib.Path(__file__).parents[3] / "shared" / "data").resolve()
    scenes = options.scenes
    if not scenes:
        models = [str(data / model) for model in MODELS if (data / model).exists()]
        if len(models) < len(MODELS):
            print(f"{len(MODELS) - len(models)} of {len(MODELS)} models are not in {data}", file=sys.stderr)
        scenes = builtin_scenes(programs[0]) + models
    wrong = 0
    for scene in scenes:
        name = pathlib.Path(scene).stem
        found, files, failed = compare_scene(programs, scene, name, options.size)
        wrong += bool(found)
        note = f" (fails in both: {', '.join(failed)})" if failed else ""
        print(f"{name}: {'the same' if not found else f'{len(found)} differences'} in {files} files{note}", flush=True)
        for line in found:
            print(f"  {line}")
    print(f"{len(scenes) - wrong} of {len(scenes)} scenes are the same to the last bit")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
