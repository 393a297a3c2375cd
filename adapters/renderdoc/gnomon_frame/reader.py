"""The matrix with which the reader looks a place up in the map, found among its constants, and what the casters' differs by.

No name of a variable is asked for. A constant is the reader's matrix if its rows are those of the casters' matrix but for the
scale and shift to texture coordinates; before it may stand the way from the camera's view space to the engine's world (any
rigid constant, and axes that point the other way).
"""
from dataclasses import dataclass
from itertools import product

import numpy as np

ENOUGH = 1e-3  # a matrix whose rows differ by more is another one


@dataclass(frozen=True)
class ReaderMatrix:
    """clip_from_view with which the map is read: x and y as the casters' matrix has them, z/w is what the map stores."""

    matrix: np.ndarray
    name: str  # the constant's
    before: str  # the constant that takes view space to the matrix's own, or "view space"
    residual: float  # largest relative difference of its rows and the casters'
    has_depth: bool  # whether its z row is that of the casters; else theirs stands in for it
    stretch: tuple = (1.0, 1.0)  # by how much it widens the casters' x and y beyond any usual place in the texture


def is_rigid(m):
    """A rotation (or reflection) and a shift, and not the identity."""
    turn = m[:3, :3]
    return bool(np.allclose(m[3], [0, 0, 0, 1], atol=1e-6) and np.allclose(turn @ turn.T, np.eye(3), atol=1e-4)
                and not np.allclose(m, np.eye(4)))


def _usable(matrices):
    """[(name, matrix)] of both ways in which sixteen numbers can be written, without what cannot be a matrix of a light."""
    out, seen = [], set()
    for name, m in matrices:
        for shown, turned in ((name, m), (name + " (transposed)", m.T)):
            key = np.asarray(turned, np.float32).tobytes()
            if key in seen or not np.isfinite(turned).all() or np.abs(turned).max() < 1e-9 or np.abs(turned).max() > 1e12:
                continue
            seen.add(key)
            out.append((shown, np.asarray(turned, float)))
    return out


def _ways(usable, more):
    """[(name, matrix)] from view space to the space in which a constant may work."""
    rigid = [("view space", np.eye(4)), *more]
    for name, m in usable:
        if is_rigid(m):
            rigid += [(name, m), (name + " (inverse)", np.linalg.inv(m))]
    axes = [np.diag([*signs, 1.0]) for signs in product((1, -1), repeat=3)]
    return [(name, m @ turn) for name, m in rigid for turn in axes]


def through_model(matrices, objects, view):
    """[(name, matrix)]: from view space to the engine's world, of constants that take a mesh from its own space to the world, where
    what the camera makes of the mesh (`objects` to `view`) is solid enough to be turned back."""
    points = np.c_[objects, np.ones(len(objects))]
    if np.linalg.matrix_rank(points, 1e-6 * np.linalg.norm(points)) < 4:
        return []
    view_from_object = np.eye(4)
    view_from_object[:3] = np.linalg.lstsq(points, view, rcond=None)[0].T
    back = np.linalg.inv(view_from_object)
    return [(name, m @ back) for name, m in _usable(matrices) if np.allclose(m[3], [0, 0, 0, 1], atol=1e-6) and is_rigid(m @ back)]


def _misfit(rows, wanted):
    """How far rows [n, 4] are from the span of both rows `wanted`, relative."""
    basis = np.linalg.qr(np.array(wanted).T)[0]
    return np.linalg.norm(rows - rows @ basis @ basis.T, axis=1) / np.maximum(np.linalg.norm(rows, axis=1), 1e-30)


def texture_places(offset, size, whole):
    """[(scale, shift)]: what a reader may make of a clip coordinate of a layer that lies so in its texture, along one axis: nothing, a
    place in the layer or one in the texture, each the other way round, too."""
    middle, half = (offset + 0.5 * size) / whole, 0.5 * size / whole
    return [(1, 0), (-1, 0), (0.5, 0.5), (-0.5, 0.5), (half, middle), (-half, middle), (-half, 1 - middle)]


def _lies_there(t, casters, places):
    """Whether x and y are the casters' but for one of `places`: a shift of the world would give a sun's the same directions."""
    for r in (0, 1):
        found = np.linalg.lstsq(np.array([casters[r], t[3]]).T, t[r], rcond=None)[0]
        if not any(np.abs(found - place).max() < ENOUGH for place in places[r]):
            return False
    return True


def _stretch(t, casters, places):
    """By how much x and y are wider than the nearest of `places` makes them."""
    out = []
    for r in (0, 1):
        scale, shift = np.linalg.lstsq(np.array([casters[r], t[3]]).T, t[r], rcond=None)[0]
        off = lambda place: (abs(shift - place[1]) > ENOUGH, abs(np.log(max(abs(scale / place[0]), 1e-30))))
        out.append(float(abs(scale / min(places[r], key=off)[0])))
    return tuple(out)


def _match(candidates, ways, casters, stored_row, places):
    """The best of one constant after every way: (rank, way's name, matrix scaled as the casters', stretch); a rank is (whether its depths are the
    casters', whether it leads to their place in the texture, less the residual)."""
    w = casters[3]
    perspective = np.linalg.norm(w[:3]) > 1e-5 * abs(w[3])
    length = w[:3] @ w[:3] if perspective else w[3] * w[3]
    scale = candidates[:, 3, :3] @ w[:3] / length if perspective else candidates[:, 3, 3] * w[3] / length
    fine = np.abs(scale) > 1e-12
    if not fine.any():
        return None
    t = candidates[fine] / scale[fine, None, None]
    kept = [way for way, good in zip(ways, fine) if good]
    off = np.linalg.norm(t[:, 3, :3] - w[:3], axis=1) / np.linalg.norm(w)
    if not perspective:
        off = np.maximum(off, np.abs(t[:, 3, 3] - w[3]) / abs(w[3]))
    for r in (0, 1):
        # A light's apex may have been shifted along its axis by the bias: w counts as the reader has it.
        direct = np.array([_misfit(t[k, r][None], [casters[r], t[k, 3]])[0] for k in range(len(t))]) if perspective else \
            _misfit(t[:, r], [casters[r], w])
        turned = np.abs(t[:, r, :3] @ casters[r, :3]) < 1e-9 * np.linalg.norm(casters[r, :3])
        off = np.maximum(off, np.where(turned, 1.0, direct))
    # All axes turned round give a sun the same x and y: its depths decide.
    best = None
    for k in np.flatnonzero(off <= ENOUGH):
        depth, has_depth = _depth_row(t[k], stored_row)
        rank = has_depth, not places or _lies_there(t[k], casters, places), -float(off[k])
        if best is None or rank > best[0]:
            stretch = _stretch(t[k], casters, places) if places else (1.0, 1.0)
            best = rank, kept[k][0], np.array([casters[0], casters[1], depth, t[k, 3]]), stretch
    return best


def _depth_row(t, stored_row):
    """The z row as the map stores it: as it is, or from -1..1; or the casters' where the reader works its depth out otherwise."""
    length = np.linalg.norm(stored_row[:3])
    for row in (t[2], 0.5 * (t[2] + t[3])):
        if np.linalg.norm(row[:3] - stored_row[:3]) < 1e-2 * length:
            return row, True
    return stored_row, False


def find_reader(matrices, casters, stored_row, more_ways=(), places=()):
    """The reader's matrix among constants [(name, 4x4)], or None. `casters`: clip_from_view as they were drawn; `stored_row`: its
    row whose quotient by w is stored; `more_ways`: as through_model() gives them; `places`: texture_places() along x and y."""
    usable = _usable(matrices)
    ways = _ways(usable, more_ways)
    turns = np.array([m for _, m in ways])
    best = None
    for name, m in usable:
        if np.allclose(m, np.eye(4)):
            continue
        found = _match(m @ turns, ways, casters, stored_row, places)
        if found and (best is None or found[0] > best[0]):
            best = found[0], ReaderMatrix(found[2], name, found[1], -found[0][2], found[0][0], found[3])
    return best and best[1]


@dataclass(frozen=True)
class CasterShift:
    """By how much the casters were drawn away from where the reader looks for them."""

    world: float  # along the light's axis, away from it, world units
    stored: float | None  # the same as a difference of stored numbers; None where it depends on the distance
    residual: float  # what of the difference is no shift along the axis, stored numbers or relative


def caster_shift(casters, stored_row, reader, reversed_depth=False):
    """The constant between the casters' depth and the reader's."""
    w = casters[3]
    if np.linalg.norm(w[:3]) < 1e-5 * abs(w[3]):
        difference = (stored_row - reader.matrix[2]) / w[3]
        length = np.linalg.norm(stored_row[:3]) / abs(w[3])
        away = -1.0 if reversed_depth else 1.0
        return CasterShift(away * difference[3] / length, difference[3], float(np.linalg.norm(difference[:3]) / length))
    along = (w - reader.matrix[3]) / np.linalg.norm(w[:3])
    return CasterShift(float(along[3]), None, float(np.linalg.norm(along[:3])))
