"""Which textures of a frame are shadow maps, who draws into them and who reads them; which draws are the camera's."""
from dataclasses import dataclass

from .errors import FrameError

FULL_SCREEN = 6  # a draw of so few vertices covers the picture and shows no mesh
FEW = 8  # draws, which may be alike by chance


@dataclass
class MapPasses:
    """A shadow map, and the picture that it is read for."""

    texture: int
    writers: list  # draws
    readers: list  # draws, the last of which completes the picture
    picture: int  # the colour texture that the readers draw into
    camera_depth: int
    camera: list  # draws into the camera's depth, before the last reader has drawn
    prepass: list  # those among them before which nothing else is drawn there and whose vertices the readers draw again
    is_copied: bool  # whether the readers read a copy of the map, of another layout
    rectangle: tuple | None = None  # x, y, width, height of what the camera draws of the picture; None: all

    def cut(self, picture):
        """What the camera draws of a picture as large as its own."""
        if self.rectangle is None:
            return picture
        x, y, width, height = self.rectangle
        return picture[max(y, 0):y + height, max(x, 0):x + width]


def _writers(frame, colour_maps):
    """{texture: draws that write it}: depth textures, and colour textures that are drawn with a depth test."""
    written = {}
    for draw in frame.draws:
        if draw.depth:
            written.setdefault(draw.depth, []).append(draw)
        if colour_maps and draw.depth:
            for texture in draw.colours:
                written.setdefault(texture, []).append(draw)
    return written


def _camera_depth(frame, last, readers, written):
    """The depth texture of the camera's view: that of the last reader, or, where that is a full-screen draw, one of the same
    size that it reads or that was drawn most into."""
    if last.depth in written and last.vertices > FULL_SCREEN:
        return last.depth
    size = _size(frame, last.colours[0])
    fit = [t for t in written if frame.textures[t].is_depth and _size(frame, t) == size]
    return max(fit, key=lambda t: sum(d.vertices for d in written[t]), default=0)


def _size(frame, texture):
    t = frame.textures[texture]
    return t.width, t.height


def _copied_from(frame, texture, written):
    """The texture that full-screen draws copy into this one, such as a cube that becomes a paraboloid; else the texture itself."""
    copies = {d.event for d in written[texture]}
    if any(d.vertices > FULL_SCREEN for d in written[texture]):
        return texture
    return next((t for t in written if t != texture and copies & set(frame.readers_of(t))), texture)


def _blurs(frame, texture, writers, written):
    """Events of full-screen draws into a map that make its texels anew, from what others made of them: they read what this frame draws."""
    flat = {w.event for w in writers if w.vertices <= FULL_SCREEN}
    made = {d.colours[0]: d.event for d in frame.draws if d.colours and d.vertices <= FULL_SCREEN} if flat else {}
    return {e for t, event in made.items() if t != texture and t in frame.textures for e in frame.readers_of(t) if e in flat and e > event}


def _prepass(camera, readers):
    """The camera's draws before the first reader, if these draw the same vertices and nothing else, one by one."""
    of_readers = {d.event for d in readers}
    before = [d for d in camera if d.event < readers[0].event]
    again = [d for d in camera if d.event in of_readers]
    alike = sorted(d.range for d in before) == sorted(d.range for d in again)
    return before if alike and len(before) >= FEW else []


def _as_map(frame, texture, written, by_event, as_large=False):
    """The texture's passes if it is a shadow map of some picture, else None."""
    writers = written[texture]
    reads = [by_event[e] for e in frame.readers_of(texture) if e in by_event]
    readers = [d for d in reads if d.colours and d.event > writers[0].event and texture != d.depth and texture not in d.colours]
    if not readers:
        return None
    last = readers[-1]
    camera_depth = _camera_depth(frame, last, readers, written)
    if not camera_depth or camera_depth == texture:
        return None
    picture = last.colours[0]
    readers = [d for d in readers if d.colours[0] == picture]
    if not as_large and _size(frame, texture) == _size(frame, picture):
        return None  # a camera's own depth, read by an effect
    camera = [d for d in written[camera_depth] if d.event <= last.event]
    origin = _copied_from(frame, texture, written)
    casters = [w for w in written[origin] if w.event < last.event]
    blurs = _blurs(frame, origin, casters, written)
    casters = [w for w in casters if w.event not in blurs]
    if not casters:
        return None
    return MapPasses(origin, casters, readers, picture, camera_depth, camera, _prepass(camera, readers), origin != texture)


def find_maps(frame, colour_maps=False, as_large=False):
    """Shadow maps of a frame, the most read first. Colour textures are looked at only where asked for, or where no depth texture
    is a map; depth textures as large as the picture where there is no other."""
    written = _writers(frame, colour_maps)
    by_event = {d.event: d for d in frame.draws}
    wanted = [t for t in written if t in frame.textures and frame.textures[t].is_depth != colour_maps]
    found = [m for t in wanted if (m := _as_map(frame, t, written, by_event, as_large)) is not None]
    found.sort(key=lambda m: (-len(m.readers), m.texture))
    if not found and not colour_maps:
        return find_maps(frame, True, as_large) or ([] if as_large else find_maps(frame, False, True))
    return found


def refuse_searched(samplers, beside=()):
    """A FrameError where a reader compares with the map through one of its samplers and reads depths through another, or what is drawn `beside` it:
    it looks for what casts, and filters the more the farther that is. Of a full map its filter has another width, so that the replays do not tell
    the light."""
    if any("compare" in one for one in samplers) and any(one and "compare" not in one for one in (*samplers, *beside)):
        raise FrameError("its reader compares depths with the map and reads them, too, as contact hardening (PCSS) does: the map, empty and full, does not "
                         "tell the light then. Record a frame with another filter")


def why_none(frame):
    """The error for a frame without a shadow map."""
    drawn = {d.depth for d in frame.draws} | {c for d in frame.draws for c in d.colours}
    by_event = {d.event for d in frame.draws}
    old = [t for t in frame.textures.values() if t.is_depth and t.id not in drawn and any(e in by_event for e in frame.readers_of(t.id))]
    if old:
        return FrameError(f"a depth texture of {old[0].width} x {old[0].height} is read, but no draw of this frame writes it: its shadow map "
                          "was drawn in an earlier frame. Record a frame in which the light or a caster moves")
    return FrameError("no texture is drawn with depth and then read by a later draw: this frame has no shadow map")
