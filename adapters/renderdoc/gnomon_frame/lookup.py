"""The reader's test, done again: which texel a place looks up, what a constant bias, the choice of a cascade and a filter make of it.

Margins are stored numbers, positive where the place is lit: what the texel holds minus the place's depth, or, where depths are
reversed, the other way round. They are what the picture is held against to find how the frame was drawn.
"""
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

SURE = 0.02  # a pixel so near to lit or shadowed was decided by one comparison
CLEARLY = 0.3  # layers that differ by more tell what a picture has of each
BLENDED = 0.05  # shares of a blend from here to 1 less this are held against the distance
FEW = 15  # places, too few to tell a law by
MOST_ENDS = 8  # of cascades that stand in one constant
NOISE = 1e-3  # of the pixels: on borders of texels, arithmetic decides


@dataclass
class Margins:
    """Of each place in one layer."""

    values: np.ndarray  # 1 where outside
    inside: np.ndarray
    column: np.ndarray  # the texel, in the layer's own rectangle
    row: np.ndarray


def texel_places(layer, positions):
    """(column, row, depth, inside) of view-space positions in a layer: texels as real numbers, depths as stored."""
    clip = positions @ layer.matrix[:, :3].T + layer.matrix[:, 3]
    if layer.half:
        distance = np.linalg.norm(clip[:, :3], axis=1)
        front, w, z = clip[:, 2] >= 0, distance + np.abs(clip[:, 2]), distance / layer.distance.range
    else:
        front = clip[:, 3] > 0
        w = np.where(front, clip[:, 3], 1)
        z = clip[:, 2] / w if layer.content is None else _as_stored(layer, positions, clip[:, 2] / w)
    x, y = clip[:, 0] / w, clip[:, 1] / w
    rows, columns = layer.texels.shape
    up = y if layer.state.conventions.bottom_row_first else -y
    return (x * 0.5 + 0.5) * columns, (up * 0.5 + 0.5) * rows, z, front & (np.abs(x) < 1) & (np.abs(y) < 1)


def _as_stored(layer, positions, z):
    """The number that a texel of this content stores of places, without its warp."""
    content = layer.content
    if content.base == "depth":
        return z
    off = positions - layer.place.apex
    world = np.linalg.norm(off, axis=1) if content.base == "distance" else off @ layer.place.direction
    return (world - content.range[0]) / (content.range[1] - content.range[0])


def margins(layer, positions):
    column, row, depth, inside = texel_places(layer, positions)
    column = np.clip(np.where(inside, column, 0).astype(int), 0, layer.texels.shape[1] - 1)
    row = np.clip(np.where(inside, row, 0).astype(int), 0, layer.texels.shape[0] - 1)
    stored = layer.texels[row, column]
    values = depth - stored if layer.state.reversed else stored - depth
    return Margins(np.where(inside, values, 1.0), inside, column, row)


def best_constant(values, lit, candidates=()):
    """(constant, share of pixels that it decides otherwise than the picture, the share without one): the bias in stored numbers
    with which margins give the picture. 0 where it is as good; one of the reader's own numbers, of either sign, where one is."""
    order = np.argsort(values)
    sorted_values, sorted_lit = values[order], lit[order]
    # With a threshold before place k, all from k on are lit.
    wrong = np.concatenate([[0], np.cumsum(sorted_lit)]) + np.concatenate([np.cumsum(~sorted_lit[::-1])[::-1], [0]])
    count = max(len(values), 1)
    at = lambda constant: float(np.mean((values + constant >= 0) != lit)) if len(values) else 0.0
    least, now = wrong.min() / count, at(0.0)
    if now <= least + NOISE:
        return 0.0, now, now
    k = int(np.argmin(wrong))
    middle = -0.5 * (sorted_values[max(k - 1, 0)] + sorted_values[min(k, len(values) - 1)])
    near = [c for number in candidates for c in (number, -number) if c and at(c) <= least + NOISE]
    constant = min(near, key=lambda c: (at(c), abs(c))) if near else float(middle)
    return constant, at(constant), now


@dataclass(frozen=True)
class Selection:
    """How a layer of several is chosen: "first" that holds the place, or by "view_z" or "distance" up to each of `limits`."""

    by: str
    limits: tuple
    share: float  # pixels that it decides otherwise than the picture
    blends: tuple = ()  # world units before each limit over which the next layer takes over; empty: 0 at all


def _limit(part, keys, numbers, below):
    """One end of a layer along sorted keys, of the cost `part` of each place among them: of a number of the reader's where one is as good, and
    of those that nothing seen tells apart the nearest to what is seen."""
    count = len(keys)
    fine = np.flatnonzero(part <= part.min() + NOISE * count)
    low = keys[fine[0] - 1] if fine[0] > 0 else 0.0
    high = keys[fine[-1]] if fine[-1] < count else np.inf
    # Of an open range the end that is seen: before all places the next one, behind all of them the last.
    here = float(keys[-1]) * (1 + 1e-6) if np.isinf(high) else float(high if low == 0 else keys[min(int(np.argmin(part)), count - 1)])
    cost = lambda n: part[min(int(np.searchsorted(keys, n)), len(part) - 1)]
    known = [n for n in numbers if low <= n <= high and 0 < n < below]
    return float(min(known, key=lambda n: (cost(n), abs(n - here)))) if known else min(here, below)


def _limits(cost, keys, numbers):
    """Ends of the layers along sorted keys: least cost, found layer by layer."""
    layers, count = cost.shape
    prefix = np.concatenate([np.zeros((layers, 1)), np.cumsum(cost, axis=1)], axis=1)
    best = [prefix[0]]
    for k in range(1, layers):
        best.append(prefix[k] + np.minimum.accumulate(best[-1] - prefix[k]))
    ends, end = [], np.inf
    for k in range(layers - 1, 0, -1):
        held = int(np.searchsorted(keys, end)) if np.isfinite(end) else count
        end = _limit((best[k - 1] - prefix[k])[:held + 1], keys, numbers, end)
        ends.append(end)
    return tuple(reversed(ends))


def index_of(selection, layers_inside, keys):
    """The layer that each place looks up, -1 where none: of whether each layer holds it, and of `keys` {"view_z": .., "distance": ..}."""
    if selection.by == "first":
        out = np.full(layers_inside[0].shape, -1)
        for k in range(len(layers_inside) - 1, -1, -1):
            out[layers_inside[k]] = k
        return out
    index = np.searchsorted(np.array(selection.limits), keys[selection.by], side="right")
    return np.where(index >= len(layers_inside), -1, index)


def choices(all_margins, lit, keys, numbers=(), vectors=(), told=False):
    """The Selections that may be, the first that holds a place before those by `keys` {"view_z": .., "distance": ..} of the places. `vectors`:
    numbers that stand together in a constant of the reader. `told`: places whose light the map decides, so that some layer is looked up there."""
    values, inside = np.array([m.values for m in all_margins]), [m.inside for m in all_margins]
    wrong, none = (values >= 0) != lit, ~lit | told  # beyond the last layer everything is lit

    def with_share(selection):
        index = index_of(selection, inside, keys)
        return replace(selection, share=float(np.mean(np.where(index >= 0, np.take_along_axis(wrong, np.maximum(index, 0)[None], 0)[0], none))))

    out = [with_share(Selection("first", (), 0.0))]
    for by, key in keys.items() if len(all_margins) > 1 else ():
        order = np.argsort(key)
        ends = [_limits(np.concatenate([wrong, none[None]])[:, order].astype(float), key[order], numbers), *_rising(vectors, len(all_margins))]
        found, *given = [with_share(Selection(by, one, 0.0)) for one in ends]
        best = min(given, key=lambda one: one.share, default=found)
        out.append(best if best.share <= found.share + 0.2 * NOISE else found)
    return out


def _rising(vectors, count):
    """Ends of `count` layers that stand together in one constant: as many rising numbers, of which those of layers that this frame does not draw
    are left out, or one less, behind which the last layer goes on."""
    ends = [v for v in vectors if count - 1 <= len(v) <= MOST_ENDS and count > 1 and all(0 < a < b for a, b in zip((1e-30, *v), v))]
    return [one for v in ends for one in ([(*v, np.inf)] if len(v) == count - 1 else combinations(v, count))]


def choose_layers(all_margins, lit, keys, numbers=(), vectors=(), told=False):
    """(Selection, index of each place's layer, -1 where none) of choices()."""
    best, *others = choices(all_margins, lit, keys, numbers, vectors, told)
    for one in others:
        best = one if one.share < best.share - 0.2 * NOISE else best
    return best, index_of(best, [m.inside for m in all_margins], keys)


@dataclass(frozen=True)
class LookedUp:
    """Layers of a map, and which of them each of some places looks up; -1 where none."""

    layers: list
    index: np.ndarray

    def of(self, kept):
        return replace(self, index=self.index[kept])

    def _gathered(self, fills, work):
        """The arrays that work(layer, its places) gives, of all places; `fills`: what stands where no layer is looked up."""
        out = [np.full(len(self.index), fill) for fill in fills]
        for k, layer in enumerate(self.layers):
            mine = self.index == k
            for whole, part in zip(out, work(layer, mine) if mine.any() else ()):
                whole[mine] = part
        return out

    def margins(self, places):
        """(margins, whether a layer holds each place)"""
        def of_layer(layer, mine):
            found = margins(layer, places[mine])
            return found.values, found.inside
        return self._gathered((1.0, False), of_layer)

    def between_texels(self, places):
        """The same where a sampler interpolates the depths first."""
        def of_layer(layer, mine):
            stored, inside = bilinear(layer, places[mine], layer.texels)
            depth = texel_places(layer, places[mine])[2]
            return np.where(inside, depth - stored if layer.state.reversed else stored - depth, 1.0), inside
        return self._gathered((1.0, False), of_layer)

    def filtered(self, places, bias, reach, sampler, step=1):
        return self._gathered((1.0,), lambda layer, mine: (filtered(layer, places[mine], bias[mine], reach, sampler, step),))[0]

    def filter_radius(self, places, bias):
        """Of the first layer whose places tell one."""
        of_layers = (filter_radius(layer, places[self.index == k], bias[self.index == k]) for k, layer in enumerate(self.layers))
        return next((radius for radius in of_layers if radius is not None), None)

    def texel_areas(self, places):
        """Squared widths of a texel at the places, world units."""
        def of_layer(layer, mine):
            moved = texel_places(layer, places[mine] + layer.place.direction[[1, 2, 0]] * 1e-2)
            here = texel_places(layer, places[mine])
            return (1e-4 / np.maximum((moved[0] - here[0]) ** 2 + (moved[1] - here[1]) ** 2, 1e-12),)
        return self._gathered((np.nan,), of_layer)[0]


@dataclass
class Answer:
    """What one layer's test makes of each place."""

    light: np.ndarray  # 0 shadowed, 1 lit
    inside: np.ndarray


def answer(layer, positions, bilinear, bias=None):
    """The layer's own test: one comparison, or the four nearest, weighed by how near they are. `bias` of each place, in place of the layer's constant."""
    column, row, depth, inside = texel_places(layer, positions)
    rows, columns = layer.texels.shape
    bias = layer.constant if bias is None else bias

    def lit(i, j):
        stored = layer.texels[np.clip(j, 0, rows - 1).astype(int), np.clip(i, 0, columns - 1).astype(int)]
        return ((depth - stored if layer.state.reversed else stored - depth) + bias >= 0).astype(float)

    column, row = np.where(inside, column, 0), np.where(inside, row, 0)
    light = _weighed(column, row, lit) if bilinear else lit(np.floor(column), np.floor(row))
    return Answer(np.where(inside, light, 1.0), inside)


def filtered(layer, positions, bias, reach, sampler, step=1):
    """What comparisons at up to `reach` steps around each place make of it on average. `sampler`: what each is of, "nearest" the place's own texel,
    "compares" the four nearest, weighed, "interpolates" one depth between these. Of one part of an atlas, that of the whole is sometimes taken for
    its width: a step is two texels then."""
    column, row, depth, _ = texel_places(layer, positions)
    rows, columns = layer.texels.shape
    stored = lambda i, j: layer.texels[np.clip(j, 0, rows - 1).astype(int), np.clip(i, 0, columns - 1).astype(int)]
    lit = lambda of: ((depth - of if layer.state.reversed else of - depth) + bias >= 0).astype(float)
    one = {"nearest": lambda i, j: lit(stored(np.floor(i), np.floor(j))), "compares": lambda i, j: _weighed(i, j, lambda *at: lit(stored(*at))),
           "interpolates": lambda i, j: lit(_weighed(i, j, stored))}[sampler]
    steps = step * np.arange(-reach, reach + 1)
    return np.mean([one(column + i, row + j) for i in steps for j in steps], axis=0)


def _weighed(column, row, at):
    """What a sampler makes of the four texels `at(i, j)` around places, each weighed by how near it is."""
    i, j = np.floor(column - 0.5), np.floor(row - 0.5)
    x, y = column - 0.5 - i, row - 0.5 - j
    return (1 - y) * ((1 - x) * at(i, j) + x * at(i + 1, j)) + y * ((1 - x) * at(i, j + 1) + x * at(i + 1, j + 1))


def bilinear(layer, positions, texels):
    """(values between the four texels around each position, whether the layer holds it)."""
    column, row, _, inside = texel_places(layer, positions)
    rows, columns = texels.shape
    at = lambda i, j: texels[np.clip(j, 0, rows - 1).astype(int), np.clip(i, 0, columns - 1).astype(int)]
    return _weighed(np.where(inside, column, 0), np.where(inside, row, 0), at), inside


def averages(layer, positions, which):
    """(what a linear sampler reads of a map of moments [n, channels], whether the layer holds each place)."""
    channels = [bilinear(layer, positions, layer.averages[which][..., k]) for k in range(layer.content.channels)]
    return np.stack([values for values, _ in channels], -1), channels[0][1]


def nearest(layer, positions, texels):
    """(value of the texel in which each position lies, whether the layer holds it)."""
    column, row, _, inside = texel_places(layer, positions)
    rows, columns = texels.shape
    at = lambda places, count: np.clip(np.where(inside, places, 0).astype(int), 0, count - 1)
    return texels[at(row, rows), at(column, columns)], inside


def widened(texels, reach):
    """Texels within `reach` columns and rows of one that is set."""
    for axis in (0, 1):
        out = texels.copy()
        for step in range(1, min(reach, texels.shape[axis] - 1) + 1):
            low, high = [slice(None)] * 2, [slice(None)] * 2
            low[axis], high[axis] = slice(None, -step), slice(step, None)
            out[tuple(low)] |= texels[tuple(high)]
            out[tuple(high)] |= texels[tuple(low)]
        texels = out
    return texels


def find_blends(answers, visibility, key, selection):
    """(the selection with the width of each blend and where it ends, which places it leaves partly lit). Where two layers differ the
    picture says how much of it is the next one's, which of a blend grows evenly along the key."""
    limits, blends, mixed = list(selection.limits), [0.0] * len(selection.limits), np.zeros(len(visibility), bool)
    for k in range(min(len(limits), len(answers) - 1)):
        here, after = answers[k], answers[k + 1]
        differ = here.inside & after.inside & (np.abs(after.light - here.light) > CLEARLY)
        differ &= (key > (limits[k - 1] if k else 0)) & (key < (selection.limits[k + 1] if k + 1 < len(limits) else np.inf))
        share = np.where(differ, (visibility - here.light) / np.where(differ, after.light - here.light, 1), 0)
        partly = differ & (share > BLENDED) & (share < 1 - BLENDED)
        if partly.sum() < FEW or np.ptp(key[partly]) == 0:
            continue
        rise, at_zero = np.polyfit(key[partly], share[partly], 1)
        if rise <= 0 or np.corrcoef(key[partly], share[partly])[0, 1] ** 2 < 0.8:
            continue  # the edges of a filter, whose shares follow no distance
        limits[k], blends[k] = float((1 - at_zero) / rise), float(1 / rise)
        mixed |= differ & (key > limits[k] - blends[k]) & (key < limits[k])
    return (replace(selection, limits=tuple(limits), blends=tuple(blends)), mixed) if any(blends) else (selection, mixed)


@dataclass(frozen=True)
class Exponent:
    """visibility = exp(factor * (stored - depth)): an exponential shadow map."""

    factor: float  # for stored numbers of 0 to 1
    correlation: float  # of the visibility's logarithm and the margins, squared


def exponent(margins_read, visibility):
    """The exponential map's factor from the margins against the map as it was read (blurred) of places that are partly lit; None
    where these do not follow an exponential."""
    partly = (visibility > 0.05) & (visibility < 0.95)
    if partly.sum() < 50:
        return None
    x, y = margins_read[partly], np.log(visibility[partly])
    correlation = float(np.corrcoef(x, y)[0, 1] ** 2) if np.ptp(x) > 0 else 0.0
    return Exponent(float((x @ y) / (x @ x)), correlation) if correlation > 0.8 else None


def filter_radius(layer, positions, bias=None, widest=8):
    """How far from its own texel a partly lit place must read to find both answers: texels, the 99th hundredth of the places;
    None where most find none within `widest`. `bias` of each place, in place of the layer's constant."""
    column, row, depth, inside = texel_places(layer, positions)
    rows, columns = layer.texels.shape
    inside &= (column > widest) & (row > widest) & (column < columns - widest - 1) & (row < rows - widest - 1)
    column, row, depth = column[inside].astype(int)[:20000], row[inside].astype(int)[:20000], depth[inside][:20000]
    bias = layer.constant if bias is None else bias[inside][:20000]
    if not len(column):
        return None
    def lit(rows_, columns_):
        stored = layer.texels[rows_, columns_]
        return (depth - stored if layer.state.reversed else stored - depth) + bias >= 0

    own = lit(row, column)
    needed = np.full(len(column), widest + 1)
    for far in range(widest, 0, -1):
        for step in range(-far, far + 1):
            for dx, dy in ((step, -far), (step, far), (-far, step), (far, step)):
                needed[lit(row + dy, column + dx) != own] = far
    needed = np.sort(needed)
    radius = int(needed[int(0.99 * (len(needed) - 1))])
    return radius if radius <= widest else (int(np.median(needed)) if np.median(needed) <= widest else None)
