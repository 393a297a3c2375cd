"""The camera's lens, by least squares on vertices as they were drawn: perspective, or parallel (w = 1, as a sun's matrix has it).

View space, rows and residuals are as in fit.py. Of a perspective camera the vertices tell all; of a parallel one they tell the
shape of what it sees, in units of the meshes' own positions, and a constant with that shape tells the size and the place.
"""
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from .errors import FrameError
from .fit import homogeneous, residual

FAR_AWAY = 1e6  # where an infinite far plane is put, world units
ALIKE = 1e-3  # shapes that differ by more are another camera's
LINE = 1e-4  # of the largest depth: a mesh whose depths are off the camera's line by more is drawn with another projection
TRIED = 40  # meshes from which the line is supposed
CORNERS = (1.0, 3.0)  # |x| and |y| of the vertices of a draw that covers the picture: a rectangle's, or one triangle's


@dataclass(frozen=True)
class Lens:
    """clip x / w = fx * x / d + cx of a perspective camera, whose z/w is za + zb / d, and fx * x + cx of a parallel one, whose z/w is
    za * d + zb; y alike. d is the distance along the view's axis."""

    fx: float
    fy: float
    cx: float
    cy: float
    za: float
    zb: float
    residual: float
    parallel: bool = False
    curved: bool = False  # of a perspective camera whose z/w is no such function, as of logarithmic depths: za and zb tell nothing

    def distance(self, z):
        """d of z/w."""
        return (z - self.zb) / self.za if self.parallel else self.zb / (z - self.za)

    def place(self, x, y, d, y_up):
        """Positions in view space of x/w and y/w at the distances d."""
        scale = 1.0 if self.parallel else d
        up = 1.0 if y_up else -1.0
        return np.stack([(x - self.cx) * scale / self.fx, up * (y - self.cy) * scale / self.fy, -d], -1)

    def view_of(self, clip, y_up):
        """Positions in view space of clip positions."""
        w, up = clip[:, 3], 1.0 if y_up else -1.0
        d = self.distance(clip[:, 2] / w) if self.parallel else w  # of which a perspective camera's may be 0
        scale = w if self.parallel else 1.0
        return np.c_[(clip[:, 0] - self.cx * w) / scale / self.fx, up * (clip[:, 1] - self.cy * w) / scale / self.fy, -d]

    def planes(self, minus_one):
        """(near, far, reversed): world units; far is at most FAR_AWAY. A parallel camera may see what lies behind it: near is below 0 then."""
        low = -1.0 if minus_one else 0.0
        if self.curved:
            return 1e-2, FAR_AWAY, False
        if self.parallel:
            first, last = float(self.distance(low)), float(self.distance(1.0))
        else:
            first, last = (float(abs(self.distance(z))) if abs(z - self.za) > 1e-9 else FAR_AWAY for z in (low, 1.0))
        return min(first, last), min(max(first, last), FAR_AWAY), first > last


def is_parallel(clip):
    """Whether all vertices of a draw have one w: a parallel projection's, or of one distance."""
    w = clip[:, 3]
    return bool(np.ptp(w) <= 1e-6 * np.abs(w).max())


def covers_the_picture(clip):
    """Whether a draw is a rectangle or a triangle over the whole picture, which shows no mesh."""
    flat = clip[:, :3] / clip[:, 3:]
    at_corners = np.isclose(np.abs(flat[:, :2])[..., None], CORNERS, atol=1e-6).any(-1)
    return is_parallel(clip) and np.ptp(flat[:, 2]) <= 1e-6 and bool(at_corners.all())


def _rows_of_mesh(objects, clip):
    """clip_from_object, or None: flat meshes and those that moved otherwise do not tell it."""
    points = homogeneous(objects)
    if len(points) < 4 or np.linalg.matrix_rank(points, 1e-6 * np.linalg.norm(points)) < 4:
        return None
    rows = np.linalg.lstsq(points, clip, rcond=None)[0].T
    told = [0, 1, 3]  # depths may be no projection's
    return rows if residual(points @ rows[told].T, clip[:, told]) <= 1e-4 else None


def fit_lens(meshes, matrices, state):
    """(the camera's lens, whether each mesh is drawn with it) of meshes [(object positions or None, clip positions)]: what most rigid meshes
    tell, or a projection among the constants `matrices`, which uneven scales do not hide. `state`: the pipeline at one of their draws."""
    clips = [c for _, c in meshes]
    rows = [_rows_of_mesh(objects, c) if objects is not None else None for objects, c in meshes]
    if is_parallel(np.concatenate(clips)):
        return _parallel_lens([r for r in rows if r is not None], matrices, state), [True] * len(meshes)
    return _perspective_lens(clips, rows, matrices)


# --- Perspective -----------------------------------------------------------------------------------------------------------

def _of_rows(rows):
    """(fx, fy, cx, cy) from the rows of clip_from_object, or None of a parallel projection and of a mesh that is scaled unevenly or sheared."""
    x, y, w = rows[0, :3], rows[1, :3], rows[3, :3]
    scale = np.linalg.norm(w)
    if scale < 1e-6:
        return None
    cx, cy = x @ w / scale**2, y @ w / scale**2
    x, y = x - cx * w, y - cy * w
    fx, fy = np.linalg.norm(x) / scale, np.linalg.norm(y) / scale
    return (fx, fy, cx, cy) if min(fx, fy) > 1e-6 and abs(x @ y) < ALIKE * scale**2 * fx * fy else None


def _of_camera(matrix, za, zb, curved):
    """(fx, fy, cx, cy) of a matrix that projects a rigid space with the z row that was drawn, or None. Curved depths are no matrix's."""
    for m in (matrix, matrix.T):
        if not np.isfinite(m).all() or abs(np.linalg.norm(m[3, :3]) - 1) > 1e-4:
            continue
        left = m[2] - za * m[3]
        if (curved or np.abs(left[:3]).max() < 1e-4 * abs(za) and abs(left[3] - zb) < 1e-3 * abs(zb) + 1e-6) and (lens := _of_rows(m)) is not None:
            return lens
    return None


def _line_of_most(clips):
    """((za, zb) with which most vertices are drawn, whether those of each mesh are)."""
    told = [c for c in clips if np.ptp(c[:, 3]) > 1e-4 * np.abs(c[:, 3]).max()] or [np.concatenate(clips)]
    of = lambda c: np.linalg.lstsq(np.c_[c[:, 3], np.ones(len(c))], c[:, 2], rcond=None)[0]
    off = lambda line, c: residual(c[:, 3] * line[0] + line[1], c[:, 2])
    best = max((of(c) for c in told[:TRIED]), key=lambda line: sum(len(c) for c in clips if off(line, c) < LINE))
    kept = [off(best, c) < LINE for c in clips]
    line = of(np.concatenate([c for c, one in zip(clips, kept) if one])) if any(kept) else best
    return line, kept


def _of_most(told):
    """(the lens with which most agree, how many do)."""
    told = np.array(told)
    alike = [(np.abs(told[:, :2] / one[:2] - 1).max(1) < ALIKE) & (np.abs(told[:, 2:] - one[2:]).max(1) < ALIKE) for one in told]
    best = max(alike, key=lambda one: one.sum())
    return np.median(told[best], axis=0), best


def _perspective_lens(clips, rows, matrices):
    (za, zb), kept = _line_of_most(clips)
    # Depths of another function lie on no line: few vertices share one then, and a constant draws none of them.
    curved = 2 * sum(len(c) for c, one in zip(clips, kept) if one) < sum(map(len, clips)) and len(clips) > 1
    kept = [True] * len(clips) if curved else kept
    rigid = [r for r, one in zip(rows, kept) if one and r is not None]
    told = [lens for m in matrices if (lens := _of_camera(m, za, zb, curved)) is not None] if not (curved and rigid) else []
    asked = len(told) or len(rigid)
    told = told or [lens for r in rigid if (lens := _of_rows(r)) is not None]
    if not told:
        raise FrameError("no mesh with positions of its own and no constant tells the camera's field of view")
    lens, alike = _of_most(told)
    if 2 * alike.sum() < asked:
        raise FrameError(f"the frame's {asked} solid meshes tell different fields of view, and no constant says which is the camera's: meshes that are "
                         "scaled unevenly hide it")
    spread = float(np.median(np.abs(np.array(told)[alike][:, :2] / lens[:2] - 1)))
    if curved:
        return Lens(*lens, 0.0, 0.0, spread, curved=True), kept
    used = np.concatenate([c for c, one in zip(clips, kept) if one])
    return Lens(*lens, za, zb, max(spread, residual(used[:, 3] * za + zb, used[:, 2]))), kept


# --- Parallel --------------------------------------------------------------------------------------------------------------

def _sizes(rows):
    """Lengths of the rows x, y and z of a parallel projection, or None of another matrix and where they are at no right angles."""
    scale = abs(rows[3, 3])
    if scale < 1e-12 or np.abs(rows[3, :3]).max() > 1e-6 * scale:
        return None
    lengths = np.linalg.norm(rows[:3, :3], axis=1)
    if lengths.min() < 1e-9 * lengths.max() or lengths.max() == 0:
        return None
    skewed = max(abs(rows[i, :3] @ rows[j, :3]) / (lengths[i] * lengths[j]) for i, j in combinations(range(3), 2))
    return lengths / scale if skewed < ALIKE else None


def _of_this_shape(matrices, shape):
    """(whether it is a projection alone, the matrix) of constants whose rows are as long as one another as `shape` is."""
    found = []
    for matrix in matrices:
        for m in (matrix, matrix.T) if np.isfinite(matrix).all() and matrix.any() else ():
            sizes = _sizes(m)
            if sizes is not None and np.abs(sizes / sizes[0] / shape - 1).max() < ALIKE:
                m = m / m[3, 3]
                found.append((bool(np.allclose(m[:3, :3], np.diag(np.diag(m)[:3]), atol=1e-6 * sizes.max())), m))
    return sorted(found, key=lambda one: not one[0])


def _parallel_lens(rows, matrices, state):
    told = np.array([sizes for r in rows if (sizes := _sizes(r)) is not None])
    if not len(told):
        raise FrameError("the camera is orthographic, and no solid mesh with positions of its own tells what it sees (or everything stands at one "
                         "distance)")
    shapes = told / told[:, :1]
    shape = np.median(shapes, axis=0)
    spread = float(np.median(np.abs(shapes / shape - 1)))
    away = -1.0 if state.reversed else 1.0
    first = 1.0 if state.reversed else -1.0 if state.conventions.minus_one else 0.0
    alone, constant = next(iter(_of_this_shape(matrices, shape)), (False, None))
    fx, fy, za = np.median(told, axis=0) if constant is None else _sizes(constant)
    cx, cy, zb = constant[:3, 3] if alone else (0.0, 0.0, first)  # without: the place before the middle of the near plane
    return Lens(float(fx), float(fy), float(cx), float(cy), float(away * za), float(zb), spread, True)
