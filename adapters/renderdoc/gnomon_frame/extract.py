"""From a frame to what is known of it: maps, camera, lights, readers' matrices, visibility. Each finding has its residual."""
from dataclasses import dataclass, field, replace

import numpy as np

from . import fit, lookup, visibility
from .pairing import pair
from .passes import MapPasses
from .reader import CasterShift, ReaderMatrix, caster_shift, find_reader, texture_places, through_model
from .errors import FrameError

PROJECTED = 1e-3  # a light's matrix that is off by more is no projection


@dataclass
class Layer:
    """A part of a map that one projection draws: a whole texture, a viewport of an atlas, a slice of an array or cube."""

    state: object  # the pipeline at its first draw
    events: list
    meshes: list
    light: fit.LightFit | None = None
    distance: fit.DistanceFit | None = None  # in place of a projection
    half: fit.HalfFit | None = None  # of a dual paraboloid, whose texels hold those distances
    place: fit.LightPlace | None = None
    pairs: list = field(default_factory=list)  # (place among the camera's meshes, caster); None of casters that it does not draw
    reader: ReaderMatrix | None = None
    shift: CasterShift | None = None
    texels: np.ndarray | None = None  # of its own rectangle, as the casters left them
    read: np.ndarray | None = None  # the same as the readers found them: blurred, by some
    matrix: np.ndarray | None = None  # clip_from_view whose z/w is what a texel stores; of a half the light's view alone
    constant: float = 0.0  # the reader's own bias, stored numbers

    @property
    def matched(self):
        """How many casters the camera draws as well."""
        return sum(place is not None for place, _ in self.pairs)

    @property
    def stored_row(self):
        return self.state.conventions.window_row(self.light.matrix[2], self.light.matrix[3])

    @property
    def has_caster_bias(self):
        """Whether the casters were moved, by more than 32-bit positions are off."""
        size = np.linalg.norm(self.place.apex) if self.place.apex is not None else 1 / np.linalg.norm(self.stored_row[:3])
        return self.shift is not None and abs(self.shift.world) > 5e-6 * (1 + size)

    @property
    def texel(self):
        """Width of a texel of a sun's layer, world units."""
        return 2 / (np.linalg.norm(self.light.matrix[0, :3]) * self.state.viewport[2])


@dataclass
class View:
    """The camera, and what it draws."""

    lens: fit.Lens
    meshes: list  # each once, though a depth prepass draws it, too; without `clip`, of which `positions` tell
    positions: list  # of their vertices, in view space
    state: object


@dataclass
class Found:
    """One shadow map, its camera, and the lights whose layers it holds."""

    passes: MapPasses
    view: View
    lights: list  # of lists of layers
    sampler: str
    notes: list = field(default_factory=list)


def _is_mesh(mesh):
    """Not a full-screen draw, nor a sky at the far plane."""
    w = mesh.clip[:, 3]
    return np.ptp(w) > 1e-6 * np.abs(w).max() and not np.all(mesh.clip[:, 2] >= w * (1 - 1e-7))


def _view(frame, found):
    seen = {draw.event for draw in found.prepass}  # going to a draw costs a replay of the frame up to it
    once, last = {}, None
    for draw in found.camera:
        for mesh in _visited(frame, draw) if draw.event not in seen else ():
            if _is_mesh(mesh):
                once.setdefault((mesh.source, np.round(mesh.clip[:8], 4).tobytes()), mesh)
                last = draw
    if not once:
        raise FrameError("the camera draws no triangles in this frame")
    meshes = list(once.values())
    state = frame.state(meshes[0].event)
    matrices = [m for _, m in frame.constants(last.event)[0]]
    lens = fit.fit_lens([(m.objects, m.clip) for m in meshes], matrices)
    places = [lens.view_of(mesh.clip, state.conventions.y_up) for mesh in meshes]
    return View(lens, [replace(mesh, clip=mesh.clip[:0]) for mesh in meshes], places, state)


def _visited(frame, draw):
    frame.state(draw.event)
    return frame.meshes(draw)


def _layers(frame, found, view):
    grouped = {}
    for draw in found.writers:
        state = frame.state(draw.event)
        layer = grouped.setdefault((state.slice, state.viewport), Layer(state, [], []))
        layer.events.append(draw.event)
        layer.meshes += frame.meshes(draw)
    cameras = [(mesh.source, place) for mesh, place in zip(view.meshes, view.positions)]
    layers = [layer for layer in grouped.values() if _fit_layer(layer, view, cameras)]
    whole = next((layer for layer in layers if layer.light.rank == 4), None)
    for layer in layers:
        if layer.light.rank < 4 and whole:
            views, clips = _points(layer, view)
            layer.light = fit.complete_flat(layer.light, views, clips, whole.light.matrix)
        if not layer.distance and layer.light.residuals.max() > PROJECTED:
            raise FrameError("the casters' positions in the map are neither a projection nor distances from a point: no light can be told")
        layer.place = (fit.LightPlace(np.array([0.0, 0.0, -1.0]), layer.distance.apex) if layer.distance
                       else fit.light_place(layer.light.matrix, layer.state.reversed))
    return layers


def _points(layer, view):
    """(positions in view space, clip positions) of the casters that the camera draws as well."""
    pairs = [(view.positions[place], caster.clip) for place, caster in layer.pairs if place is not None]
    return np.concatenate([p for p, _ in pairs]), np.concatenate([c for _, c in pairs])


def _fit_layer(layer, view, cameras):
    places = pair([(caster.source, caster.clip) for caster in layer.meshes], cameras)
    layer.pairs = list(zip(places, layer.meshes))
    if not layer.matched or len(_points(layer, view)[0]) < 4:
        return False
    views, clips = _points(layer, view)
    layer.light = fit.fit_light(views, clips)
    if layer.light.rank == 4 and layer.light.residuals.max() > PROJECTED:
        layer.distance = fit.fit_distance(views, layer.state.conventions.window_row(clips[:, 2], clips[:, 3]) / clips[:, 3])
        layer.half = fit.fit_half(views, layer.distance.apex, clips) if layer.distance else None
    return True


def _by_light(layers):
    """Layers of one light together, finest first."""
    lights = []
    for layer in layers:
        same = next((light for light in lights if light[0].place.is_same(layer.place)), None)
        if same is None:
            lights.append([layer])
        else:
            same.append(layer)
    for light in lights:
        if light[0].place.apex is None:
            light.sort(key=lambda layer: layer.texel)
    return lights


def look_at(frame, map_passes):
    """What is known of one map before anything is replaced."""
    view = _view(frame, map_passes)
    layers = _layers(frame, map_passes, view)
    if not layers:
        raise FrameError("no mesh is drawn both by the camera and into the shadow map, so that the light cannot be told")
    last = map_passes.readers[-1].event
    return Found(map_passes, view, _by_light(layers), frame.reads(last).get(map_passes.texture, ""))


def read_layers(frame, found, layers):
    """The reader's matrix of each layer, and what moved the casters."""
    matrices, numbers = frame.constants(found.passes.readers[-1].event)
    ways = _ways_through_meshes(frame, found)
    texture = frame.textures[found.passes.texture]
    if all(layer.half for layer in layers):  # one light's, told best by the half with most casters
        best = min((layer.distance for layer in layers), key=lambda one: one.residual)
        for layer in layers:
            layer.distance = best
    for layer in layers:
        if layer.distance:
            layer.shift = CasterShift(layer.distance.moved, layer.distance.moved / layer.distance.range, layer.distance.residual)
            if not _cannot_be_said(found, layers):
                layer.matrix = np.eye(4)
                layer.matrix[:3, :3], layer.matrix[:3, 3] = layer.half.turn, -layer.half.turn @ layer.distance.apex
            continue
        if _cannot_be_said(found, layers):
            continue
        x, y, width, height = layer.state.viewport
        places = texture_places(x, width, texture.width), texture_places(y, height, texture.height)
        layer.reader = find_reader(matrices, layer.light.matrix, layer.stored_row, ways, places)
        layer.matrix = np.array([*layer.light.matrix[:2], layer.stored_row, layer.light.matrix[3]])
        if layer.reader:
            layer.matrix = layer.reader.matrix
            layer.place = fit.light_place(layer.matrix, layer.state.reversed)
            if layer.reader.has_depth:
                layer.shift = caster_shift(layer.light.matrix, layer.stored_row, layer.reader, layer.state.reversed)
    return [value for _, value in numbers]


def _cannot_be_said(found, layers):
    """Whether no capture can say how the map is looked up: a copy of another layout, distances that are no paraboloid's, or a cube of
    which faces were not drawn."""
    if found.passes.is_copied:
        return True
    if any(layer.distance for layer in layers):
        return len(layers) > 2 or not all(layer.half for layer in layers)
    return layers[0].place.apex is not None and len(layers) not in (1, 6)


def _ways_through_meshes(frame, found):
    """Ways from view space to the engine's world by the last solid mesh that a reader draws: not every engine hands its shaders a view
    matrix, but nearly all a model's."""
    of_readers = {draw.event for draw in found.passes.readers}
    for mesh, place in reversed(list(zip(found.view.meshes, found.view.positions))):
        if mesh.event in of_readers and mesh.objects is not None:
            ways = through_model(frame.constants(mesh.event)[0], mesh.objects, place)
            if ways:
                return ways
    return []


def polygon_offset(layer, texture):
    """The rasterizer's depth bias as a capture has it, away from the light: {constant, slope, clamp}, stored numbers; {} where there
    is none, or where the map is a colour, which it does not move. A float's step is that of the largest depths."""
    bias = layer.state.depth_bias
    if not texture.is_depth or not (bias["constant"] or bias["slope"]):
        return {}
    away = -1.0 if layer.state.reversed else 1.0
    step = 2.0**-16 if texture.format.startswith("D16") else 2.0**-24
    return {"constant": away * bias["constant"] * step, "slope": away * bias["slope"], "clamp": away * bias["clamp"]}


def _cut(layer, picture):
    x, y, width, height = (int(round(v)) for v in layer.state.viewport)
    return picture[y:y + height, x:x + width, 0]


@dataclass
class Pixels:
    """The camera's picture of one light, its first row at the top."""

    positions: np.ndarray  # view space
    drawn: np.ndarray  # whether anything was
    visibility: np.ndarray
    asked: np.ndarray


def positions_of(depth, view):
    """(positions, whether anything was drawn) of the camera's depth buffer, whose own first row comes first."""
    lens, clip = view.lens, view.state.conventions
    depth = depth[::-1] if clip.bottom_row_first == clip.y_up else depth
    drawn = depth != (0.0 if view.state.reversed else 1.0)
    quotient = 2 * depth - 1 if clip.minus_one else depth
    w = np.where(drawn, lens.zb / np.where(drawn, quotient - lens.za, 1), 0)
    height, width = depth.shape
    x, y = np.meshgrid((np.arange(width) + 0.5) / width * 2 - 1, 1 - (np.arange(height) + 0.5) / height * 2)
    up = 1.0 if clip.y_up else -1.0
    return np.stack([(x - lens.cx) * w / lens.fx, (y - up * lens.cy) * w / lens.fy, -w], -1), drawn


def _flip(picture, view):
    clip = view.state.conventions
    return picture[::-1] if clip.bottom_row_first == clip.y_up else picture


def measure(frame, found, layers, encoding, others):
    """(pixels of one light, the exponential map's factor or None): three replays. `others`: layers of other lights. `encoding`: "srgb", "linear", or "auto", which takes
    8-bit pictures for sRGB unless an exponential map fits better without."""
    if frame.textures[found.passes.picture].samples > 1:
        raise FrameError("the picture has several samples a pixel: record a frame without MSAA")
    drawn = visibility.take_pictures(frame, found.passes, sorted({layer.state.slice for layer in layers}))
    for layer in layers:
        layer.texels, layer.read = (_cut(layer, maps[layer.state.slice]) for maps in (drawn.maps, drawn.read))
    empty, full = visibility.replay(frame, found.passes, layers, found.view.lens, drawn, others)
    positions, is_drawn = positions_of(drawn.depth, found.view)
    unsaid = visibility.does_not_say(frame, found.passes)
    tried = []
    for encoded in ([False] if not unsaid or encoding == "linear" else [True] if encoding == "srgb" else [True, False]):
        seen = visibility.work_out(drawn, empty, full, encoded)
        pixels = Pixels(positions, is_drawn, _flip(seen.values, found.view).copy(), _flip(seen.asked, found.view) & is_drawn)
        tried.append((seen, pixels, _exponent(layers, pixels)))
    seen, pixels, exponent = max(tried, key=lambda one: one[2].correlation if one[2] else 0)
    covered = [_cut(layer, seen.full_map[layer.state.slice]) == (1.0 if layer.state.reversed else 0.0) for layer in layers]
    if _is_bilinear(found):
        _light_between_casters(pixels, layers, covered)
    if layers[0].place.apex is None:
        _light_beside_casters(pixels, layers, covered)
    if not seen.untouched:
        found.notes.append("the stand-ins for the casters changed the camera's depth, too: they share a shader, and some pixels may be wrong")
    if seen.darkest > 0.01:
        found.notes.append(f"full shadow leaves {100 * seen.darkest:.0f} % of the lit picture: ambient light, other lights, a fade with the "
                           f"distance, or a strength of {1 - seen.darkest:.2f}; it is taken out")
    return pixels, exponent


def is_same_picture(found, pixels, other, others):
    """Whether two lights are seen by one camera in one picture."""
    return (pixels.drawn.shape == others.drawn.shape and np.array_equal(pixels.drawn, others.drawn)
            and np.allclose(pixels.positions, others.positions, rtol=1e-4, atol=1e-6)
            and np.isclose(found.view.lens.fx, other.view.lens.fx) and np.isclose(found.view.lens.fy, other.view.lens.fy))


def _exponent(layers, pixels):
    if len(layers) > 1 or layers[0].matrix is None or np.array_equal(layers[0].texels, layers[0].read):
        return None
    blurred = replace(layers[0], texels=layers[0].read)
    return lookup.exponent(lookup.margins(blurred, pixels.positions[pixels.asked]).values, pixels.visibility[pixels.asked])


def _is_bilinear(found):
    """Whether the map's sampler weighs four comparisons."""
    return "compare" in found.sampler and "linear" in found.sampler


def _light_between_casters(pixels, layers, covered):
    """Puts back the light of texels that no caster covers: full maps leave them lit, so that the replays tell of the covered ones of the
    four that a sampler weighs alone. Which of several layers is read is not known yet: the one that is covered most counts."""
    if any(layer.matrix is None for layer in layers):
        return
    asked, places = pixels.asked, pixels.positions[pixels.asked]
    share, held = np.zeros(len(places)), np.zeros(len(places), bool)
    for layer, full in zip(layers, covered):
        at, inside = lookup.bilinear(layer, places, full.astype(float))
        share, held = np.maximum(share, np.where(inside, at, 0)), held | inside
    pixels.visibility[asked] = 1 - np.where(held, share, 1) * (1 - pixels.visibility[asked])


def _light_beside_casters(pixels, layers, covered):
    """A sun's pixels whose texel no caster covers, or that lie outside of all layers: the stand-ins do not reach them; they are lit."""
    unknown = pixels.drawn & ~pixels.asked
    places = pixels.positions[unknown]
    dark = np.zeros(len(places), bool)
    for layer, full in zip(layers, covered):
        column, row, _, inside = lookup.texel_places(layer, places)
        dark |= inside & full[np.clip(row, 0, full.shape[0] - 1).astype(int), np.clip(column, 0, full.shape[1] - 1).astype(int)]
    lit = unknown.copy()
    lit[unknown] = ~dark
    pixels.visibility[lit] = 1
    pixels.asked |= lit


@dataclass
class Test:
    """How the frame's own test decides, as far as the picture tells."""

    selection: lookup.Selection
    agreement: float | None  # None where the map is no projection, or an exponential one; share of sure pixels that the test as described decides as the picture has them
    without_constant: float  # the same before the reader's own bias was looked for
    partly_lit: float  # share of pixels between lit and shadowed
    radius: float | None  # of the filter, texels; None where there is none
    exponent: lookup.Exponent | None  # of an exponential map


def _is_looked_up_in(selection, k, distance):
    """Whether a place of this distance from the camera is looked up in layer k alone; of layers without distances all are in the first."""
    if selection.by == "first":
        return k == 0
    limits, blends = (0.0, *selection.limits), selection.blends or (0.0,) * len(selection.limits)
    return (distance > limits[k]) & (distance < limits[k + 1] - blends[k])


def find_test(found, layers, pixels, numbers, exponent):
    """The choice of cascades, the reader's own bias and the filter's reach, found from the picture."""
    if layers[0].matrix is None:
        return Test(lookup.Selection("first", (), 0.0), None, 0.0, 0.0, None, None)
    value = pixels.visibility[pixels.asked]
    places = pixels.positions[pixels.asked]
    sure = (value < lookup.SURE) | (value > 1 - lookup.SURE)
    lit = value[sure] > 0.5
    at = places[sure]
    margins = [lookup.margins(layer, at) for layer in layers]
    keys = {"view_z": -at[:, 2], "distance": np.linalg.norm(at, axis=1)} if layers[0].place.apex is None else {}
    selection, chosen = lookup.choose_layers(margins, lit, keys, numbers)
    before = selection.share
    right = np.array(chosen < 0) & lit
    if layers[0].half:  # one test for both halves
        all_values = np.choose(np.maximum(chosen, 0), [m.values for m in margins])
        constant, _, _ = lookup.best_constant(all_values[chosen >= 0], lit[chosen >= 0], numbers)
    for k, layer in enumerate(layers):
        mine = chosen == k
        if layers[0].half:
            layer.constant = constant
        elif exponent is None:  # whose soft shadows have no threshold
            layer.constant, _, _ = lookup.best_constant(margins[k].values[mine], lit[mine], numbers)
        right[mine] = (margins[k].values[mine] + layer.constant >= 0) == lit[mine]
    blended, distance = np.zeros(len(value), bool), None
    bilinear = _is_bilinear(found)
    if selection.by != "first":
        answers = [lookup.answer(layer, places, bilinear) for layer in layers]
        distance = {"view_z": -places[:, 2], "distance": np.linalg.norm(places, axis=1)}[selection.by]
        selection, blended = lookup.find_blends(answers, value, distance, selection)
    unsure = ~sure & ~blended
    partly = float(unsure.mean()) if len(sure) else 0.0
    # Where layers blend their own soft edges are partly lit by that as well: the sampler says that it reads four texels.
    radius = 1.0 if bilinear and blended.any() else None
    if partly > 2e-3:
        reaches = (lookup.filter_radius(layer, places[unsure & _is_looked_up_in(selection, k, distance)]) for k, layer in enumerate(layers))
        reach = next((reach for reach in reaches if reach is not None), None)
        radius = radius if reach is None else float(reach) if bilinear else reach + 0.5
    agreement = None if exponent else float(right.mean()) if len(right) else 1.0
    return Test(selection, agreement, 1 - before, partly, radius, exponent)
