"""Shaders that stand in for those of the casters: one leaves the map empty, the other fills it with the nearest depth.

The fragment shader is exchanged where the casters have one, else the vertex shader. A fragment shader may be shared with draws
that belong to no map of this light, such as a depth prepass or another light's: the stand-in then acts only where a fragment
lies in the light's part of the map, and not on the line z/w = za + zb / w of another projection, nor at w = 1 of a parallel one, or
where a constant of the original shader says so, which then goes on below the stand-in.
"""
import re
from dataclasses import KW_ONLY, dataclass

from . import spirv
from .apart import Constant

# Fragments' z and w are floats: on the camera's line to some units in the last place of 1 (2^-24 each).
ON_LINE = 2e-6


@dataclass(frozen=True)
class Source:
    fragment: bool  # which of both shaders it stands in for
    full: bool  # whether the map becomes full, or empty
    _: KW_ONLY
    nearest: float = 0.0  # what a texel stores of the nearest thing: 0, or 1 where depths are reversed
    lines: tuple = ()  # (za, zb) of projections that are left alone; (None, None) of parallel ones
    minus_one: bool = False  # whether z/w runs from -1
    rects: tuple = ()  # (x0, y0, x1, y1), texels: what lies outside of all is left alone
    colour: bool = False  # whether the map is a colour texture
    far: float | None = None  # what an empty colour map's texels hold where casters would be, in place of what it was cleared with
    original: str = ""  # text of the shader in GLSL, where a constant of its own tells the casters
    told: Constant | None = None
    plain: bool = False  # a fragment shader that does nothing: depths are then the rasterizer's
    near: float | None = None  # a fragment shader that writes depths of w alone: 1 - near / w, or near / w where depths are reversed (nearest is 1)


def encoded(source, pipe, encodings):
    """(encoding, code) for the API of a pipeline state of RenderDoc."""
    import renderdoc as rd

    if pipe.IsCaptureGL():
        return rd.ShaderEncoding.GLSL, glsl(source).encode()
    if pipe.IsCaptureVK():
        return rd.ShaderEncoding.SPIRV, spir_v(source)
    return rd.ShaderEncoding.HLSL, hlsl(source).encode()


# --- The C-like languages ------------------------------------------------------------------------------------------------

def _condition(source, coord, inverse_w):
    """An expression: whether a fragment is one of the light's."""
    words = []
    if source.rects:
        inside = " || ".join(f"({coord}.x >= {x0:.1f} && {coord}.x < {x1:.1f} && {coord}.y >= {y0:.1f} && {coord}.y < {y1:.1f})"
                             for x0, y0, x1, y1 in source.rects)
        words.append(f"({inside})")
    z = f"({coord}.z * 2.0 - 1.0)" if source.minus_one else f"{coord}.z"
    for za, zb in source.lines:
        off = f"{inverse_w} - 1.0" if za is None else f"{z} - ({za:.9g}f + {zb:.9g}f * {inverse_w})"
        words.append(f"(abs({off}) > {ON_LINE})".replace("e-06", "e-6"))
    return " && ".join(words) or "true"


def glsl(source):
    if not source.fragment:
        place = "vec4(k == 1 ? 3.0 : -1.0, k == 2 ? 3.0 : -1.0, -1.0, 1.0)" if source.full else "vec4(2.0, 2.0, 2.0, 1.0)"
        return f"#version 330\nvoid main() {{ int k = gl_VertexID % 3; gl_Position = {place}; }}\n"
    if source.plain:
        return "#version 330\nvoid main() { }\n"
    if source.near is not None:
        depth = f"{source.near:.9g} * gl_FragCoord.w"
        write = f"gl_FragDepth = {depth if source.nearest else '1.0 - ' + depth};"
        return _after_the_original(source, write) if source.original else f"#version 330\nvoid main() {{ {write} }}\n"
    here = _condition(source, "gl_FragCoord", "gl_FragCoord.w")
    if source.told:
        return _above_the_original(source, here)
    if source.far is not None and not source.full:
        return f"#version 330\nlayout(location = 0) out vec4 colour;\nvoid main() {{ colour = vec4(vec3({source.far:.1f}), 1.0); }}\n"
    if not source.full:
        return f"#version 330\nvoid main() {{ if ({here}) discard; }}\n"
    colour = ("layout(location = 0) out vec4 colour;\n", f" colour = vec4({source.nearest:.1f});") if source.colour else ("", "")
    return (f"#version 330\n{colour[0]}void main() {{ gl_FragDepth = ({here}) ? {source.nearest:.1f} : gl_FragCoord.z;{colour[1]} }}\n")


def _renamed(source):
    """The original with a `main` of another name."""
    version = re.search(r"^[ \t]*#[ \t]*version.*\n", source.original, re.MULTILINE)
    begin = version.end() if version else 0
    return source.original[:begin] + "#define main drawn_otherwise\n" + source.original[begin:] + "\n#undef main\n"


def _after_the_original(source, write):
    """The original, after which something more is done with the fragments that it leaves."""
    return _renamed(source) + f"void main() {{ drawn_otherwise(); {write} }}\n"


def _above_the_original(source, here):
    """The original with another `main`, which calls its own for draws that are no casters of the light."""
    told = source.told
    number = f"{told.matrix}[{told.column}][{told.row}]"
    own = " || ".join(f"abs({number} - ({value:.9g})) < {told.within:.9g}" for value in told.own)
    act = f"gl_FragDepth = {source.nearest:.1f};" if source.full else "discard;"
    kept = "gl_FragDepth = gl_FragCoord.z; " if source.full else ""
    return (_renamed(source) +
            f"void main() {{ if (({here}) && ({own})) {{ {act} }} else {{ {kept}drawn_otherwise(); }} }}\n")


def hlsl(source):
    if not source.fragment:
        place = "float4(k == 1 ? 3.0 : -1.0, k == 2 ? 3.0 : -1.0, %.1f, 1.0)" % source.nearest if source.full else "float4(2.0, 2.0, 2.0, 1.0)"
        return f"float4 main(uint id : SV_VertexID) : SV_Position {{ uint k = id % 3; return {place}; }}\n"
    if source.plain:
        return "void main() { }\n"
    here = _condition(source, "p", "(1.0 / p.w)")
    if source.far is not None and not source.full:
        return "float4 main(float4 p : SV_Position) : SV_Target0 {{ return float4({0:.1f}, {0:.1f}, {0:.1f}, 1.0); }}\n".format(source.far)
    if not source.full:
        return f"void main(float4 p : SV_Position) {{ if ({here}) discard; }}\n"
    colour = (", out float4 colour : SV_Target0", f" colour = {source.nearest:.1f};") if source.colour else ("", "")
    return (f"void main(float4 p : SV_Position, out float depth : SV_Depth{colour[0]}) "
            f"{{ depth = ({here}) ? {source.nearest:.1f} : p.z;{colour[1]} }}\n")


# --- SPIR-V --------------------------------------------------------------------------------------------------------------

def spir_v(source):
    return _spirv_fragment(source) if source.fragment else _spirv_vertex(source)


def _spirv_vertex(source):
    m = spirv.Module(spirv.VERTEX)
    four = m.vector(4)
    position = m.builtin(spirv.OUTPUT, four, spirv.POSITION)
    index = m.builtin(spirv.INPUT, m.int, spirv.VERTEX_INDEX) if source.full else 0
    m.do(248, m.new())
    one = m.number(1.0)
    if source.full:
        k = m.op(139, m.int, m.load(m.int, index), m.whole(3))
        sides = [m.op(169, m.float, m.op(170, m.bool, k, m.whole(which)), m.number(3.0), m.number(-1.0)) for which in (1, 2)]
        place = m.op(80, four, *sides, m.number(source.nearest), one)
    else:
        two = m.number(2.0)
        place = m.op(80, four, two, two, two, one)
    m.do(62, position, place)
    m.do(253)
    return m.assembled()


def _spirv_condition(m, source, coord):
    """The id of a truth value: whether a fragment is one of the light's."""
    conditions = []
    inside = None
    for x0, y0, x1, y1 in source.rects:
        tests = [m.op(op, m.bool, m.part(coord, axis), m.number(limit))
                 for op, axis, limit in ((190, 0, x0), (184, 0, x1), (190, 1, y0), (184, 1, y1))]
        one = tests[0]
        for test in tests[1:]:
            one = m.op(167, m.bool, one, test)
        inside = one if inside is None else m.op(166, m.bool, inside, one)
    if inside is not None:
        conditions.append(inside)
    for za, zb in source.lines:
        if za is None:
            off = m.op(131, m.float, m.part(coord, 3), m.number(1.0))
        else:
            line = m.op(129, m.float, m.number(za), m.op(133, m.float, m.number(zb), m.part(coord, 3)))
            off = m.op(131, m.float, m.part(coord, 2), line)
        conditions.append(m.op(186, m.bool, m.absolute(off), m.number(ON_LINE)))
    if not conditions:
        zero = m.number(0.0)
        return m.op(180, m.bool, zero, zero)
    all_of = conditions[0]
    for one in conditions[1:]:
        all_of = m.op(167, m.bool, all_of, one)
    return all_of


def _spirv_fragment(source):
    m = spirv.Module(spirv.FRAGMENT)
    m.modes = [7, 12] if source.full or source.near is not None else [7]  # the origin is at the upper left; depth is replaced
    if source.plain:
        m.do(248, m.new())
        m.do(253)
        return m.assembled()
    four = m.vector(4)
    coord_at = m.builtin(spirv.INPUT, four, spirv.FRAG_COORD)
    depth = m.builtin(spirv.OUTPUT, m.float, spirv.FRAG_DEPTH) if source.full or source.near is not None else 0
    is_far = source.far is not None and not source.full
    colour = m.output(four, 0) if is_far or source.full and source.colour else 0
    m.do(248, m.new())
    coord = m.load(four, coord_at)
    if source.near is not None:
        of_w = m.op(133, m.float, m.number(source.near), m.part(coord, 3))
        m.do(62, depth, of_w if source.nearest else m.op(131, m.float, m.number(1.0), of_w))
        m.do(253)
        return m.assembled()
    if is_far:
        m.do(62, colour, m.op(80, four, *[m.number(source.far)] * 3, m.number(1.0)))
        m.do(253)
        return m.assembled()
    here = _spirv_condition(m, source, coord)
    nearest = m.number(source.nearest)
    if source.full:
        m.do(62, depth, m.op(169, m.float, here, nearest, m.part(coord, 2)))
        if colour:
            m.do(62, colour, m.op(80, four, *[nearest] * 4))
        m.do(253)
    else:
        killed, alive = m.new(), m.new()
        m.do(247, alive, 0)
        m.do(250, here, killed, alive)
        m.do(248, killed)
        m.do(252)
        m.do(248, alive)
        m.do(253)
    return m.assembled()
