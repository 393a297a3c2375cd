"""What a capture is made of: EXR of 32-bit floats without compression, GLB, and capture.json."""
import contextlib
import json
import os
import secrets
import struct

import numpy as np


@contextlib.contextmanager
def whole_file(path):
    """A file in the making, which appears when its `with` ends. A link that has its name is replaced, not followed."""
    part = f"{path}.{secrets.token_hex(8)}.part"
    try:
        with open(part, "xb") as file:
            yield file
        os.replace(part, path)
    except BaseException:
        with contextlib.suppress(FileNotFoundError):
            os.unlink(part)
        raise


def write_exr(path, channels):
    """channels: {name: [rows, columns]}, the first row at the top."""
    names = sorted(channels)
    height, width = channels[names[0]].shape
    word = lambda text: text.encode() + b"\0"
    attribute = lambda name, kind, value: word(name) + word(kind) + struct.pack("<i", len(value)) + value
    listed = b"".join(word(name) + struct.pack("<iiii", 2, 0, 1, 1) for name in names) + b"\0"
    box = struct.pack("<iiii", 0, 0, width - 1, height - 1)
    head = (struct.pack("<ii", 20000630, 2) + attribute("channels", "chlist", listed) + attribute("compression", "compression", b"\0")
            + attribute("dataWindow", "box2i", box) + attribute("displayWindow", "box2i", box) + attribute("lineOrder", "lineOrder", b"\0")
            + attribute("pixelAspectRatio", "float", struct.pack("<f", 1)) + attribute("screenWindowCenter", "v2f", struct.pack("<ff", 0, 0))
            + attribute("screenWindowWidth", "float", struct.pack("<f", 1)) + b"\0")
    row = 4 * width * len(names)
    first = len(head) + 8 * height
    # A row: its number, its length, then one channel after the other.
    rows = np.zeros(height, np.dtype([("y", "<i4"), ("length", "<i4"), ("values", "<f4", (len(names), width))]))
    rows["y"], rows["length"] = np.arange(height), row
    for k, name in enumerate(names):
        rows["values"][:, k] = channels[name]
    with whole_file(path) as file:
        file.write(head + (first + (row + 8) * np.arange(height, dtype=np.uint64)).astype("<u8").tobytes())
        file.write(rows.tobytes())


def column_major(matrix):
    return [float(x) for x in np.asarray(matrix, float).T.reshape(-1)]


class _Blob:
    """The binary part of a GLB with its views and accessors."""

    def __init__(self):
        self.data, self.views, self.accessors = bytearray(), [], []

    def add(self, values, kind, component, target, **more):
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": values.nbytes, "target": target})
        self.data += values.tobytes()
        self.accessors.append({"bufferView": len(self.views) - 1, "componentType": component, "count": len(values), "type": kind, **more})
        return len(self.accessors) - 1


def write_glb(path, shapes, camera, lights):
    """A scene of white `shapes` [(positions, three indices for each triangle, name, whether it casts shadows)]; camera as glTF has it,
    its `eye`, from which it looks along -z, and `world`, a turn of both; lights [{name, type, matrix} and of spots {inner, outer}]."""
    blob = _Blob()
    meshes, nodes = [], []
    for positions, corners, name, casts in shapes:
        places = np.ascontiguousarray(positions, np.float32)
        at = blob.add(places, "VEC3", 5126, 34962, min=[float(x) for x in places.min(0)], max=[float(x) for x in places.max(0)])
        order = blob.add(corners.astype(np.uint32), "SCALAR", 5125, 34963)
        meshes.append({"name": name, "primitives": [{"attributes": {"POSITION": at}, "indices": order, "material": 0}]})
        nodes.append({"mesh": len(meshes) - 1, "name": name, **({} if casts else {"extras": {"casts_shadow": False}})})
    stands = np.eye(4)
    stands[:3, 3] = camera["eye"]
    nodes.append({"camera": 0, "name": "camera", "matrix": column_major(camera["world"] @ stands)})
    punctual = []
    for light in lights:
        nodes.append({"name": light["name"], "matrix": column_major(light["matrix"]), "extensions": {"KHR_lights_punctual": {"light": len(punctual)}}})
        cone = {"spot": {"innerConeAngle": light["inner"], "outerConeAngle": light["outer"]}} if light["type"] == "spot" else {}
        punctual.append({"type": light["type"], "name": light["name"], "intensity": 3.0 if light["type"] == "directional" else 1e4,
                         "color": [1, 1, 1], **cone})
    white = {"name": "white", "doubleSided": True, "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 1}}
    document = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(nodes)))}], "nodes": nodes, "meshes": meshes,
                "cameras": [{key: value for key, value in camera.items() if key not in ("eye", "world")}], "materials": [white], "accessors": blob.accessors,
                "bufferViews": blob.views, "buffers": [{"byteLength": len(blob.data)}], "extensionsUsed": ["KHR_lights_punctual"],
                "extensions": {"KHR_lights_punctual": {"lights": punctual}}}
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    data = bytes(blob.data) + b"\0" * (-len(blob.data) % 4)
    with whole_file(path) as file:
        file.write(struct.pack("<III", 0x46546C67, 2, 28 + len(text) + len(data)) + struct.pack("<II", len(text), 0x4E4F534A) + text)
        file.write(struct.pack("<II", len(data), 0x004E4942) + data)


def write_capture(folder, document):
    with whole_file(os.path.join(folder, "capture.json")) as file:
        file.write((json.dumps({"schema": "gnomon/capture/2", **document}, indent=1) + "\n").encode())
