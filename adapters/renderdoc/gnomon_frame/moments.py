"""What the texels of a colour map hold: depths, distances, their powers, exponentials of them. It is told by the depth texture that the
same casters were drawn with; what the reader makes of it is held against the picture.

The formulas are those of docs/capture.md, in which the filter's constants are said: variance shadow maps (Donnelly and Lauritzen 2006),
exponential ones (Annen and others 2008), both (Lauritzen and McCool 2008), four moments (Peters and Klein 2015) as far as they are named.
"""
from dataclasses import dataclass, replace

import numpy as np

FEW = 64  # texels, which may follow a law by chance
EXACT = {"16": 4e-3}  # how far a texel may be off its law, of the numbers' spread, by the bits of a channel
FINE = 3e-4
VARIANCES = (0.0, *10.0 ** np.arange(-8, 0.1, 0.5))
REDUCTIONS = (0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.7, 0.9)
SMOOTHED = 0.9  # correlation of means with what they are of
TOLD = 0.02  # of an empty map's light the least that a full one takes
BELIEVED = 0.05  # root of the mean square by which the picture may differ from a law that is believed
OFF, MOST_OFF = 0.3, 0.02  # a pixel that differs by more, and the share of such pixels that is borne


@dataclass(frozen=True)
class Content:
    """What a texel holds, as functions of x: a number that rises with the distance from the light."""

    base: str = "depth"  # what x is: the window's depth, or a light's "distance" or "axis" (depth along it) by `range`
    range: tuple = (0.0, 1.0)  # world units that are stored as 0 and 1
    kind: str = "depths"  # or "vsm", "esm", "evsm", "msm"
    exponents: tuple = ()
    order: tuple = (0, 1, 2, 3)  # channels, in the order of a capture
    has_deviation: bool = False  # whether the second of vsm is the square root of the variance, as three.js stores it

    @property
    def channels(self):
        return {"depths": 1, "esm": 1, "vsm": 2, "msm": 4}.get(self.kind, 2 * len(self.exponents))


@dataclass(frozen=True)
class Fit:
    """What the reader makes of the texels, and how well that gives the picture."""

    content: Content
    variance: float = 0.0
    reduction: float = 0.0
    constant: float = 0.0
    off: float = np.inf  # root of the mean square difference
    wrong: float = 1.0  # share of pixels that differ by more than OFF

    def light(self, averages, x):
        return light(self.content, averages, x - self.constant, self.variance, self.reduction)

    @property
    def is_believed(self):
        return self.off <= BELIEVED and self.wrong <= MOST_OFF


def _line(x, y):
    """(rise, start, largest distance from the line as a share of y's spread)."""
    rise, start = np.polyfit(x, y, 1)
    return rise, start, float(np.abs(rise * x + start - y).max() / max(np.ptp(y), 1e-30))


def _is(a, b, fine):
    return bool(np.abs(a - b).max() <= fine * max(float(np.ptp(b)), 1e-6))


def find_content(channels, bases, bits):
    """The Content of texels [n, channels], or None. `bases`: {"depth": x, "distance": world units, ...} of the same texels; `bits` of a
    channel, a text."""
    fine = EXACT.get(bits, FINE)
    c = [channels[:, k] for k in range(channels.shape[1])]
    if len(c[0]) < FEW or np.ptp(c[0]) == 0:
        return None
    for base, x in bases.items():
        rise, start, off = _line(x, c[0])
        plain = off <= fine and rise > 0
        if plain and (base != "depth" or abs(rise - 1) < fine and abs(start) < fine):
            is_itself = abs(rise - 1) < fine and abs(start) < fine * np.ptp(x)
            return _powers(Content(base, (0.0, 1.0) if is_itself else (float(-start / rise), float((1 - start) / rise))), c, fine)
        if (c[0] > 0).all():
            rise, start, off = _line(x, np.log(c[0]))
            if off <= 4 * fine and (rise > 0.5 if base == "depth" else rise * np.ptp(x) > 0.5):
                return _warped(c, float(rise), float(start), x, fine) if base == "depth" else _of_world_units(base, float(rise), float(start), x)
    return None


def moments_of(content, texels):
    """Channels [.., c] in a capture's order."""
    out = texels[..., list(content.order[:content.channels])]
    return np.stack([out[..., 0], out[..., 0] ** 2 + out[..., 1] ** 2], -1) if content.has_deviation else out


def find_blurred_content(read, depths):
    """The Content of texels [rows, columns, channels] that passes of their own made of the casters' depths, or None: means of these, and how far they
    spread."""
    if read.shape[-1] < 2 or np.ptp(depths) == 0 or not (0 <= read[..., :2].min() and 0 < np.ptp(read[..., 0]) and read[..., :2].max() <= 1):
        return None
    is_mean = np.corrcoef(read[..., 0].ravel(), depths.ravel())[0, 1] > SMOOTHED
    return Content(kind="vsm", has_deviation=True) if is_mean else None


def _powers(content, c, fine):
    if len(c) > 3 and _is(c[1], c[0] ** 2, fine) and _is(c[2], c[0] ** 3, fine) and _is(c[3], c[0] ** 4, fine):
        return replace(content, kind="msm")
    return replace(content, kind="vsm") if len(c) > 1 and _is(c[1], c[0] ** 2, fine) else content


def _of_world_units(base, rise, start, x):
    """An exponential of distances, whose factor alone is told: the range ends behind what is drawn."""
    near, far = -start / rise, 1.05 * float(x.max())
    return Content(base, (near, far), "esm", (rise * (far - near),))


def _warped(c, rise, start, x, fine):
    if abs(start) < 0.02 * rise:
        return Content(kind="esm", exponents=(rise,))
    if abs(start + 0.5 * rise) > 0.02 * rise:
        return None
    one = Content(kind="evsm", exponents=(0.5 * rise,))
    for square, negative, its_square in ((1, 2, 3), (2, 1, 3)):
        if len(c) <= square or not _is(c[square], c[0] ** 2, 4 * fine):
            continue
        if len(c) > its_square and (c[negative] < 0).all() and _is(c[its_square], c[negative] ** 2, 4 * fine):
            fall = -_line(x, np.log(-c[negative]))[0]
            return replace(one, exponents=(0.5 * rise, float(0.5 * fall)), order=(0, square, negative, its_square))
        if square == 1:
            return one
    return None


def _chebyshev(mean, square, x, least):
    variance = np.maximum(np.maximum(square - mean * mean, square * 2.0**-22), least)
    return np.where(x <= mean, 1.0, variance / (variance + (x - mean) ** 2))


def light(content, averages, x, variance=0.0, reduction=0.0):
    """The light in [0, 1] of places at x, of what their lookup reads [n, channels] in a capture's order."""
    if content.kind == "esm":
        return np.minimum(1, averages[:, 0] * np.exp(-content.exponents[0] * x))
    if content.kind == "vsm":
        out = _chebyshev(averages[:, 0], averages[:, 1], x, variance)
    else:
        out = np.ones(len(x))
        for k, (exponent, sign) in enumerate(zip(content.exponents, (1, -1))):
            warped = sign * np.exp(sign * exponent * (2 * x - 1))
            out = np.minimum(out, _chebyshev(averages[:, 2 * k], averages[:, 2 * k + 1], warped, variance * (exponent * warped) ** 2))
    return np.clip((out - reduction) / (1 - reduction), 0, 1)


def fit(content, drawn, empty, full, x, visibility, numbers=()):
    """The Fit with which the texels that were read give the picture; None of content whose formula is not tried. `drawn`, `empty`, `full`:
    what each replay's lookup reads; `visibility`: (drawn - full) / (empty - full) of the picture."""
    if content.kind in ("depths", "msm") or not len(x):
        return None
    own = sorted({abs(n) for n in numbers if 0 < abs(n) < 1})
    best = Fit(content)

    def tried(**values):
        nonlocal best
        one = replace(best, **values)
        lit, dark = one.light(empty, x), one.light(full, x)
        told = lit - dark > TOLD
        off = np.where(told, (one.light(drawn, x) - dark) / np.where(told, lit - dark, 1) - visibility, 1)
        one = replace(one, off=float(np.sqrt(np.mean(off**2))), wrong=float(np.mean(np.abs(off) > OFF)))
        if one.off < 0.97 * best.off - 5e-5:
            best = one

    tried()
    for _ in range(2):
        if content.kind != "esm":
            for value in (*VARIANCES, *own):
                tried(variance=float(value))
            for value in (*REDUCTIONS, *own):
                if value < 0.95:
                    tried(reduction=float(value))
        for value in (0.0, *own, *(-n for n in own)):
            if abs(value) < 0.1:
                tried(constant=float(value))
    return best
