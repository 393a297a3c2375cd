"""How much of a light reaches each pixel, from three replays: as it is, with its map empty, with its map full.

visibility = (drawn - full) / (empty - full). It is linear, so ambient light, other lights and a shadow's strength cancel.
"""
from dataclasses import dataclass, field

import numpy as np

from . import apart, formats
from .errors import FrameError
from .stand_ins import Source

DIM = 0.02  # of the light's brightest hundredth: pixels with less cannot say whether it arrives


@dataclass
class Visibility:
    values: np.ndarray  # 1 lit, 0 shadowed
    encoded: bool  # whether the picture's numbers were taken for sRGB-encoded ones
    asked: np.ndarray  # pixels in which the light can be told
    darkest: float  # what full shadow leaves of the lit picture: ambient light, or a strength below 1
    full_map: np.ndarray  # the map as the stand-ins filled it
    untouched: bool  # whether the camera's depth stayed as it was in both replays


def _plan(frame, passes, layers, lens, others):
    """{(shader, stage): (Source without `full`)} of every shader that draws a caster."""
    of_others = {event for layer in others for event in layer.events}
    own = {d.event for d in passes.writers}
    rects = tuple((x, y, x + w, y + h) for x, y, w, h in sorted({tuple(layer.state.viewport) for layer in layers}))
    used, plan = {}, {}
    unseen = {d.event for d in passes.prepass}  # taken for draws that share the casters' fragment shader
    for draw in frame.draws:
        if draw.event in own or draw.depth and draw.event not in unseen:
            for stage, shader in frame.state(draw.event).shaders.items():
                used.setdefault((shader, stage), set()).add(draw.event)
    minus_one = layers[0].state.conventions.minus_one
    writers = {event for layer in layers for event in layer.events}
    for event in sorted(writers):
        shaders = frame.state(event).shaders
        fragment, vertex = _stages()
        stage = fragment if fragment in shaders else vertex
        repeated = {e for e in unseen if frame.state(e).shaders.get(vertex) == shaders[vertex]} if stage == vertex else unseen
        shared = used[shaders[stage], stage] - writers | repeated
        if shared and stage == vertex:
            raise FrameError("the casters have no fragment shader and share their vertex shader with other draws: the light cannot be "
                             "told apart in this frame")
        of_camera = shared - of_others
        like_camera = of_camera and any(apart.are_one(apart.line(layer), apart.lens_line(lens)) for layer in layers)
        lines = ([apart.lens_line(lens)] if of_camera and not like_camera else []) + apart.lines_of_others(layers, others, shared)
        original, told = _told_by_a_constant(frame, layers, of_camera, event) if like_camera else ("", None)
        plan[shaders[stage], stage] = Source(stage == fragment, False, 1.0 if layers[0].state.reversed else 0.0, tuple(dict.fromkeys(lines)), minus_one,
                                             rects if shared else (), not frame.textures[passes.texture].is_depth, original, told)
    return plan


def _told_by_a_constant(frame, layers, of_camera, event):
    """(the fragment shader's text, the Constant) where projections do not tell the casters from the camera's draws of one shader."""
    text = frame.glsl(event)
    told = apart.constant(frame, layers, of_camera, text) if text else None
    if told is None:
        raise FrameError("the camera and the light both project in parallel, or with the same near and far plane, and draw with one shader, of "
                         "which no constant tells them apart: judge a frame of a camera in perspective, or without a depth prepass")
    return text, told


def _stages():
    import renderdoc as rd

    return rd.ShaderStage.Fragment, rd.ShaderStage.Vertex


@dataclass
class Pictures:
    """The picture and the camera's depth after the last reader has drawn, and the map after its last caster: some renderers blur it
    in place."""

    colour: np.ndarray
    depth: np.ndarray
    maps: dict  # slice -> texels
    read: dict  # slice -> texels as the readers found them
    depths: dict = field(default_factory=dict)  # slice -> the depths that were drawn beside a colour map's texels

    def linear(self, encoded):
        return formats.linear(self.colour) if encoded else self.colour


def take_pictures(frame, passes, slices):
    frame.go_to(passes.writers[-1].event, again=True)
    maps = {s: frame.picture(passes.texture, s) for s in slices}
    beside = passes.writers[-1].depth
    depths = {s: frame.picture(beside, s)[..., 0] for s in slices if beside and beside != passes.texture and s < frame.textures[beside].slices}
    frame.go_to(passes.readers[-1].event, again=True)
    read = {s: frame.picture(passes.texture, s) for s in slices}
    return Pictures(passes.cut(frame.picture(passes.picture))[..., :3], passes.cut(frame.picture(passes.camera_depth))[..., 0], maps, read, depths)


def does_not_say(frame, passes):
    """Whether the picture has eight bits without a format that says what they mean: a window's are mostly sRGB-encoded."""
    return frame.textures[passes.picture].format.endswith("8_UNORM")


def replay(frame, passes, layers, lens, drawn, others):
    """(the pictures with the map empty, with the map full) of the light whose layers are given. `others`: layers of other lights, which
    stay as they are."""
    plan = _plan(frame, passes, layers, lens, others)
    pictures = []
    for full in (False, True):
        with frame.replaced({key: Source(**{**vars(source), "full": full}) for key, source in plan.items()}):
            pictures.append(take_pictures(frame, passes, list(drawn.maps)))
    return pictures


def work_out(drawn, empty, full, encoded):
    """The visibility of three pictures."""
    lit, dark = empty.linear(encoded), full.linear(encoded)
    light = (lit - dark).sum(-1)
    changed = light > DIM * light.max()
    bright = np.percentile(light[changed], 99) if changed.any() else 0.0
    if bright <= 0:
        raise FrameError("the picture is the same with the map empty and full: nothing that is seen in this frame reads it")
    asked = light > DIM * bright
    values = np.where(asked, (drawn.linear(encoded) - dark).sum(-1) / np.where(asked, light, 1), 0)
    left = dark.sum(-1)[asked].sum() / max(lit.sum(-1)[asked].sum(), 1e-30)
    same = np.array_equal(empty.depth, drawn.depth) and np.array_equal(full.depth, drawn.depth)
    return Visibility(values, encoded, asked, float(left), full.maps, same)
