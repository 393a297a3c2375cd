"""What the tests of adapters/renderdoc share: its modules, of which the folder is the first word, and scenes whose every number is
known beforehand. RenderDoc is not needed."""
import importlib.util
import json
import os
import struct
import sys
import tempfile
import unittest
from types import SimpleNamespace

try:
    import numpy as np
except ImportError:
    print("skipped: python3-numpy is not installed")
    sys.exit(77)

ADAPTER = os.path.abspath(sys.argv.pop(1))
sys.path.insert(0, ADAPTER)
from gnomon_frame import apart, capture, conventions, extract, files, fit, formats, lens, lookup  # noqa: E402
from gnomon_frame import normals, pairing, passes, pixels, reader, report, spirv, stand_ins, visibility  # noqa: E402
from gnomon_frame.errors import FrameError  # noqa: E402

ARITHMETIC = 2e-6  # positions are kept as 32-bit floats
CUBE = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)


def turned(angle, axis):
    """A rotation about an axis, radians."""
    x, y, z = np.asarray(axis, float) / np.linalg.norm(axis)
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    m = np.eye(4)
    m[:3, :3] += np.sin(angle) * k + (1 - np.cos(angle)) * k @ k
    return m


def shifted(x, y, z):
    m = np.eye(4)
    m[:3, 3] = x, y, z
    return m


def perspective(fx, fy, near, far, minus_one):
    low = -1 if minus_one else 0
    za, zb = (far - low * near) / (far - near), -(1 - low) * far * near / (far - near)
    return np.array([[fx, 0, 0, 0], [0, fy, 0, 0], [0, 0, -za, zb], [0, 0, -1, 0]], float)


def parallel(half, near, far):
    """OpenGL's parallel projection."""
    return np.diag([1 / half, 1 / half, -2 / (far - near), 1]) + shifted(0, 0, -(far + near) / (far - near)) - np.eye(4)


def pipeline(minus_one=True, **state):
    """What a lens asks of the pipeline's state."""
    return SimpleNamespace(conventions=conventions.opengl(minus_one=minus_one), reversed=False, **{"side": 0, **state})


def drawn(matrix, points):
    """Clip positions as a graphics card has them: 32-bit floats."""
    return (fit.homogeneous(points) @ matrix.T).astype(np.float32).astype(float)


PLACES = [shifted(0.3 * k - 1, 0.2 * k, -5 - k) @ turned(0.7 * k, (1, k, 2)) for k in range(4)]
VIEWS = np.concatenate([(fit.homogeneous(CUBE) @ m.T)[:, :3] for m in PLACES])
TO_SUN = turned(0.9, (1, 0.3, 0)) @ shifted(0.4, 1, 6)  # light's space from view space
BIAS = np.array([[0.5, 0, 0, 0.5], [0, 0.5, 0, 0.5], [0, 0, 0.5, 0.5], [0, 0, 0, 1]])  # to texture coordinates
