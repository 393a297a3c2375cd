"""Writes what was found of a frame's lights as a capture for `gnomon judge`."""
import os
from dataclasses import dataclass

import numpy as np

from . import extract, files
from .decision import Test
from .errors import FrameError
from .pixels import Pixels

MOST_LAYERS = 32  # of a capture's map


@dataclass
class Measured:
    """A light of the frame by its number, from 1, and what is known of it."""

    number: int
    found: extract.Found
    layers: list
    pixels: Pixels
    test: Test

    @property
    def parts(self):
        return self.found, self.layers, self.test


def light_node(layers):
    """The glTF light of a sun, spot or point light: it shines along its node's -z."""
    place = layers[0].place
    z = -place.direction
    up = np.array([0.0, 1.0, 0.0]) if abs(z[1]) < 0.9 else np.array([1.0, 0.0, 0.0])
    x = np.cross(up, z)
    x /= np.linalg.norm(x)
    matrix = np.eye(4)
    matrix[:3, 0], matrix[:3, 1], matrix[:3, 2] = x, np.cross(z, x), z
    if place.apex is None:
        return {"type": "directional", "matrix": matrix}
    matrix[:3, 3] = place.apex
    if len(layers) > 1 or layers[0].distance:
        return {"type": "point", "matrix": matrix}
    m = layers[0].light.matrix
    half = np.arctan(np.linalg.norm(m[3, :3]) / min(np.linalg.norm(m[0, :3]), np.linalg.norm(m[1, :3])))
    return {"type": "spot", "matrix": matrix, "inner": min(0.99 * half, 1.5), "outer": min(1.42 * half, 1.55)}  # to the map's corners


def _shapes(view, layers, gone, silent):
    """[(positions, corners, name, whether it casts)]: meshes as the camera draws them, without the places `gone`, then casters that it does
    not draw, brought back through the light's matrix. `silent`: places that cast nothing."""
    shapes = [(points, m.corners, m.name, k not in silent) for k, (m, points) in enumerate(zip(view.meshes, view.positions)) if k not in gone]
    known = set()
    for layer in layers:
        back = np.linalg.inv(layer.light.matrix) if layer.light.rank == 4 and not layer.distance else None
        for place, mesh in layer.pairs:
            if place is not None or back is None or mesh.source in gone:
                continue
            points = mesh.clip @ back.T
            points = points[:, :3] / points[:, 3:]
            seen = (mesh.source, np.round(points[:8], 2).tobytes())
            if seen not in known:
                known.add(seen)
                shapes.append((points, mesh.corners, mesh.name, True))
    return [shape for shape in shapes if len(shape[1]) >= 3]


def _select(selection, k, count):
    if selection.by == "first":
        return {}
    limits, blends = (0.0, *selection.limits), selection.blends or (0.0,) * count
    if not limits[k + 1] > limits[k]:
        return {}
    blend = {"blend": min(blends[k], limits[k + 1] - limits[k])} if blends[k] > 0 else {}
    return {"select": {"near": limits[k], "far": limits[k + 1], "by": selection.by, **blend}}


def _convention(layer):
    """(the convention's word, the matrix as it wants it, range or None)."""
    if layer.half:
        return "paraboloid", layer.matrix, [0.0, layer.distance.range]
    if layer.content and layer.content.base != "depth":
        x, y, z, w = layer.matrix
        kept = None if layer.content.range == (0.0, 1.0) else list(layer.content.range)
        return {"distance": "distance", "axis": "linear_z"}[layer.content.base], np.array([x, y, 2 * z - w, w]), kept
    return "reversed" if layer.state.reversed else "zero_to_one", layer.matrix, None


def world_from_view(lights):
    """The capture's world: the camera's view space, but for a light with a cube, whose faces look along the world's axes."""
    cube = next((layers for layers in lights if len(layers) == 6 and layers[0].place.apex is not None and layers[0].matrix is not None), None)
    turn = np.eye(4)
    if cube:
        x, y = (row / np.linalg.norm(row) for row in cube[0].matrix[:2, :3])
        y = y - (x @ y) * x
        turn[:3, :3] = x, y / np.linalg.norm(y), np.cross(x, y / np.linalg.norm(y))
    return turn


def _layer(folder, texture, name, k, layer, test, count, world=np.eye(4)):
    held = {"RGBA"[k]: layer.averages["drawn"][..., k] for k in range(layer.content.channels)} if test.fitted else {"Z": layer.texels}
    files.write_exr(os.path.join(folder, name), held)
    convention, matrix, reach = _convention(layer)
    out = {"depth": name, "convention": convention,
           "rows": "bottom_up" if layer.state.conventions.bottom_row_first else "top_down",
           "clip_from_world": files.column_major(matrix @ np.linalg.inv(world)), **_select(test.selection, k, count)}
    moved = extract.polygon_offset(layer, texture)
    if layer.has_caster_bias:
        moved["constant_world"] = layer.shift.world
    if layer.normal_shift:
        moved |= {"normal_offset_world": layer.normal_shift.world, "normal_offset_angle": layer.normal_shift.angle}
    if moved:
        out["caster_bias"] = moved
    if reach:
        out["range"] = reach
    if layer.half:
        for key in ("slope", "clamp"):  # of distances no capture says them; a finding does
            moved.pop(key, None)
    elif layer.constant and test.form is None:
        out["bias"] = {"constant_depth": layer.constant}
    return out


def _other_half(folder, name, first, layer):
    """The half of a dual paraboloid in which nothing was drawn, and nothing is looked up."""
    files.write_exr(os.path.join(folder, name), {"Z": np.ones(layer.texels.shape)})
    return {**first, "depth": name, "clip_from_world": files.column_major(np.diag([1, 1, -1, 1]) @ layer.matrix)}


def _filter(layers, test):
    if test.fitted:
        fitted = test.fitted
        said = {"kind": fitted.content.kind, "read": "moments", "radius_texels": test.radius}
        if fitted.content.exponents:
            said["exponents"] = list(fitted.content.exponents)
        if fitted.content.kind != "esm":
            said |= {"minimum_variance": fitted.variance, "light_bleeding_reduction": fitted.reduction}
        return said
    blurred = any(layer.is_blurred for layer in layers)
    read = {"read": "linear_depths"} if test.form and test.form.linear and not blurred and not test.exponent else {}
    if test.radius is None and not blurred:
        return {"kind": "none", **read}
    return {"kind": "esm" if test.exponent else "vsm" if blurred else "pcf", "radius_texels": min(test.radius or 1.5, 64), **read}


def _light(folder, frame, light, prefix, world):
    """What the capture says of one light, whose files' names begin with the prefix."""
    layers, pixels = light.layers, light.pixels
    if len(layers) > MOST_LAYERS:
        raise FrameError(f"the light has {len(layers)} maps, and a capture holds {MOST_LAYERS}")
    # As a ratio: a pixel that the light does not reach without shadows either is not compared.
    asked = pixels.asked.astype(float)
    said = {"shadowed": prefix + "shadowed.exr", "unshadowed": prefix + "unshadowed.exr", "strength": 1.0}  # the replays took the rest out
    files.write_exr(os.path.join(folder, said["shadowed"]), {"Y": np.clip(pixels.visibility, 0, 1) * asked})
    files.write_exr(os.path.join(folder, said["unshadowed"]), {"Y": asked})
    if layers[0].matrix is None:
        return said
    texture = frame.textures[light.found.passes.texture]
    maps = [_layer(folder, texture, f"{prefix}map{k}.exr", k, layer, light.test, len(layers), world) for k, layer in enumerate(layers)
            if light.test.selection.by == "first" or _select(light.test.selection, k, len(layers))]  # what nothing looks up is none of its layers
    if layers[0].half and len(maps) == 1:
        maps.append(_other_half(folder, f"{prefix}map1.exr", maps[0], layers[0]))
    both = {"bias": {"constant_depth": layers[0].constant}} if layers[0].half and layers[0].constant else {}
    if light.test.form and not layers[0].half:
        both = {"bias": light.test.form.said()}
    return {**said, "map": maps, **both, "filter": _filter(layers, light.test)}


def _settings(frame, light, prefix):
    """What a report shows of the light's map, in words."""
    layers, test, sampler = light.layers, light.test, light.found.sampler
    texture = frame.textures[light.found.passes.texture]
    settings = {"map": f"{texture.width} x {texture.height}", "format": texture.format}
    if sampler:
        settings["sampler"] = sampler
    if layers[0].reader:
        settings["matrix"] = f"{layers[0].reader.name} (residual {layers[0].reader.residual:.1e})"
    if layers[0].has_caster_bias:
        settings["casters moved"] = f"{layers[0].shift.world:.4g} world units (residual {layers[0].shift.residual:.1e})"
    if test.agreement is not None:
        settings["test found"] = f"decides {100 * test.agreement:.2f} % of the pixels as drawn"
    if test.exponent:
        settings["exponent"] = round(test.exponent.factor, 2)
    return {prefix + key: value for key, value in settings.items()}


def _camera(view, aspect):
    """The glTF camera of a view, looking along -z from `eye`: 0, or the near plane of a parallel one that sees what lies behind it."""
    near, far, _ = view.lens.planes(view.state.conventions.minus_one)
    if not view.lens.parallel:
        lens = {"yfov": 2 * np.arctan(1 / view.lens.fy), "aspectRatio": aspect, "znear": max(near, 1e-4), "zfar": far}
        return {"eye": [0, 0, 0], "type": "perspective", "perspective": lens}
    back = max(0.0, -near)
    lens = {"xmag": aspect / view.lens.fy, "ymag": 1 / view.lens.fy, "znear": near + back, "zfar": far + back}
    return {"eye": [0, 0, back], "type": "orthographic", "orthographic": lens}


def _jitter(view, width, height):
    """What a camera's middle is off that of the picture, as a capture says it; nothing where it is less than positions are good to."""
    down = 0.5 if view.state.conventions.y_up else -0.5
    off = [-0.5 * view.lens.cx * width, down * view.lens.cy * height]
    return {"jitter": off} if not view.lens.parallel and 1e-3 < max(map(abs, off)) <= 1 else {}


def write(folder, frame, lights, name):
    """The capture's folder, of what was Measured; returns the path of capture.json."""
    os.makedirs(folder, exist_ok=True)
    view, pixels = lights[0].found.view, lights[0].pixels
    height, width = pixels.drawn.shape
    hidden = [light.pixels.hidden for light in lights if light.pixels.hidden is not None]
    drawn = (pixels.drawn & ~np.any(hidden, axis=0)).astype(float) if hidden else pixels.drawn.astype(float)
    gone = set().union(*(light.found.roles.gone for light in lights))
    silent = set().union(*(light.found.roles.silent for light in lights))
    world = world_from_view([light.layers for light in lights])
    turned = lambda points: points @ world[:3, :3].T
    files.write_exr(os.path.join(folder, "position.exr"), {c: turned(pixels.positions)[..., i] * drawn for i, c in enumerate("XYZ")} | {"A": drawn})
    camera = {**_camera(view, width / height), "world": world}
    names = {light.number: f"light {light.number}" if len(lights) > 1 else "light" for light in lights}
    shapes = [(turned(points), *rest) for points, *rest in _shapes(view, [layer for light in lights for layer in light.layers], gone, silent)]
    nodes = [{"name": names[light.number], **light_node(light.layers)} for light in lights]
    files.write_glb(os.path.join(folder, "scene.glb"), shapes, camera, [{**node, "matrix": world @ node["matrix"]} for node in nodes])
    if len(lights) == 1:
        of_lights, settings = _light(folder, frame, lights[0], "", world), _settings(frame, lights[0], "")
    else:
        of_lights = {"lights": [{"light": names[one.number], **_light(folder, frame, one, f"light{one.number}-", world)} for one in lights]}
        settings = {key: value for one in lights for key, value in _settings(frame, one, names[one.number] + ", ").items()}
    files.write_capture(folder, {
        "renderer": {"name": name, "version": "(RenderDoc)", "settings": settings}, "scene": "scene.glb", "size": [width, height], "casters": "found", **_jitter(view, width, height),
        "position": "position.exr", **of_lights})
    return os.path.join(folder, "capture.json")
