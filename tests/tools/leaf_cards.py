#!/usr/bin/env python3
"""Writes a plantation of trees whose leaves are cards with an alpha mask, as a binary glTF file: what foliage in real scenes
is made of, and what no built-in scene has. The same file every time.

    leaf_cards.py plantation.glb --trees 144 --leaves 3000
"""

import argparse
import json
import math
import random
import struct
import zlib

NUMBERS = {5126: "f", 5125: "I"}


def png(side, alpha):
    """A green square whose alpha is alpha(x, y), both from -1 to 1."""
    rows = bytearray()
    for y in range(side):
        rows.append(0)
        for x in range(side):
            rows += bytes((60, 140, 40, 255 if alpha(2 * x / side - 1, 2 * y / side - 1) else 0))

    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    header = struct.pack(">IIBBBBB", side, side, 8, 6, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(bytes(rows))) + chunk(b"IEND", b"")


def is_leaf(x, y):
    return math.hypot(x, y) < 0.55 + 0.35 * math.cos(5 * math.atan2(y, x))


class Buffer:
    def __init__(self):
        self.data, self.views, self.accessors = bytearray(), [], []

    def view(self, data):
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data)})
        self.data += data + bytes(-len(data) % 4)
        return len(self.views) - 1

    def accessor(self, values, size, kind):
        view = self.view(struct.pack(f"<{len(values)}{NUMBERS[kind]}", *values))
        name = {1: "SCALAR", 2: "VEC2", 3: "VEC3"}[size]
        entry = {"bufferView": view, "componentType": kind, "count": len(values) // size, "type": name}
        if size == 3:
            entry["min"] = [min(values[a::3]) for a in range(3)]
            entry["max"] = [max(values[a::3]) for a in range(3)]
        self.accessors.append(entry)
        return len(self.accessors) - 1

    def primitive(self, positions, indices, material, uvs=None):
        attributes = {"POSITION": self.accessor(positions, 3, 5126)}
        if uvs is not None:
            attributes["TEXCOORD_0"] = self.accessor(uvs, 2, 5126)
        return {"attributes": attributes, "indices": self.accessor(indices, 1, 5125), "material": material}


def unit(v):
    length = math.sqrt(sum(a * a for a in v))
    return [a / length for a in v]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def crown(rng, count):
    """Cards of every direction in a ball 5 units above the ground."""
    positions, indices, uvs = [], [], []
    for i in range(count):
        away = unit([rng.gauss(0, 1) for _ in range(3)])
        distance = 2.5 * rng.uniform(0.5, 1) ** 0.33
        center = [distance * a for a in away]
        center[1] = 1.2 * center[1] + 5
        u = unit([rng.gauss(0, 1) for _ in range(3)])
        v = unit(cross(u, [rng.gauss(0, 1) for _ in range(3)]))
        for s, t in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
            positions += [c + 0.22 * (s * a + t * b) for c, a, b in zip(center, u, v)]
            uvs += [(s + 1) / 2, (t + 1) / 2]
        indices += [4 * i + k for k in (0, 1, 2, 0, 2, 3)]
    return positions, indices, uvs


def plantation(trees, leaves):
    rng, buffer = random.Random(1), Buffer()
    positions, indices, uvs = crown(rng, leaves)
    trunk = [c for x in (-0.2, 0.2) for y in (0, 5) for z in (-0.2, 0.2) for c in (x, y, z)]
    sides = [0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1, 2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3]
    tree = [buffer.primitive(positions, indices, 0, uvs), buffer.primitive(trunk, sides, 1)]
    ground = [buffer.primitive([-60, 0, -60, -60, 0, 60, 60, 0, 60, 60, 0, -60], [0, 1, 2, 0, 2, 3], 2)]
    image = buffer.view(png(512, is_leaf))
    side = math.ceil(math.sqrt(trees))
    nodes = [{"mesh": 1}, {"camera": 0, "translation": [0, 9, 3 * side + 14], "rotation": [-0.13, 0, 0, 0.9915]}]
    nodes.append({"extensions": {"KHR_lights_punctual": {"light": 0}}, "rotation": [-0.4994, 0.2997, 0, 0.8128]})
    for i in range(trees):
        x, z = (6 * (n - side / 2 + rng.uniform(-0.3, 0.3)) for n in (i % side, i // side))
        turn, size = rng.uniform(0, math.pi), rng.uniform(0.8, 1.2)
        nodes.append({"mesh": 0, "translation": [x, 0, z], "scale": [size] * 3,
                      "rotation": [0, math.sin(turn), 0, math.cos(turn)]})

    def color(r, g, b):
        return {"pbrMetallicRoughness": {"baseColorFactor": [r, g, b, 1], "metallicFactor": 0}}

    leaf = {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicFactor": 0}, "alphaMode": "MASK",
            "doubleSided": True}
    scene = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(nodes)))}], "nodes": nodes,
        "meshes": [{"primitives": tree}, {"primitives": ground}],
        "materials": [leaf, color(0.4, 0.3, 0.2), color(0.5, 0.5, 0.4)],
        "textures": [{"source": 0}], "images": [{"bufferView": image, "mimeType": "image/png"}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1, "zfar": 500}}],
        "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 3}]}},
        "buffers": [{"byteLength": len(buffer.data)}], "bufferViews": buffer.views, "accessors": buffer.accessors,
    }
    return scene, bytes(buffer.data)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file")
    parser.add_argument("--trees", type=int, default=144)
    parser.add_argument("--leaves", type=int, default=3000, help="of a tree (default 3000)")
    arguments = parser.parse_args()
    scene, data = plantation(arguments.trees, arguments.leaves)
    text = json.dumps(scene).encode()
    text += b" " * (-len(text) % 4)
    with open(arguments.file, "wb") as out:
        out.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(data)))
        out.write(struct.pack("<I4s", len(text), b"JSON") + text)
        out.write(struct.pack("<I4s", len(data), b"BIN\0") + data)


if __name__ == "__main__":
    main()
