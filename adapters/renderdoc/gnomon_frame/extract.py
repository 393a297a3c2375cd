"""What is known of a frame before anything is replaced: the camera, a map's layers, their lights and readers. Each finding has its
residual."""
from dataclasses import dataclass, field, replace

import numpy as np

from . import fit, literals, normals
from .casters import Roles
from .errors import FrameError
from .lens import Lens, covers_the_picture, fit_lens, is_parallel
from .moments import Content
from .pairing import pair
from .passes import MapPasses, refuse_searched
from .reader import CasterShift, ReaderMatrix, caster_shift, find_reader, texture_places, through_model

PROJECTED = 1e-3  # a light's matrix that is off by more is no projection
EXACT = 2e-5  # by more than 32-bit arithmetic is off


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
    normal_shift: normals.NormalShift | None = None
    texels: np.ndarray | None = None  # of its own rectangle, as the casters left them
    read: np.ndarray | None = None  # the same as the readers found them: blurred, by some
    covered: np.ndarray | None = None  # which of them some caster covers
    old: np.ndarray | None = None  # which of them hold casters of an earlier frame
    matrix: np.ndarray | None = None  # clip_from_view whose z/w is what a texel stores; of a half the light's view alone
    constant: float = 0.0  # the reader's own bias, stored numbers
    is_held: bool = False  # whether casters before the near plane are held at it
    is_colour: bool = False  # whether its texels are those of a colour texture
    content: Content | None = None  # what these hold, where that is known
    averages: dict = field(default_factory=dict)  # of a map of moments: what readers find with it drawn, empty and full

    @property
    def is_blurred(self):
        """Whether readers find other texels than the casters left."""
        return not np.array_equal(self.texels, self.read)

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

    lens: Lens
    meshes: list  # each once, though a depth prepass draws it, too; without `clip`, of which `positions` tell
    positions: list  # of their vertices, in view space
    state: object
    others: list = field(default_factory=list)  # meshes that are drawn with another projection, such as a weapon in the hand

    @property
    def rectangle(self):
        """The part of the picture that the camera draws: x, y, width, height."""
        return tuple(int(round(v)) for v in self.state.viewport)


@dataclass
class Found:
    """One shadow map, its camera, and the lights whose layers it holds."""

    passes: MapPasses
    view: View
    lights: list  # of lists of layers
    sampler: str
    notes: list = field(default_factory=list)
    roles: Roles = field(default_factory=Roles)

    @property
    def is_bilinear(self):
        """Whether the map's sampler weighs four comparisons."""
        return "compare" in self.sampler and "linear" in self.sampler


def _is_mesh(mesh):
    """Not a full-screen draw, nor a sky at the far plane."""
    return not covers_the_picture(mesh.clip) and not np.all(mesh.clip[:, 2] >= mesh.clip[:, 3] * (1 - 1e-7))


def _camera_meshes(frame, found):
    """(what the camera draws, each mesh once; the last event that draws one). Of a perspective camera without meshes at one distance,
    among which are those of a flat overlay."""
    seen = {draw.event for draw in found.prepass}
    once, last = {}, 0
    with frame.without_shading(found.readers):
        for draw in found.camera:
            for mesh in _visited(frame, draw) if draw.event not in seen else ():
                if _is_mesh(mesh):
                    once.setdefault((mesh.source, np.round(mesh.clip[:8], 4).tobytes()), mesh)
                    last = draw.event
    meshes = list(once.values())
    return [mesh for mesh in meshes if not is_parallel(mesh.clip)] or meshes, last


def _view(frame, found):
    meshes, last = _camera_meshes(frame, found)
    if not meshes:
        raise FrameError("the camera draws no triangles in this frame")
    state = frame.state(meshes[0].event)
    looked_at = dict.fromkeys((last, meshes[0].event, meshes[len(meshes) // 2].event))
    matrices = [m for event in looked_at for _, m in frame.constants(event)[0]]
    lens, kept = fit_lens([(m.objects, m.clip) for m in meshes], matrices, state)
    own = [mesh for mesh, one in zip(meshes, kept) if one]
    places = [lens.view_of(mesh.clip, state.conventions.y_up) for mesh in own]
    others = [mesh for mesh, one in zip(meshes, kept) if not one]
    return View(lens, [replace(mesh, clip=mesh.clip[:0]) for mesh in own], places, state, others)


def _visited(frame, draw):
    frame.state(draw.event)
    return frame.meshes(draw)


def grouped(frame, writers):
    """Layers by what each draw is drawn into: a slice, which a geometry shader may choose, and a viewport."""
    out = {}
    for draw in writers:
        state = frame.state(draw.event)
        for mesh in frame.meshes(draw):
            slice_ = state.slice if mesh.layer is None else mesh.layer
            layer = out.setdefault((slice_, state.viewport), Layer(replace(state, slice=slice_), [], []))
            layer.events += [] if draw.event in layer.events[-1:] else [draw.event]
            layer.meshes.append(mesh)
    return list(out.values())


def _layers(frame, found, view):
    cameras = [(mesh.source, place) for mesh, place in zip(view.meshes, view.positions)]
    layers = [layer for layer in grouped(frame, found.writers) if _fit_layer(layer, view, cameras)]
    whole = next((layer for layer in layers if layer.light.rank == 4), None)
    for layer in layers:
        if layer.light.rank < 4 and whole:
            views, clips = _points(layer, view)
            layer.light = fit.complete_flat(layer.light, views, clips, whole.light.matrix)
        if layer.light.rank < 4 and layer.light.residuals.max() <= PROJECTED:
            raise FrameError("what camera and light both draw lies in one plane, which does not tell the light: look at something solid that casts")
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
        _without_what_is_held(layer, views, clips)
    if layer.light.rank == 4 and layer.light.residuals.max() > EXACT:
        _along_normals(layer, view, views, clips)
    if layer.light.rank == 4 and layer.light.residuals.max() > PROJECTED:
        layer.distance = fit.fit_distance(views, layer.state.conventions.window_row(clips[:, 2], clips[:, 3]) / clips[:, 3])
        layer.half = fit.fit_half(views, layer.distance.apex, clips) if layer.distance else None
    return True


def _along_normals(layer, view, views, clips):
    """Casters may be moved along their normals: what is left of the projection tells."""
    of_casters = np.concatenate([normals.of_mesh(caster, view.positions[place]) for place, caster in layer.pairs if place is not None])
    found = normals.find(views, of_casters, clips, layer.light, layer.state.reversed)
    if found and found[0].residuals.max() <= PROJECTED:
        layer.light, layer.normal_shift = found


def _without_what_is_held(layer, views, clips):
    """Casters before the near plane may be held at it (Unity does): the others tell the projection then."""
    nearest = clips[:, 3] if layer.state.reversed else -clips[:, 3] if layer.state.conventions.minus_one else 0 * clips[:, 3]
    free = np.abs(clips[:, 2] - nearest) > 1e-6 * np.abs(clips[:, 3])
    if 4 <= free.sum() < len(free):
        told = fit.fit_light(views[free], clips[free])
        if told.rank == 4 and told.residuals.max() <= PROJECTED:
            layer.light, layer.is_held = told, True


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


def _beside(map_passes):
    """Textures that the casters are drawn into beside the map."""
    return {texture for draw in map_passes.writers for texture in (*draw.colours, draw.depth)} - {map_passes.texture, 0}


def look_at(frame, map_passes):
    """What is known of one map before anything is replaced."""
    view = _view(frame, map_passes)
    layers = _layers(frame, map_passes, view)
    if not layers:
        raise FrameError("no mesh is drawn both by the camera and into the shadow map, so that the light cannot be told")
    map_passes.rectangle = view.rectangle
    bindings = frame.bindings(map_passes.readers[-1].event)
    samplers = [sampler for texture, sampler in bindings if texture == map_passes.texture]
    refuse_searched(samplers, [sampler for texture, sampler in bindings if texture in _beside(map_passes)])
    return Found(map_passes, view, _by_light(layers), samplers[-1] if samplers else "")


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
        layer.is_colour = not texture.is_depth
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
    own = literals.of_code(frame.fragment_code(found.passes.readers[-1].event))
    given = literals.of_constants(numbers)
    return replace(own, given=given.given, vectors=given.vectors)


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
