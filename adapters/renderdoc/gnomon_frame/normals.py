"""Casters that a shader moves along their normals while the map is drawn (Babylon.js, Unity): a number that the angle to the light may
scale."""
from dataclasses import dataclass

import numpy as np

from . import fit

ANGLES = {"none": np.ones_like, "sine": lambda c: np.sqrt(np.maximum(1 - c * c, 0)), "one_minus_cosine": lambda c: 1 - c}
STEPS = 6  # in which light, offset and matrix settle
TRIMMED = 6  # times what is off most is left out
EXACT = 2e-5  # of the largest number that was drawn: by less 32-bit arithmetic is off
ENOUGH = 0.1  # of what is left without an offset: a form that leaves more is none


@dataclass(frozen=True)
class NormalShift:
    """By how much the casters were moved against their normals."""

    world: float  # world units, before the angle's factor
    angle: str  # a capture's word for it


def turned(objects, normals, views):
    """Normals of vertices that an affine matrix took from `objects` to `views`. Of a flat mesh its plane's own direction is given a length in
    between, which its normals do not ask for."""
    middle, there = objects - objects.mean(0), views - views.mean(0)
    across = np.linalg.svd(middle, full_matrices=False)[2]
    if np.linalg.matrix_rank(middle, 1e-6 * max(np.linalg.norm(middle), 1e-30)) == 2:
        turn = np.linalg.lstsq(middle, there, rcond=None)[0]
        out = np.cross(across[0] @ turn, across[1] @ turn) * np.sign(np.linalg.det(across))
        middle, there = np.r_[middle, across[2:]], np.r_[there, out[None] / max(np.linalg.norm(out), 1e-30)]
    return normals @ np.linalg.pinv(np.linalg.lstsq(middle, there, rcond=None)[0].T)


def of_mesh(mesh, views):
    """Normals of a mesh's vertices in view space: its own, where its draw has some, else the mean of their triangles'."""
    if mesh.normals is None or mesh.objects is None:
        return of_corners(views, mesh.corners)
    out = turned(mesh.objects, mesh.normals, views)
    return out / np.maximum(np.linalg.norm(out, axis=1, keepdims=True), 1e-30)


def of_corners(points, corners):
    """Normals of vertices: the mean of their triangles', by area."""
    triangles = corners.reshape(-1, 3)
    face = np.cross(points[triangles[:, 1]] - points[triangles[:, 0]], points[triangles[:, 2]] - points[triangles[:, 0]])
    out = np.zeros_like(points)
    for k in range(3):
        np.add.at(out, triangles[:, k], face)
    return out / np.maximum(np.linalg.norm(out, axis=1), 1e-30)[:, None]


def _cosines(place, points, normals):
    to_light = -place.direction if place.apex is None else place.apex - points
    to_light = to_light / np.linalg.norm(to_light, axis=-1, keepdims=True)
    return np.clip((normals * to_light).sum(-1), -1, 1)


def _settled(views, normals, clips, light, factor, reversed_depth):
    """(LightFit, offset against the normals) of one factor: clip = M (p - k f n), of which M and k M are linear."""
    offset, moved = 0.0, views
    for _ in range(STEPS):
        f = factor(_cosines(fit.light_place(light.matrix, reversed_depth), views, normals))
        along = normals * f[:, None]
        both = np.linalg.lstsq(np.c_[fit.homogeneous(moved), along], clips, rcond=None)[0].T
        turn = both[:, :3]
        offset -= float((both[:, 4:] * turn).sum() / max((turn * turn).sum(), 1e-300))
        moved = views - offset * along
        light = fit.fit_light(moved, clips)
    return light, offset


def find(views, normals, clips, light, reversed_depth):
    """(LightFit, NormalShift) of casters that are no projection by themselves, or None. `light`: as they are fitted without."""
    tried = []
    for angle, factor in ANGLES.items():
        found, offset = _settled(views, normals, clips, light, factor, reversed_depth)
        tried.append((found, NormalShift(offset, angle)))
    best = _best(tried, ENOUGH * light.residuals.max())
    of_most = [_of_most(views, normals, clips, one, reversed_depth) for one in tried] if best is None else []
    is_moved = lambda one: abs(one[1].world) * np.linalg.norm(one[0].matrix[0, :3]) > 10 * EXACT * np.abs(clips).max()
    return best or _best(filter(is_moved, of_most), EXACT)


def _best(tried, most):
    """That which leaves least, of those that leave no more than `most`; one is taken for a better one than those before it where it leaves half."""
    best = None
    for light, shift in tried:
        if light.rank == 4 and light.residuals.max() <= most and (best is None or light.residuals.max() < 0.5 * best[0].residuals.max()):
            best = light, shift
    return best


def _of_most(views, normals, clips, best, reversed_depth):
    """What most vertices have exactly: of smooth meshes whose draws name no normals those of triangles are not all the shader's."""
    light, shift = best
    for _ in range(TRIMMED):
        at = views - shift.world * normals * ANGLES[shift.angle](_cosines(fit.light_place(light.matrix, reversed_depth), views, normals))[:, None]
        off = np.abs(fit.homogeneous(at) @ light.matrix.T - clips).max(1)
        kept = off <= max(float(np.median(off)), 0.2 * EXACT * np.abs(clips).max())
        light, offset = _settled(views[kept], normals[kept], clips[kept], light, ANGLES[shift.angle], reversed_depth)
        shift = NormalShift(offset, shift.angle)
    return light, shift
