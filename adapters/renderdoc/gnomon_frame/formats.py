"""Textures' bytes as numbers, and topologies as triangles."""
import re

import numpy as np

from .errors import FrameError


def linear(values):
    """Linear values of sRGB-encoded ones."""
    return np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055) ** 2.4)


def _small_floats(bits, mantissa):
    """Unsigned floats of five bits of exponent, as R11G11B10 packs them."""
    exponent, fraction = bits >> mantissa, (bits & ((1 << mantissa) - 1)) / (1 << mantissa)
    return np.where(exponent == 0, fraction * 2.0**-14, (1 + fraction) * 2.0 ** (exponent.astype(float) - 15))


def _depth(data, name, texels, opengl):
    if name.startswith("D32S8") or name.startswith("D32_FLOAT_S8"):
        return np.frombuffer(data, np.float32, 2 * texels)[::2]
    if name.startswith("D32"):
        values = np.frombuffer(data, np.float32, texels)
        # Whole numbers have the same name; as floats those of most depths are none, or lie outside.
        return values if ((values >= 0) & (values <= 1)).all() else np.frombuffer(data, np.uint32, texels) / 4294967295.0
    if name.startswith("D16"):
        return np.frombuffer(data, np.uint16, texels) / 65535.0
    bits = np.frombuffer(data, np.uint32, texels)
    if opengl:  # 24 bits and 8 of stencil, or all 32 of them where there is no stencil
        return (bits >> 8) / 16777215.0
    return (bits & 0xFFFFFF) / 16777215.0


def decode(data, name, width, height, opengl=False):
    """[height, width, channels] of a texture of RenderDoc's format `name`; 8-bit colours with the suffix SRGB become linear."""
    texels = width * height
    if name.startswith("D") and name[1:2].isdigit():
        values = _depth(data, name, texels, opengl)
    elif name.startswith("R11G11B10"):
        bits = np.frombuffer(data, np.uint32, texels)
        values = np.stack([_small_floats(bits & 0x7FF, 6), _small_floats(bits >> 11 & 0x7FF, 6), _small_floats(bits >> 22, 5)], -1)
    elif name.startswith(("R10G10B10A2", "B10G10R10A2")):
        bits = np.frombuffer(data, np.uint32, texels)
        values = np.stack([(bits >> shift & 0x3FF) / 1023.0 for shift in ((0, 10, 20) if name[0] == "R" else (20, 10, 0))], -1)
    else:
        values = _plain(data, name, texels)
    return values.reshape(height, width, -1).astype(float)


def _plain(data, name, texels):
    channels, _, kind = name.partition("_")
    widths = [int(w) for w in re.findall(r"[RGBA](\d+)", channels)]
    types = {(8, "UNORM"): np.uint8, (8, "SRGB"): np.uint8, (8, "UNORM_SRGB"): np.uint8, (16, "UNORM"): np.uint16, (16, "FLOAT"): np.float16,
             (32, "FLOAT"): np.float32}
    if not widths or (widths[0], kind) not in types or len(set(widths)) > 1:
        raise FrameError(f"textures of the format {name} cannot be read")
    kept = types[widths[0], kind]
    values = np.frombuffer(data, kept, texels * len(widths)).reshape(texels, -1).astype(float)
    if kept in (np.uint8, np.uint16):
        values /= np.iinfo(kept).max
    if "SRGB" in kind:
        values[:, :3] = linear(values[:, :3])
    return values[:, [2, 1, 0, 3]] if channels.startswith("B8") else values


def corners(topology, restart):
    """Places, among a draw's indices, of its triangles' corners; None of lines and points. `restart`: where an index begins a strip
    or fan anew."""
    if topology == "list":
        count = len(restart) // 3 * 3
        return np.arange(count, dtype=np.int32)
    if topology not in ("strip", "fan"):
        return None
    pieces, begin = [], 0
    for end in [*np.flatnonzero(restart), len(restart)]:
        first = np.arange(begin, end - 2)
        if len(first):
            if topology == "fan":
                pieces.append(np.stack([np.full(len(first), begin), first + 1, first + 2], -1))
            else:
                odd = (first - begin) % 2
                pieces.append(np.stack([first, first + 1 + odd, first + 2 - odd], -1))
        begin = end + 1
    return np.concatenate(pieces).reshape(-1) if pieces else np.arange(0)


def numbered(indices):
    """(indices that occur, in their order; each index as its place among these)"""
    occurs = np.zeros(int(indices.max()) + 1, bool)
    occurs[indices] = True
    return np.flatnonzero(occurs), (np.cumsum(occurs, dtype=np.int32) - np.int32(1))[indices]


def of_attribute(kind, width):
    """(NumPy's type, what stands for 1) of a vertex attribute's numbers, which are `width` bytes wide; None of kinds that hold no position."""
    known = {("Float", 4): (np.float32, 1), ("Float", 2): (np.float16, 1), ("SNorm", 2): (np.int16, 32767), ("UNorm", 2): (np.uint16, 65535),
             ("SNorm", 1): (np.int8, 127), ("UNorm", 1): (np.uint8, 255), ("SScaled", 2): (np.int16, 1), ("UScaled", 2): (np.uint16, 1)}
    return known.get((kind, width))
