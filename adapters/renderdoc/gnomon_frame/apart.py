"""How a light's casters are told from other draws of the same fragment shader: the camera's depth prepass, another light's casters.

Their parts of the map overlap those of the light, so that a stand-in must look at more than where a fragment lies. Projections differ:
z/w = za + zb / w, and w = 1 of parallel ones. Where they do not, as those of a sun and of an orthographic camera, a matrix among the
shader's constants differs.
"""
from dataclasses import dataclass

import numpy as np

from .errors import FrameError

LOOKED_AT = 4  # draws of each kind whose constants are compared


@dataclass(frozen=True)
class Constant:
    """A number of a matrix among a shader's constants, by which its draws are told."""

    matrix: str  # its name in the shader
    row: int
    column: int
    own: tuple  # its values in the light's draws
    within: float  # half of the way to the nearest of the other draws' values


def line(layer):
    """(za, zb) of a map's projection: z/w = za + zb / w; (None, None) where w is 1."""
    z, w = layer.light.matrix[2], layer.light.matrix[3]
    size = np.linalg.norm(w[:3])
    if layer.distance or size < 1e-6 * abs(w[3]):
        return None, None
    za = float(z[:3] @ w[:3] / size**2)
    return za, float(z[3] - za * w[3])


def lens_line(lens):
    """The same of the camera's."""
    return (None, None) if lens.parallel else (lens.za, lens.zb)


def are_one(own, other):
    """Whether two lines are one, and tell nothing apart."""
    return (own[0] is None) == (other[0] is None) and (own[0] is None or bool(np.allclose(own, other, rtol=1e-5)))


def _overlap(one, other):
    (x, y, width, height), (u, v, wide, high) = one.state.viewport, other.state.viewport
    return x < u + wide and u < x + width and y < v + high and v < y + height


def lines_of_others(layers, others, shared):
    """The lines of other lights' layers which those draws of shared shaders fill where the light's own lie, too."""
    lines = []
    for other in others:
        overlapped = [layer for layer in layers if set(other.events) & shared and _overlap(layer, other)]
        for own in map(line, overlapped):
            if are_one(own, line(other)):
                raise FrameError("its casters are drawn by the same shader and with the same projection as another light's: they cannot be told apart")
            lines.append(line(other))
    return lines


def _some(events):
    events = sorted(events)
    return events if len(events) <= LOOKED_AT else [events[k * (len(events) - 1) // (LOOKED_AT - 1)] for k in range(LOOKED_AT)]


def _values(frame, event):
    """{name: matrix} of constants that are no part of a larger one."""
    return {name.split(".", 1)[1]: m for name, m in frame.constants(event)[0] if name.count(".") == 1 and "[" not in name}


def constant(frame, layers, others, declared):
    """The Constant that tells the layers' draws from `others`, events of one shader whose text is `declared`; None where there is none."""
    of_layers = [_values(frame, event) for layer in layers for event in _some(layer.events)]
    of_others = [_values(frame, event) for event in _some(others)]
    best, widest = None, 1e-3
    for name in sorted(set.intersection(*map(set, of_layers + of_others))):
        own, other = (np.array([values[name] for values in some]) for some in (of_layers, of_others))
        if name not in declared or np.ptp(other, axis=0).max() > 0:  # a model's matrix is another one for each draw
            continue
        apart = np.abs(own - other[0]).min(0)
        relative = apart / np.maximum(np.abs(own).max(0), np.abs(other[0])).clip(1e-30)
        row, column = np.unravel_index(np.argmax(relative), relative.shape)
        if relative[row, column] > widest:
            widest = relative[row, column]
            best = Constant(name, int(row), int(column), tuple(dict.fromkeys(float(v) for v in own[:, row, column])), float(apart[row, column]) / 2)
    return best
