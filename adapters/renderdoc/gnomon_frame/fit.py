"""Least squares on vertices as they were drawn: a light's matrix, what moved casters.

Vertices are rows; a homogeneous point has four columns. Matrices act on columns (clip = matrix @ point). World space is the
camera's view space: x to the right, y up, looking along -z, which any engine's conventions leave alike. Residuals are the
largest difference between what a fit gives and what was drawn, as a share of the largest number that was drawn.
"""
from dataclasses import dataclass
from itertools import permutations, product

import numpy as np


WARPED = 1e-4  # how far a map's x, y and w are from one plane of directions where its light is a sun


def homogeneous(points):
    return np.c_[points, np.ones(len(points))]


def residual(fitted, drawn):
    return float(np.abs(fitted - drawn).max() / max(np.abs(drawn).max(), 1e-30))


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


def _rays(matrix):
    """Singular values, and vectors as rows, of what a map's x, y and w change with, each made of length 1."""
    rows = matrix[[0, 1, 3], :3]
    return np.linalg.svd(rows / np.maximum(np.linalg.norm(rows, axis=1), 1e-30)[:, None])[1:]


def is_warped(matrix):
    """Whether a sun's map is divided by a number that grows across its rays (light space perspective maps, trapezoids)."""
    return bool(np.linalg.norm(matrix[3, :3]) * 1e5 >= abs(matrix[3, 3]) and _rays(matrix)[0][2] < WARPED)


def light_place(matrix, reversed_depth=False):
    """Where the light of clip_from_view is, and which way it looks: along growing depths, or falling ones where they are reversed."""
    w = matrix[3, :3]
    if is_warped(matrix):
        direction = _rays(matrix)[1][2]
        return LightPlace(direction if (direction @ matrix[2, :3] > 0) != reversed_depth else -direction, None)
    if np.linalg.norm(w) * 1e5 < abs(matrix[3, 3]):
        direction = np.cross(matrix[0, :3], matrix[1, :3])
        direction /= np.linalg.norm(direction)
        away = (direction @ matrix[2, :3] > 0) != reversed_depth
        return LightPlace(direction if away else -direction, None)
    rows = matrix[[0, 1, 3]]
    return LightPlace(w / np.linalg.norm(w), np.linalg.solve(rows[:, :3], -rows[:, 3]))
