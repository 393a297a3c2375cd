"""Which meshes of a frame may cast, decided from the frame.

What the passes of a map draw casts. A mesh that no map holds may still be meant to cast, and then it is missing: it stays, and the verdict
names it. Three kinds cast nothing and are left out by name: what writes no depth (a sky, glass, a gizmo), what surrounds the camera and
all casters (a sky dome or box, a room that the map leaves out), and what stands around the light (a visible lamp).
"""
from dataclasses import dataclass, field

import numpy as np

AROUND = 0.5  # of a mesh's own size: so far beside it a light is the mesh's own
RECEIVES = 0.05  # share of a mesh's pixels whose light the map decides, from which it is a receiver


@dataclass
class Roles:
    """What becomes of the camera's meshes, by their place in the view."""

    silent: dict = field(default_factory=dict)  # place: why it casts nothing
    gone: set = field(default_factory=set)  # those among them that receive nothing either: they are not in the scene


def drawn_into_maps(all_layers):
    """Places of the camera's meshes that some pass of a map draws."""
    return {place for layer in all_layers for place, _ in layer.pairs if place is not None}


def _box(points):
    return points.min(0), points.max(0)


def _is_in(inner, outer):
    return bool((inner[0] >= outer[0]).all() and (inner[1] <= outer[1]).all())


def meets(origin, direction, points, corners):
    """Whether a ray meets one of the triangles (Moeller and Trumbore)."""
    a, b, c = (points[corners.reshape(-1, 3)[:, k]] for k in range(3))
    e1, e2 = b - a, c - a
    p = np.cross(direction, e2)
    det = (e1 * p).sum(1)
    fine = np.abs(det) > 1e-12 * max(float(np.abs(det).max()), 1e-300)
    with np.errstate(all="ignore"):
        s = origin - a
        u = (s * p).sum(1) / det
        q = np.cross(s, e1)
        v = (direction * q).sum(1) / det
        t = (e2 * q).sum(1) / det
        return bool((fine & (u >= -1e-9) & (v >= -1e-9) & (u + v <= 1 + 1e-9) & (t > 0)).any())


def _surrounds(points, corners, casters, place):
    """Whether a mesh holds the camera and all casters, and lies between these and the light."""
    if casters is None or not _is_in((np.zeros(3), np.zeros(3)), _box(points)) or not _is_in(casters, _box(points)):
        return False
    middle = 0.5 * (casters[0] + casters[1])
    to_light = -place.direction if place.apex is None else place.apex - middle
    return meets(middle, to_light / np.linalg.norm(to_light), points, corners)


def _is_around(points, apex):
    """Whether a light at this point is a mesh's own."""
    low, high = _box(points)
    beside = AROUND * float((high - low).max())
    return bool((apex >= low - beside).all() and (apex <= high + beside).all())


def _is_before_all_maps(place, all_layers):
    """Whether a mesh is drawn into maps, and lies before the near plane of each, so that none holds any of it."""
    found = False
    for layer in all_layers:
        for k, mesh in layer.pairs:
            if k != place:
                continue
            low = -mesh.clip[:, 3] if layer.state.conventions.minus_one else np.zeros(len(mesh.clip))
            before = mesh.clip[:, 2] > mesh.clip[:, 3] if layer.state.reversed else mesh.clip[:, 2] < low
            if layer.distance or not before.all():
                return False
            found = True
    return found


def silent(view, writes_depth, all_layers):
    """{place: why} of the meshes that cast nothing. `writes_depth(event)`: whether a draw of the camera's does."""
    drawn = drawn_into_maps(all_layers)
    held = [view.positions[k] for k in drawn]
    casters = _box(np.concatenate(held)) if held else None
    lights = {id(layer.place): layer.place for layer in all_layers}.values()
    out = {}
    for k, (mesh, points) in enumerate(zip(view.meshes, view.positions)):
        own = [p for p in lights if p.apex is not None and _is_around(points, p.apex)]
        if k in drawn:
            if own and _is_before_all_maps(k, all_layers):
                out[k] = "stands around the light, before the map's near plane"
        elif not writes_depth(mesh.event):
            out[k] = "writes no depth"
        elif own:
            out[k] = "stands around the light, and the map does not draw it"
        elif any(_surrounds(points, mesh.corners, casters, p) for p in lights):
            out[k] = "surrounds the camera and all casters, and the map does not draw it"
    return out


def decide(frame, view, all_layers, depth, told, cut=lambda picture: picture):
    """(Roles, pixels that show what is gone). `depth`: the camera's, at last; `told`: pixels whose light the map decides. Both have the
    texture's own first row first; `cut` takes them from a texture."""
    roles = Roles(silent(view, lambda event: frame.state(event).writes_depth, all_layers))
    hidden = np.zeros(told.shape, bool)
    shows = {}
    for k in roles.silent:
        event = view.meshes[k].event
        if event not in shows:
            shows[event] = frame.shows(event, view.state.depth, depth, cut) if frame.state(event).writes_depth else np.zeros(told.shape, bool)
        mine = shows[event]
        if not mine.any() or (mine & told).sum() < RECEIVES * mine.sum():
            roles.gone.add(k)
            hidden |= mine
    for event in {mesh.event for mesh in view.others}:
        if frame.state(event).writes_depth:
            hidden |= frame.shows(event, view.state.depth, depth, cut)
    return roles, hidden


def _listed(names):
    return ", ".join(names[:4]) + (f" and {len(names) - 4} more" if len(names) > 4 else "")


def words(view, roles):
    """Sentences that name what is left out."""
    by_reason = {}
    for k, why in sorted(roles.silent.items()):
        by_reason.setdefault((why, k in roles.gone), []).append(view.meshes[k].name)
    out = []
    for (why, gone), names in by_reason.items():
        out.append(f"casts no shadow in the verdict: {_listed(names)}, which {why}" + ("; its own pixels are not compared" if gone else ""))
    if view.others:
        out.append(f"left out: {_listed([mesh.name for mesh in view.others])}, drawn with another projection than most; its pixels are not compared")
    return out
