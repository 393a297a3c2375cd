"""The camera's picture of one light: where its pixels are, and how much of the light reaches each."""
from dataclasses import dataclass, replace

import numpy as np

from . import lookup, moments, visibility
from .errors import FrameError


MOST_SLICES = 16  # of a map that are looked at
RANGES = 1e-3  # of a range: layers whose ends differ by less have one
FEWEST = 2e-3  # share of the drawn pixels
MOST = 0.5  # share of the pixels within the map: where so many are not told nothing is


@dataclass
class Pixels:
    """The camera's picture of one light, its first row at the top."""

    positions: np.ndarray  # view space
    drawn: np.ndarray  # whether anything was
    visibility: np.ndarray
    asked: np.ndarray
    told: np.ndarray | None = None  # whether the map decides the light there: replays with it empty and full differ
    depth: np.ndarray | None = None  # the camera's
    is_read_otherwise: bool = False  # whether both were exchanged, because that fits a filter better
    otherwise: np.ndarray | None = None  # the visibility where the picture is encoded otherwise than is taken; None where it says how
    hidden: np.ndarray | None = None  # pixels that show meshes that are not in the scene


def positions_of(depth, view, distances=None):
    """(positions, whether anything was drawn) of the camera's depth buffer, whose own first row comes first; of `distances` where depths do not
    tell them."""
    lens, clip = view.lens, view.state.conventions
    depth = flip(depth, view)
    drawn = depth != (0.0 if view.state.reversed else 1.0)
    if distances is None:
        quotient = 2 * depth - 1 if clip.minus_one else depth
        distance = np.where(drawn, lens.distance(np.where(drawn, quotient, 0)), 0)
    else:
        distances = flip(distances, view)
        drawn = drawn & np.isfinite(distances)
        distance = np.where(drawn, distances, 0)
    height, width = depth.shape
    x, y = np.meshgrid((np.arange(width) + 0.5) / width * 2 - 1, 1 - (np.arange(height) + 0.5) / height * 2)
    return np.where(drawn[..., None], lens.place(x, y if clip.y_up else -y, distance, clip.y_up), 0), drawn


def _cut(layer, picture):
    return _cut_all(layer, picture)[..., 0]


def _cut_all(layer, picture):
    """The same with all channels."""
    x, y, width, height = (int(round(v)) for v in layer.state.viewport)
    return picture[y:y + height, x:x + width]


def flip(picture, view):
    clip = view.state.conventions
    return picture[::-1] if clip.bottom_row_first == clip.y_up else picture


def measure(frame, found, layers, encoding, others, numbers):
    """(pixels of one light, the exponential map's factor or None, a map of moments' Fit or None): three replays. `numbers`: the reader's. `others`: layers of other lights. `encoding`: "srgb",
    "linear", or "auto", which takes 8-bit pictures for sRGB unless the reader has none of that curve's numbers, or an exponential map or a
    filter fits better without."""
    drawn = visibility.take_pictures(frame, found.passes, sorted({layer.state.slice for layer in layers}))
    for layer in layers:
        layer.texels, layer.read = (_cut(layer, maps[layer.state.slice]) for maps in (drawn.maps, drawn.read))
    if not layers[0].is_colour:
        drawn.depths = visibility.rasterized_depths(frame, found.passes, layers)
    for layer in layers:
        layer.content = _content(frame, found, layer, drawn) if layer.matrix is not None else None
    _share_ranges(layers, numbers.all)
    empty, full = visibility.replay(frame, found.passes, layers, found.view.lens, drawn, others)
    positions, is_drawn = positions_of(drawn.depth, found.view, visibility.distances(frame, found))
    for layer in layers:
        if layer.content and layer.content.kind != "depths":
            layer.averages = {name: moments.moments_of(layer.content, _cut_all(layer, one.read[layer.state.slice]))
                              for name, one in (("drawn", drawn), ("empty", empty), ("full", full))}
    unsaid = visibility.does_not_say(frame, found.passes)
    tried = []
    for encoded in ([False] if not unsaid or encoding == "linear" else [True] if encoding == "srgb" else
                    [False, True] if numbers.encodes is False else [True, False]):
        seen = visibility.work_out(drawn, empty, full, encoded)
        pixels = Pixels(positions, is_drawn, flip(seen.values, found.view).copy(), flip(seen.asked, found.view) & is_drawn, flip(seen.asked, found.view),
                        drawn.depth)
        tried.append((seen, pixels, _exponent(layers, pixels), _moments(layers, pixels, numbers.all)))
    seen, pixels, exponent, fitted = max(tried, key=lambda one: (-one[3].off if one[3] else -1, one[2].correlation if one[2] else 0))
    if len(tried) > 1 and numbers.encodes is False:
        found.notes.append("the picture's numbers are linear ones: the shader that writes them has none of sRGB's")
    if len(tried) > 1:
        pixels.otherwise = next(one[1].visibility for one in tried if one[1] is not pixels)
    for layer in layers:
        layer.covered = _cut(layer, seen.full_map[layer.state.slice]) == (1.0 if layer.state.reversed else 0.0)
        layer.old = _of_earlier_frames(_cut(layer, empty.maps[layer.state.slice]), frame.textures[found.passes.texture].is_depth, layer.state.reversed)
        layer.old &= ~layer.covered
    if found.is_bilinear:
        _light_between_casters(pixels, layers)
    if _has_parts_of_earlier_frames(frame, found, [*layers, *others], empty):
        found.notes.append("parts of the map are of earlier frames, as of cascades that are redrawn in turn: compared are the pixels whose light the "
                           "parts of this frame decide")
    elif layers[0].place.apex is None:
        _light_beside_casters(pixels, layers)
    if any(layer.old.any() for layer in layers):
        _leave_out_earlier_frames(found, layers, pixels)
    if not seen.untouched:
        found.notes.append("the stand-ins for the casters changed the camera's depth, too: they share a shader, and some pixels may be wrong")
    if drawn.mixed is not None:
        pixels.asked &= ~flip(drawn.mixed | empty.mixed | full.mixed, found.view)
        found.notes.append(f"several samples a pixel: {int((drawn.mixed & flip(is_drawn, found.view)).sum())} pixels whose samples show more than one thing "
                           "are not compared")
    if seen.darkest > 0.01:
        found.notes.append(f"full shadow leaves {100 * seen.darkest:.0f} % of the lit picture: ambient light, other lights, a fade with the "
                           f"distance, or a strength of {1 - seen.darkest:.2f}; it is taken out")
    if fitted:
        _light_of_moments(layers, pixels, fitted)
    refuse_few(pixels)
    return pixels, exponent, fitted


def refuse_few(pixels):
    """A FrameError where the replays tell the light of next to no pixel."""
    told, drawn = int(pixels.asked.sum()), int(pixels.drawn.sum())
    if told < FEWEST * drawn:
        raise FrameError(f"the map, empty and full, tells the light of {told} of {drawn} pixels alone: what reads it does more than compare depths, such "
                         "as contact hardening (PCSS), or this light reaches nothing that is seen. Record a frame with another filter")


def is_same_picture(found, pixels, other, others):
    """Whether two lights are seen by one camera in one picture."""
    return (pixels.drawn.shape == others.drawn.shape and np.array_equal(pixels.drawn, others.drawn)
            and np.allclose(pixels.positions, others.positions, rtol=1e-4, atol=1e-6)
            and np.isclose(found.view.lens.fx, other.view.lens.fx) and np.isclose(found.view.lens.fy, other.view.lens.fy))


def _of_earlier_frames(empty, is_depth, is_reversed):
    """Which texels of a map that no caster of this frame was drawn into are not at the clear value."""
    if np.ptp(empty) == 0:
        return np.zeros(empty.shape, bool)
    values, counts = np.unique(empty, return_counts=True)
    return empty != ((0.0 if is_reversed else 1.0) if is_depth else values[counts.argmax()])


def _has_parts_of_earlier_frames(frame, found, all_layers, empty):
    """Whether a depth map holds casters beside the parts that this frame draws: in the same slice, or in one that it leaves alone."""
    texture = frame.textures[found.passes.texture]
    if not texture.is_depth:
        return False
    kept = {s: empty.maps[s][..., 0].copy() if s in empty.maps else frame.picture(texture.id, s)[..., 0] for s in range(min(texture.slices, MOST_SLICES))}
    for layer in all_layers:
        if layer.state.slice in kept and layer.state.depth == texture.id:
            x, y, width, height = (int(round(v)) for v in layer.state.viewport)
            kept[layer.state.slice][y:y + height, x:x + width] = 1.0
    clear = 0.0 if all_layers[0].state.reversed else 1.0
    return any(np.ptp(left) > 0 and ((left != clear) & (left != 1.0)).any() for left in kept.values())


def _leave_out_earlier_frames(found, layers, pixels):
    """Takes pixels out whose texel holds casters of an earlier frame: the replays tell the light of this frame's alone."""
    places = pixels.positions[pixels.drawn]
    kept, inside = np.zeros(len(places), bool), np.zeros(len(places), bool)
    for layer in layers:
        if layer.matrix is not None:
            at, held = lookup.nearest(layer, places, lookup.widened(layer.old, 1) if found.is_bilinear else layer.old)
            kept, inside = kept | held & at, inside | held
    lost = np.zeros(pixels.drawn.shape, bool)
    lost[pixels.drawn] = kept
    if not found.is_bilinear:
        lost &= ~pixels.told
    share = max(layer.old.mean() for layer in layers)
    why = f"{100 * share:.0f} % of the map's texels are of an earlier frame: the engine keeps what stands still"
    if not inside.any() or lost.sum() > MOST * inside.sum():
        raise FrameError(why + ", and no replay tells the light there. Record a frame in which the light moves, or without that cache")
    pixels.asked &= ~lost
    found.notes.append(f"{why}; {int(lost.sum())} pixels that look them up are not compared")


def _content(frame, found, layer, drawn):
    """What a colour map's texels hold, told by the depths that were drawn beside them."""
    depths = drawn.depths.get(layer.state.slice)
    texels = drawn.maps[layer.state.slice]
    if depths is None or depths.shape != texels.shape[:2]:
        return None
    x, texels = _cut(layer, depths[..., None]), _cut_all(layer, texels)
    held = (x > 0) & (x < 1)
    bits = frame.textures[found.passes.texture].format.lstrip("R")[:2]
    found = moments.find_content(texels[held], _bases(layer, x, held), bits)
    if found is None and layer.is_blurred and layer.is_colour:
        return moments.find_blurred_content(_cut_all(layer, drawn.read[layer.state.slice]), x)
    return found


def _share_ranges(layers, numbers):
    """Layers of one light store distances in one range, told by the one that holds most, and which mostly ends at a number of the reader."""
    told = [layer for layer in layers if layer.content is not None]
    if not told or any(layer.content.base == "depth" or layer.content.base != told[0].content.base or layer.content.kind != told[0].content.kind for layer in told):
        return
    best = max(told, key=lambda layer: len(np.unique(layer.texels))).content
    near, far = best.range
    snapped = tuple(float(min((n for n in (0.0, *numbers) if abs(n - end) < RANGES * (far - near)), key=lambda n: abs(n - end), default=end)) for end in (near, far))
    for layer in layers:
        layer.content = replace(best, range=snapped)


def _bases(layer, depths, held):
    """{what a texel's number may rise with: its value} of the texels that are held."""
    out = {"depth": depths[held]}
    if layer.place.apex is None:
        return out
    rows, columns = np.nonzero(held)
    x, y = (columns + 0.5) / held.shape[1] * 2 - 1, (rows + 0.5) / held.shape[0] * 2 - 1
    back = np.linalg.inv(np.array([*layer.light.matrix[:2], layer.stored_row, layer.light.matrix[3]]))
    places = np.c_[x, y if layer.state.conventions.bottom_row_first else -y, depths[held], np.ones(len(x))] @ back.T
    off = places[:, :3] / places[:, 3:] - layer.place.apex
    return {**out, "distance": np.linalg.norm(off, axis=1), "axis": off @ layer.place.direction}


def _moments(layers, pixels, numbers):
    """The Fit of a map of moments, of the first layer that holds each place; None of other maps."""
    if not all(layer.averages for layer in layers):
        return None
    places, left = pixels.positions[pixels.asked], np.ones(int(pixels.asked.sum()), bool)
    parts = []
    for layer in layers:
        _, _, x, inside = lookup.texel_places(layer, places)
        mine = np.flatnonzero(inside & left)[::max(1, len(places) // 40000)]
        left &= ~inside
        parts.append([*(lookup.averages(layer, places[mine], which)[0] for which in ("drawn", "empty", "full")), x[mine],
                      pixels.visibility[pixels.asked][mine]])
    return moments.fit(layers[0].content, *(np.concatenate(one) for one in zip(*parts)), numbers)


def _light_of_moments(layers, pixels, fitted):
    """Puts back what the replays leave: an empty map that is not all lit, a full one that is not all dark."""
    places, values = pixels.positions[pixels.asked], pixels.visibility[pixels.asked]
    left, told = np.ones(len(places), bool), np.ones(len(places), bool)
    for layer in layers:
        _, _, x, inside = lookup.texel_places(layer, places)
        mine = inside & left
        left &= ~inside
        lit, dark = (fitted.light(lookup.averages(layer, places[mine], which)[0], x[mine]) for which in ("empty", "full"))
        values[mine] = values[mine] * (lit - dark) + dark
        told[mine] = lit - dark > visibility.DIM
    pixels.visibility[pixels.asked] = values
    pixels.asked[pixels.asked] = told


def _exponent(layers, pixels):
    if len(layers) > 1 or layers[0].matrix is None or layers[0].averages or np.array_equal(layers[0].texels, layers[0].read):
        return None
    blurred = replace(layers[0], texels=layers[0].read)
    return lookup.exponent(lookup.margins(blurred, pixels.positions[pixels.asked]).values, pixels.visibility[pixels.asked])


def _readings(pixels):
    return [pixels.visibility] if pixels.otherwise is None else [pixels.visibility, pixels.otherwise]


def _light_between_casters(pixels, layers):
    """Puts back the light of texels that no caster covers: full maps leave them lit, so that the replays tell of the covered ones of the
    four that a sampler weighs alone. Which of several layers is read is not known yet: the one that is covered most counts."""
    if any(layer.matrix is None for layer in layers):
        return
    asked, places = pixels.asked, pixels.positions[pixels.asked]
    share, held = np.zeros(len(places)), np.zeros(len(places), bool)
    for layer in layers:
        at, inside = lookup.bilinear(layer, places, layer.covered.astype(float))
        share, held = np.maximum(share, np.where(inside, at, 0)), held | inside
    for values in _readings(pixels):
        values[asked] = 1 - np.where(held, share, 1) * (1 - values[asked])


def _light_beside_casters(pixels, layers):
    """A sun's pixels whose texel no caster covers, or that lie outside of all layers: the stand-ins do not reach them; they are lit."""
    unknown = pixels.drawn & ~pixels.asked
    places = pixels.positions[unknown]
    dark = np.zeros(len(places), bool)
    for layer in layers:
        at, inside = lookup.nearest(layer, places, layer.covered | layer.old)
        dark |= inside & at
    lit = unknown.copy()
    lit[unknown] = ~dark
    for values in _readings(pixels):
        values[lit] = 1
    pixels.asked |= lit


def hide(pixels, hidden, view):
    """Takes pixels out, given with the texture's own first row first: they show what is not in the scene."""
    pixels.hidden = flip(hidden, view)
    pixels.asked &= ~pixels.hidden


def leave_out_borders(pixels, layers, radius):
    """Takes pixels out whose filter, of a radius of more than one texel, reads some that no caster covers, or casters of an earlier frame:
    full maps leave those as they are, so that the replays do not tell what they take of a shadow. Returns how many. Which of several layers is read is not asked: the one
    whose texels are covered counts."""
    if radius is None or radius <= 1 or any(layer.matrix is None for layer in layers):
        return 0
    places = pixels.positions[pixels.asked]
    beside, covered, earlier = (np.zeros(len(places), bool) for _ in range(3))
    for layer in layers:
        at, inside = lookup.nearest(layer, places, lookup.widened(~layer.covered, int(np.ceil(radius))))
        beside, covered = beside | inside & at, covered | inside & ~at
        if layer.old.any():
            at, inside = lookup.nearest(layer, places, lookup.widened(layer.old, int(np.ceil(radius))))
            earlier |= inside & at
    unsure = earlier | beside & ~covered & (pixels.visibility[pixels.asked] < 1 - lookup.SURE)
    pixels.asked[pixels.asked] = ~unsure
    return int(unsure.sum())
