"""Least squares on vertices as they were drawn: the camera's lens, a light's matrix, what moved casters.

Vertices are rows; a homogeneous point has four columns. Matrices act on columns (clip = matrix @ point). World space is the
camera's view space: x to the right, y up, looking along -z, which any engine's conventions leave alike. Residuals are the
largest difference between what a fit gives and what was drawn, as a share of the largest number that was drawn.
"""
from dataclasses import dataclass
from itertools import permutations, product

import numpy as np

from .errors import FrameError

FAR_AWAY = 1e6  # where an infinite far plane is put, world units


@dataclass(frozen=True)
class Lens:
    """A perspective camera: clip x = fx * x + cx * w, y alike, z = za * w + zb, w the distance along the view's axis."""

    fx: float
    fy: float
    cx: float
    cy: float
    za: float
    zb: float
    residual: float

    def view_of(self, clip, y_up):
        """Positions in view space of clip positions."""
        up = 1.0 if y_up else -1.0
        w = clip[:, 3]
        return np.c_[(clip[:, 0] - self.cx * w) / self.fx, up * (clip[:, 1] - self.cy * w) / self.fy, -w]

    def planes(self, minus_one):
        """(near, far, reversed): world units; far is at most FAR_AWAY."""
        low = -1.0 if minus_one else 0.0
        at = lambda z: self.zb / (z - self.za) if abs(z - self.za) > 1e-9 else FAR_AWAY
        first, last = abs(at(low)), abs(at(1.0))
        return min(first, last), min(max(first, last), FAR_AWAY), first > last


def homogeneous(points):
    return np.c_[points, np.ones(len(points))]


def residual(fitted, drawn):
    return float(np.abs(fitted - drawn).max() / max(np.abs(drawn).max(), 1e-30))


def _lens_of_mesh(objects, clip):
    """(fx, fy, cx, cy) from the rows of clip_from_object, or None: flat meshes and parallel projections do not tell."""
    points = homogeneous(objects)
    if len(points) < 4 or np.linalg.matrix_rank(points, 1e-6 * np.linalg.norm(points)) < 4:
        return None
    rows = np.linalg.lstsq(points, clip, rcond=None)[0].T
    x, y, w = rows[0, :3], rows[1, :3], rows[3, :3]
    scale = np.linalg.norm(w)
    if scale < 1e-6 or residual(points @ rows.T, clip) > 1e-4:
        return None
    cx, cy = x @ w / scale**2, y @ w / scale**2
    return np.linalg.norm(x - cx * w) / scale, np.linalg.norm(y - cy * w) / scale, cx, cy


def _lens_of_matrix(matrix, za):
    """(fx, fy, cx, cy) of a projection matrix with the z row that was drawn, or None."""
    for m in (matrix, matrix.T):
        if abs(abs(m[3, 2]) - 1) > 1e-6 or np.abs(m[3, [0, 1, 3]]).max() > 1e-6:
            continue
        if abs(m[0, 0]) < 1e-6 or abs(m[1, 1]) < 1e-6 or np.abs(m[[0, 0, 1, 1], [1, 3, 0, 3]]).max() > 1e-6:
            continue
        if abs(m[2, 2] * m[3, 2] - za) < 1e-4:
            return abs(m[0, 0]), abs(m[1, 1]), m[0, 2] * m[3, 2], m[1, 2] * m[3, 2]
    return None


def fit_lens(meshes, matrices=()):
    """The camera's lens of meshes [(object positions or None, clip positions)]: the median of what rigid meshes tell; of flat
    meshes alone, the projection among the constants `matrices`."""
    clip = np.concatenate([c for _, c in meshes])
    if np.ptp(clip[:, 3]) < 1e-6 * np.abs(clip[:, 3]).max():
        raise FrameError("the camera is orthographic (or everything stands at one distance): only perspective cameras can be told")
    za, zb = np.linalg.lstsq(np.c_[clip[:, 3], np.ones(len(clip))], clip[:, 2], rcond=None)[0]
    z_residual = residual(clip[:, 3] * za + zb, clip[:, 2])
    told = [lens for objects, c in meshes if objects is not None and (lens := _lens_of_mesh(objects, c)) is not None]
    if not told:
        told = [lens for m in matrices if (lens := _lens_of_matrix(m, za)) is not None][:1]
    if not told:
        raise FrameError("no mesh with positions of its own and no constant tells the camera's field of view")
    told = np.array(told)
    fx, fy, cx, cy = np.median(told, axis=0)
    spread = float(np.median(np.abs(told[:, :2] / [fx, fy] - 1)))
    return Lens(fx, fy, cx, cy, za, zb, max(spread, z_residual))


@dataclass
class LightFit:
    """clip_from_view of a layer of the map, as its casters were drawn (a bias that moved them lies in it)."""

    matrix: np.ndarray
    residuals: np.ndarray  # of x, y, z, w
    rank: int  # below 4 the casters lie in a plane, and one row of the matrix is not told


def fit_light(views, clips):
    """The matrix that takes casters' positions in view space to those in the light's clip space."""
    points = homogeneous(views)
    matrix = np.linalg.lstsq(points, clips, rcond=None)[0].T
    off = np.abs(points @ matrix.T - clips).max(0) / max(np.abs(clips).max(), 1e-30)
    return LightFit(matrix, off, int(np.linalg.matrix_rank(points, 1e-5 * np.linalg.norm(points))))


def _with_residuals(rows, points, clips):
    return LightFit(rows, np.abs(points @ rows.T - clips).max(0) / max(np.abs(clips).max(), 1e-30), 4)


def complete_flat(fit, views, clips, other):
    """The matrix of a layer whose casters lie in one plane, by another layer's `other`: cascades have parallel axes, and a cube's face
    is one of the 48 ways in which the axes of another can be exchanged."""
    points = homogeneous(views)
    if np.linalg.norm(other[3, :3]) * 1e5 < abs(other[3, 3]):
        rows = fit.matrix.copy()
        for r in range(3):
            scale, shift = np.linalg.lstsq(np.c_[points @ other[r], points @ other[3]], clips[:, r], rcond=None)[0]
            rows[r] = scale * other[r] + shift * other[3]
        rows[3] = other[3]
        return _with_residuals(rows, points, clips)
    length = [np.linalg.norm(other[r, :3]) for r in (0, 1, 3)]
    axes = [other[r] / length[k] for k, r in enumerate((0, 1, 3))]
    steep = np.linalg.norm(other[2, :3]) * np.sign(other[2, :3] @ other[3, :3]) / length[2]
    constant = other[2, 3] - steep * other[3, 3]
    faces = []
    for order in permutations(range(3)):
        for signs in product((1, -1), repeat=3):
            x, y, w = (sign * axes[k] for sign, k in zip(signs, order))
            w = w * length[2]
            faces.append(_with_residuals(np.array([x * length[0], y * length[1], steep * w + [0, 0, 0, constant], w]), points, clips))
    return min(faces, key=lambda face: face.residuals.max())


@dataclass(frozen=True)
class DistanceFit:
    """A map that stores the distance from a point: stored = (|place - apex| + moved) / range."""

    apex: np.ndarray
    range: float  # world units
    moved: float  # by how much the casters were moved away from the light, world units
    residual: float  # relative to the largest squared distance


def fit_distance(views, stored):
    """The point whose distance the vertices' stored numbers are, or None. It is linear: |p|^2 = 2 p.apex + c0 + c1 s + c2 s^2."""
    terms = np.c_[2 * views, np.ones(len(views)), stored, stored**2]
    squares = (views**2).sum(1)
    if np.linalg.matrix_rank(terms, 1e-9 * np.linalg.norm(terms)) < 6:
        return None
    found = np.linalg.lstsq(terms, squares, rcond=None)[0]
    off = residual(terms @ found, squares)
    if off > 1e-4 or found[5] <= 0:
        return None
    reach = float(np.sqrt(found[5]))
    return DistanceFit(found[:3], reach, float(-found[4] / (2 * reach)), off)


@dataclass(frozen=True)
class HalfFit:
    """One half of a dual paraboloid: what lies from the light in the unit direction d of the half's own axes is drawn at
    d.xy / (1 + d.z)."""

    turn: np.ndarray  # 3 x 3, from view space to the half's axes; it may mirror
    residual: float  # of x and y, of which 2 is the half's width


def fit_half(views, apex, clips):
    """The half whose vertices were drawn there, or None. It is linear: d.x - x d.z = x, of those that lie well before the half."""
    off = views - apex
    d = off / np.maximum(np.linalg.norm(off, axis=1), 1e-30)[:, None]
    x, y = (clips[:, :2] / clips[:, 3:]).T
    near = np.maximum(np.abs(x), np.abs(y)) < 1.5
    d, x, y = d[near], x[near], y[near]
    none = np.zeros_like(d)
    terms = np.r_[np.c_[d, none, -x[:, None] * d], np.c_[none, d, -y[:, None] * d]]
    if len(d) < 5 or np.linalg.matrix_rank(terms, 1e-6 * np.linalg.norm(terms)) < 9:
        return None
    u, _, v = np.linalg.svd(np.linalg.lstsq(terms, np.r_[x, y], rcond=None)[0].reshape(3, 3))
    turn = u @ v
    q = d @ turn.T
    fits = q[:, :2] / (1 + q[:, 2:]) - np.c_[x, y]
    worst = float(np.abs(fits).max())
    return HalfFit(turn, worst) if worst < 1e-4 else None


@dataclass(frozen=True)
class LightPlace:
    """A sun (no apex) or a light at a point, and which way it looks: `direction` is that of the light, in view space."""

    direction: np.ndarray
    apex: np.ndarray | None

    def is_same(self, other):
        """Whether both are one light: cascades of one sun, faces of one cube."""
        if (self.apex is None) != (other.apex is None):
            return False
        if self.apex is None:
            return float(self.direction @ other.direction) > 0.99999
        return float(np.linalg.norm(self.apex - other.apex)) < 1e-3 * (1 + float(np.linalg.norm(self.apex)))


def light_place(matrix, reversed_depth=False):
    """Where the light of clip_from_view is, and which way it looks: along growing depths, or falling ones where they are reversed."""
    w = matrix[3, :3]
    if np.linalg.norm(w) * 1e5 < abs(matrix[3, 3]):
        direction = np.cross(matrix[0, :3], matrix[1, :3])
        direction /= np.linalg.norm(direction)
        away = (direction @ matrix[2, :3] > 0) != reversed_depth
        return LightPlace(direction if away else -direction, None)
    rows = matrix[[0, 1, 3]]
    return LightPlace(w / np.linalg.norm(w), np.linalg.solve(rows[:, :3], -rows[:, 3]))
