"""Casters with an alpha mask: what of them casts stands in a texture, which no vertex tells. They are known by their holes: texels of the
map, or pixels of the camera, that lie within their triangles and show what is farther. Their shadows are left out."""
from collections import namedtuple

import numpy as np

from . import literals, spirv

FEW = 12  # holes, which may be rounding
SHARE = 0.01  # of a mesh's inner cells
TOLERANCE = 3e-4  # of stored depths, and of distances: more than interpolation is off
MOST_TRIANGLES = 2_000_000

SAMPLES, SEEMING = 4096, 0.03  # points of a mesh that are looked at first, and their share that must show what is farther
WIDEST = 512  # cells of a map along one side: of a larger one every second, third, ... texel is looked at

Cells = namedtuple("Cells", "near far")  # depths of a mesh by cell of a picture: rows, columns; inf and -inf where it is not


def can_discard(frame, event):
    """Whether a draw's fragment shader may leave fragments out; of a language that is not read, it may."""
    code = frame.fragment_code(event)
    if code is None:
        return False
    if isinstance(code, str):
        return "discard" in literals.without_comments(code)
    return code == b"" or spirv.can_discard(code)


def _parts(corners):
    """Four triangles in the place of each."""
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    ab, bc, ca = 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)
    return np.concatenate([np.stack(t, 1) for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])


def _keep(values, at, depths, sign):
    """Leaves the largest of sign * depths in each cell: of several that are assigned to one the last stays."""
    order = np.argsort(sign * depths)
    rows, columns, depths = at[0][order], at[1][order], depths[order]
    new = np.full(values.shape, -sign * np.inf)
    new[rows, columns] = depths
    np.copyto(values, new, where=sign * new > sign * values)


def _seems_to_have_holes(places, triangles, shown, tolerance, slopes):
    """A look at some points of a mesh before all of it is gone through: whether many show what is farther. `slopes` by which it was moved."""
    corners = places[triangles.reshape(-1, 3)]
    e1, e2 = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    area = e1[:, 0] * e2[:, 1] - e1[:, 1] * e2[:, 0]
    weight = np.nan_to_num(np.abs(area))
    if weight.sum() == 0:
        return False
    random = np.random.default_rng(1)
    at = random.choice(len(area), SAMPLES, p=weight / weight.sum())
    u, v = random.random((2, SAMPLES))
    u, v = np.where(u + v > 1, 1 - u, u), np.where(u + v > 1, 1 - v, v)
    points = corners[at, 0] + u[:, None] * e1[at] + v[:, None] * e2[at]
    rise = np.stack([e2[at, 1] * e1[at, 2] - e1[at, 1] * e2[at, 2], e1[at, 0] * e2[at, 2] - e2[at, 0] * e1[at, 2]], -1) / area[at, None]
    i, j = np.floor(points[:, 0]).astype(int), np.floor(points[:, 1]).astype(int)
    inside = (i >= 0) & (j >= 0) & (i < shown.shape[1]) & (j < shown.shape[0])
    if not inside.any():
        return False
    farther = shown[j[inside], i[inside]] > (points[:, 2] + (1 + slopes) * np.abs(rise).sum(1) + tolerance)[inside]
    return farther.mean() >= SEEMING


def cells(places, triangles, shape):
    """Cells of a picture of `shape` (rows, columns) that triangles cover. `places`: column, row, depth of each vertex, NaN behind the eye."""
    corners = places[triangles.reshape(-1, 3)]
    rows, columns = shape
    with np.errstate(invalid="ignore"):
        low, high = corners[..., :2].min(1), corners[..., :2].max(1)
        corners = corners[(high >= 0).all(1) & (low[:, 0] < columns) & (low[:, 1] < rows)]
    near, far = np.full(shape, np.inf), np.full(shape, -np.inf)
    while len(corners):
        size = np.ptp(corners[..., :2], axis=1).max(1)
        fine = (size <= 0.7) | (len(corners) > MOST_TRIANGLES)
        points = np.concatenate([corners[fine].reshape(-1, 3), corners[fine].mean(1)])
        i, j = np.floor(points[:, 0]).astype(int), np.floor(points[:, 1]).astype(int)
        kept = (i >= 0) & (j >= 0) & (i < columns) & (j < rows)
        at = j[kept], i[kept]
        _keep(near, at, points[kept, 2], -1)
        _keep(far, at, points[kept, 2], 1)
        corners = _parts(corners[~fine])
        low, high = (corners[..., :2].min(1), corners[..., :2].max(1)) if len(corners) else (np.zeros((0, 2)),) * 2
        corners = corners[(high >= 0).all(1) & (low[:, 0] < columns) & (low[:, 1] < rows)]
    return Cells(near, far)


def _around(values, best, reach=1):
    """The least or largest (`best`: np.minimum, np.maximum) of each cell's neighbours within `reach`."""
    for axis in (0, 1):
        out = values.copy()
        for step in range(1, min(reach, values.shape[axis] - 1) + 1):
            low, high = [slice(None)] * 2, [slice(None)] * 2
            low[axis], high[axis] = slice(None, -step), slice(step, None)
            out[tuple(low)] = best(out[tuple(low)], values[tuple(high)])
            out[tuple(high)] = best(out[tuple(high)], values[tuple(low)])
        values = out
    return values


def _has_holes(places, triangles, shown, tolerance, slopes=0.0):
    """Whether inner cells of a mesh show what is farther than it."""
    if not len(triangles) or not _seems_to_have_holes(places, triangles, shown, tolerance, slopes):
        return False
    mesh = cells(places, triangles, shown.shape)
    inner = np.isfinite(_around(np.where(np.isfinite(mesh.near), mesh.near, np.inf), np.maximum))
    far = _around(mesh.far, np.maximum)
    with np.errstate(invalid="ignore"):
        far = far + slopes * (far - _around(mesh.near, np.minimum))
    holes = inner & (shown > far + tolerance)
    return holes.sum() >= max(FEW, SHARE * inner.sum())


def _not_culled(layer, mesh):
    """Corners of the triangles that a layer's culling leaves; those that reach behind the light stay."""
    if not layer.state.side:
        return mesh.corners
    corners = mesh.clip[mesh.corners.reshape(-1, 3)]
    x, y, w = corners[..., 0], corners[..., 1], corners[..., 3]
    area = np.linalg.det(np.stack([x, y, w], -1))  # its sign is that of the area, where all w are above 0
    return mesh.corners.reshape(-1, 3)[(area * layer.state.side > 0) | (w <= 0).any(1)].reshape(-1)


def _step(layer):
    return -(-max(layer.texels.shape) // WIDEST)


def in_map(layer, clip):
    """Places of clip positions in a layer's cells: column, row, stored depth, larger farther."""
    clip_is, w = layer.state.conventions, np.where(clip[:, 3] > 0, clip[:, 3], np.nan)
    x, y = clip[:, 0] / w, clip[:, 1] / w
    rows, columns = layer.texels.shape
    z = clip_is.window_row(clip[:, 2], clip[:, 3]) / w
    columns, rows = columns / _step(layer), rows / _step(layer)
    return np.c_[(x * 0.5 + 0.5) * columns, ((y if clip_is.bottom_row_first else -y) * 0.5 + 0.5) * rows, -z if layer.state.reversed else z]


def in_picture(lens, points, shape):
    """Places of view-space points in the camera's picture, its first row at the top: column, row, distance along the axis."""
    d = np.where(-points[:, 2] > 1e-6, -points[:, 2], np.nan)
    scale = 1.0 if lens.parallel else d
    rows, columns = shape
    x, y = lens.fx * points[:, 0] / scale + lens.cx, lens.fy * points[:, 1] / scale
    return np.c_[(x * 0.5 + 0.5) * columns, (0.5 - 0.5 * (y + lens.cy)) * rows, d]


def _stored(layer):
    texels = layer.texels[::_step(layer), ::_step(layer)]
    return -texels if layer.state.reversed else texels


def _key(place, mesh):
    return mesh.source if place is None else place


def find(frame, view, layers, pixels, silent=()):
    """Meshes with a mask, without those that cast nothing anyway: places of the camera's, sources of casters that it does not draw."""
    distance = np.where(pixels.drawn, -pixels.positions[..., 2], np.inf)
    found = set()
    for layer in layers:
        if layer.distance or layer.is_colour:
            continue
        shown, moved = _stored(layer), layer.state.depth_bias
        shift, slopes = TOLERANCE + abs(moved.get("constant", 0)) * 2.0**-16, abs(moved.get("slope", 0))
        for k, mesh in layer.pairs:
            key = _key(k, mesh)
            if key not in found and can_discard(frame, mesh.event) and _has_holes(in_map(layer, mesh.clip), _not_culled(layer, mesh), shown, shift, slopes):
                found.add(key)
    for k, (mesh, points) in enumerate(zip(view.meshes, view.positions)):
        if k not in found and k not in silent and can_discard(frame, mesh.event):
            places = in_picture(view.lens, points, distance.shape)
            if _has_holes(places, mesh.corners, distance, TOLERANCE * np.nan_to_num(places[:, 2]).max()):
                found.add(k)
    return found


def pixels_of(view, masked, pixels):
    """Pixels that show one of the meshes."""
    shape = pixels.drawn.shape
    distance, own = -pixels.positions[..., 2], np.zeros(shape, bool)
    for k in (k for k in masked if isinstance(k, int)):
        mine = cells(in_picture(view.lens, view.positions[k], shape), view.meshes[k].corners, shape)
        own |= (distance > _around(mine.near, np.minimum) * (1 - 3 * TOLERANCE)) & (distance < _around(mine.far, np.maximum) * (1 + 3 * TOLERANCE))
    return own & pixels.drawn


def shadowed_by(layers, masked, pixels, reach):
    """Pixels that lie behind one of the meshes as the light sees it, or within `reach` texels of that."""
    from . import lookup

    places = pixels.positions[pixels.drawn]
    behind = np.zeros(len(places), bool)
    for layer in layers:
        if layer.matrix is None or layer.distance:
            continue
        near, step = np.full(_stored(layer).shape, np.inf), _step(layer)
        for k, mesh in layer.pairs:
            if _key(k, mesh) in masked:
                near = np.minimum(near, cells(in_map(layer, mesh.clip), mesh.corners, near.shape).near)
        near = _around(near, np.minimum, 1 + int(np.ceil(reach / step)))
        near = near.repeat(step, 0).repeat(step, 1)[:layer.texels.shape[0], :layer.texels.shape[1]]
        first, inside = lookup.nearest(layer, places, near)
        _, _, depth, _ = lookup.texel_places(layer, places)
        behind |= inside & ((-depth if layer.state.reversed else depth) > first - 10 * TOLERANCE)
    out = np.zeros(pixels.drawn.shape, bool)
    out[pixels.drawn] = behind
    return out


def leave_out(frame, found, layers, pixels):
    """Takes meshes with a mask out of the scene, and pixels that show them or lie in their shadow; returns find()'s."""
    masked = find(frame, found.view, layers, pixels, found.roles.silent)
    if not masked:
        return masked
    found.roles.silent |= {k: "has an alpha mask: what of it casts is not told" for k in masked if isinstance(k, int)}
    found.roles.gone |= masked
    own = pixels_of(found.view, masked, pixels)
    pixels.hidden |= own
    left_out = (own | shadowed_by(layers, masked, pixels, 1)) & pixels.asked
    pixels.asked &= ~left_out
    found.notes.append(f"{int(left_out.sum())} pixels of casters with an alpha mask, and in their shadow, are not compared")
    return masked
