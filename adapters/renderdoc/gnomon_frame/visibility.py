"""How much of a light reaches each pixel, from three replays: as it is, with its map empty, with its map full.

visibility = (drawn - full) / (empty - full). It is linear, so ambient light, other lights and a shadow's strength cancel.
"""
from dataclasses import dataclass, field, replace

import numpy as np

from . import apart, formats
from .errors import FrameError
from .stand_ins import Source

FAR = 6e4  # of a colour map's channels: all but the largest of a half float
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
        if of_camera and lens.curved:
            raise FrameError("the camera's depths are no function of the distance that a matrix makes, and casters share a shader with its draws: they cannot "
                             "be told apart. Record a frame without logarithmic depths")
        like_camera = of_camera and any(apart.are_one(apart.line(layer), apart.lens_line(lens)) for layer in layers)
        lines = ([apart.lens_line(lens)] if of_camera and not like_camera else []) + apart.lines_of_others(layers, others, shared)
        original, told = _told_by_a_constant(frame, layers, of_camera, event) if like_camera else ("", None)
        plan[shaders[stage], stage] = Source(stage == fragment, False, nearest=1.0 if layers[0].state.reversed else 0.0, lines=tuple(dict.fromkeys(lines)),
                                             minus_one=minus_one, rects=rects if shared else (), colour=not frame.textures[passes.texture].is_depth,
                                             original=original, told=told)
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
    mixed: np.ndarray | None = None  # pixels of several samples that show more than one thing

    def linear(self, encoded):
        return formats.linear(self.colour) if encoded else self.colour


def take_pictures(frame, passes, slices):
    frame.go_to(passes.writers[-1].event, again=True)
    maps = {s: frame.picture(passes.texture, s) for s in slices}
    beside = passes.writers[-1].depth
    depths = {s: frame.picture(beside, s)[..., 0] for s in slices if beside and beside != passes.texture and s < frame.textures[beside].slices}
    frame.go_to(passes.readers[-1].event, again=True)
    read = {s: frame.picture(passes.texture, s) for s in slices}
    colour, mixed = _one_thing_each(frame, passes, passes.picture, lambda samples: np.ptp(samples[..., :3], axis=0).max(-1) > 0)
    depth, broken = _one_thing_each(frame, passes, passes.camera_depth, _is_no_plane)
    mixed = mixed if broken is None else broken if mixed is None else mixed | broken
    return Pictures(colour[..., :3], depth[..., 0], maps, read, depths, mixed)


def _one_thing_each(frame, passes, texture, is_mixed):
    """(the camera's part of a picture, which of its pixels are mixed): of several samples a pixel the mean, which is what lies in its middle where
    all show one thing."""
    if frame.textures[texture].samples <= 1:
        return passes.cut(frame.picture(texture)), None
    samples = np.array([passes.cut(one) for one in frame.samples(texture)])
    return samples.mean(0), is_mixed(samples)


def _is_no_plane(samples):
    """Pixels whose depths are of more than one plane: nearest and farthest of four samples lie as far from the middle as one another."""
    depths = np.sort(samples[..., 0], axis=0)
    if len(depths) != 4:  # whose places are not told
        return np.zeros(depths.shape[1:], bool)
    return np.abs(depths[0] + depths[3] - depths[1] - depths[2]) > 0.1 * (depths[3] - depths[0]) + 4 * 2.0**-24


def rasterized_depths(frame, passes, layers):
    """{slice: depths of the map as the rasterizer makes them} where the casters' fragment shaders write others; {} where none does."""
    fragment, _ = _stages()
    events = sorted({event for layer in layers for event in layer.events})
    own = {frame.state(event).shaders[fragment] for event in events if fragment in frame.state(event).shaders and frame.writes_own_depth(event)}
    if not own:
        return {}
    with frame.replaced({(shader, fragment): Source(True, False, plain=True) for shader in own}):
        frame.go_to(passes.writers[-1].event, again=True)
        return {s: frame.picture(passes.texture, s)[..., 0] for s in sorted({layer.state.slice for layer in layers})}


def distances(frame, found):
    """The camera's picture of distances along its axis, NaN where nothing was drawn, of depths that no lens tells: shaders of its draws write
    depths of w instead. None where the lens tells them."""
    passes, view = found.passes, found.view
    fragment, _ = _stages()
    draws = [d for d in passes.camera if frame.state(d.event).writes_depth]
    if view.lens.parallel or not (view.lens.curved or any(frame.writes_own_depth(d.event) for d in draws)):
        return None
    if any(fragment not in frame.state(d.event).shaders for d in draws):
        raise FrameError("the camera's depths are no function of the distance that a matrix makes, and some draws have no fragment shader that could tell it: "
                         "switch the depth prepass off, or logarithmic depths")
    before = np.concatenate([-points[:, 2] for points in view.positions])
    near = 0.5 * float(before[before > 1e-3].min())
    nearest = 1.0 if view.state.reversed else 0.0
    best = None
    # What a draw leaves out is left out, too, where its own shader can go before: where that shows much less than was drawn it did not work.
    for original in (frame.glsl, lambda _: ""):
        plan = {(frame.state(d.event).shaders[fragment], fragment): Source(True, False, nearest=nearest, near=near, original=original(d.event)) for d in draws}
        with frame.replaced(plan):
            frame.go_to(passes.readers[-1].event, again=True)
            depth = passes.cut(frame.picture(passes.camera_depth))[..., 0]
        of_w = depth if view.state.reversed else 1 - depth
        seen = (of_w > 0) & (of_w < 1)
        if best is None or seen.sum() > 1.2 * np.isfinite(best).sum():
            best = np.where(seen, near / np.where(seen, of_w, 1), np.nan)
    return best


def does_not_say(frame, passes):
    """Whether the picture has eight bits without a format that says what they mean: a window's are mostly sRGB-encoded."""
    return frame.textures[passes.picture].format.endswith("8_UNORM")


def replay(frame, passes, layers, lens, drawn, others):
    """(the pictures with the map empty, with the map full) of the light whose layers are given. `others`: layers of other lights, which
    stay as they are."""
    plan = _plan(frame, passes, layers, lens, others)

    def pictures(full, far=None):
        with frame.replaced({key: replace(source, full=full, far=far) for key, source in plan.items()}):
            return take_pictures(frame, passes, list(drawn.maps))

    empty, full = pictures(False), pictures(True)
    # A colour map that is cleared with what stands for the nearest is as dark without casters as full of them.
    if all(source.colour and not source.rects for source in plan.values()) and _is_darker(empty, drawn):
        empty = pictures(False, FAR)
    return empty, full


def _is_darker(empty, drawn):
    """Whether many pixels are darker without casters than with them."""
    return bool((empty.colour.sum(-1) < drawn.colour.sum(-1) - 0.02).mean() > 0.01)


def work_out(drawn, empty, full, encoded):
    """The visibility of three pictures."""
    lit, dark = empty.linear(encoded), full.linear(encoded)
    light = (lit - dark).sum(-1)
    changed = light > DIM * light.max()
    bright = np.percentile(light[changed], 99) if changed.any() else 0.0
    if max(float(lit.max(initial=0)), float(drawn.colour.max(initial=0))) <= 0:
        raise FrameError("the picture comes back black from the replay, as of windows whose pixels have several samples and no alpha: record a window without "
                         "MSAA, or look where there is light")
    if bright <= 0:
        raise FrameError("the picture is the same with the map empty and full: nothing that is seen in this frame reads it")
    asked = light > DIM * bright
    values = np.where(asked, (drawn.linear(encoded) - dark).sum(-1) / np.where(asked, light, 1), 0)
    left = dark.sum(-1)[asked].sum() / max(lit.sum(-1)[asked].sum(), 1e-30)
    same = np.array_equal(empty.depth, drawn.depth) and np.array_equal(full.depth, drawn.depth)
    return Visibility(values, encoded, asked, float(left), full.maps, same)
