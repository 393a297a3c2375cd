"""Which form a reader's bias has: a constant, one that grows with the angle between normal and light, a place moved along its normal; and
whether the sampler interpolates depths. Each is held against the picture. Of forms that give it alike, one whose numbers stand in the
frame is taken, then the simplest."""
from dataclasses import dataclass, replace

import numpy as np

from . import lookup

NEARLY = 1e-4  # of the pixels: forms that differ by fewer give the picture alike
MOST_PLACES = 25000  # that are looked at while a form is searched
NEAR = 6e-3  # the same, of forms that are looked at where partly lit pixels have to tell: a filter leaves few sure ones
MOST_FORMS = 400  # of these
OF_NORMALS = 5e-4  # the same, of forms that ask for normals: a shader's are interpolated, these are of the picture's places
OF_GIVEN = 4e-4  # by so much more of the places a constant that the shader is given must give than none
LARGEST = 0.3  # of stored depths, or texels of 1 / 30: what a bias is not larger than
ANGLES = {"sine": lambda c: np.sqrt(np.maximum(1 - c * c, 0)), "tangent": lambda c: np.sqrt(np.maximum(1 - c * c, 0)) / np.maximum(c, 1e-3),
          "one_minus_cosine": lambda c: 1 - c}


@dataclass(frozen=True)
class Form:
    """A test's bias and how it reads depths, in a capture's words."""

    constant: float = 0.0  # stored numbers
    angle: str = "none"
    low: float | None = None
    high: float | None = None
    offset: float = 0.0  # world units along the normal
    offset_angle: str = "none"
    linear: bool = False
    wrong: float = 1.0  # share of the places within the map that it decides otherwise than the picture
    known: bool = False  # whether its numbers stand in the frame

    @property
    def parts(self):
        return (self.constant != 0) + (self.angle != "none") + (self.low is not None) + (self.high is not None) + 2 * (self.offset != 0)

    @property
    def is_constant(self):
        return self.angle == "none" and not self.offset

    def bias(self, cosine):
        """What it takes off the depth of places whose normals are at these angles to the light."""
        if self.angle == "none":
            return np.full(len(cosine), self.constant)
        out = self.constant * ANGLES[self.angle](cosine)
        return np.clip(out, -np.inf if self.low is None else self.low, np.inf if self.high is None else self.high)

    def moved(self, places, normals, cosine):
        if not self.offset:
            return places
        by = self.offset * (ANGLES[self.offset_angle](cosine) if self.offset_angle != "none" else np.ones(len(cosine)))
        return places + normals * by[:, None]

    def said(self):
        """A capture's `bias`."""
        out = {"constant_depth": self.constant}
        if self.angle != "none":
            out["angle"] = self.angle
        if self.low is not None:
            out["min"] = self.low
        if self.high is not None:
            out["max"] = self.high
        if self.offset:
            out["normal_offset_world"] = self.offset
        if self.offset_angle != "none":
            out["normal_offset_angle"] = self.offset_angle
        return out


def normals(positions, drawn):
    """Normals of a picture's places, towards the eye; of the neighbours on both sides the nearer ones tell."""
    def along(axis):
        step = np.diff(positions, axis=axis)
        both = np.take(drawn, range(1, drawn.shape[axis]), axis) & np.take(drawn, range(drawn.shape[axis] - 1), axis)
        step = np.where(both[..., None], step, np.inf)
        edge = np.full_like(np.take(positions, [0], axis), np.inf)
        before, after = np.concatenate([edge, step], axis), np.concatenate([step, edge], axis)
        size = lambda d: np.where(np.isfinite(d).all(-1), (np.nan_to_num(d, posinf=0) ** 2).sum(-1), np.inf)
        return np.nan_to_num(np.where((size(before) < size(after))[..., None], before, after), posinf=0)

    n = np.cross(along(1), along(0))
    n /= np.maximum(np.linalg.norm(n, axis=-1, keepdims=True), 1e-30)
    return np.where((n * positions).sum(-1, keepdims=True) > 0, -n, n)


def cosines(place, positions, normals_):
    """Of the angle between normal and light, of a sun or of a light at a point."""
    to_light = -place.direction if place.apex is None else place.apex - positions
    to_light = to_light / np.linalg.norm(to_light, axis=-1, keepdims=True)
    return np.clip((normals_ * to_light).sum(-1), 0, 1)


class Search:
    """Tries forms on places whose light is sure."""

    def __init__(self, looked_up, places, normals_, lit, numbers, linear):
        layer = looked_up.layers[0]
        kept = slice(None, None, max(1, len(places) // MOST_PLACES))
        self.looked_up, self.places, self.normals, self.lit = looked_up.of(kept), places[kept], normals_[kept], lit[kept]
        self.cosine = cosines(layer.place, self.places, self.normals)
        largest = LARGEST if layer.content is None or layer.content.base == "depth" else np.inf  # world units have no scale of their own
        kept = lambda values: sorted({abs(float(n)) for n in values if n and abs(n) < largest})
        # Of distances that are stored as shares of a range numbers are world units.
        span = layer.content.range[1] - layer.content.range[0] if layer.content else 1.0
        numbers = replace(numbers, **{name: tuple(n / unit for n in getattr(numbers, name) for unit in {1.0, span}) for name in ("given", "alone", "factors")})
        self.given, self.constants, self.factors = kept(numbers.given), kept(numbers.given + numbers.alone), kept(numbers.given + numbers.factors)
        self.known = kept(numbers.all)
        self.lengths = sorted({abs(float(n)) for n in numbers.all if n})
        self.linear, self.usual = linear, ("tangent", "one_minus_cosine", "sine") if numbers.has_tangent else ("one_minus_cosine", "sine", "tangent")
        self.tried, self.is_thorough = [], False

    def margins(self, form):
        at = form.moved(self.places, self.normals, self.cosine)
        return self.looked_up.between_texels(at) if form.linear else self.looked_up.margins(at)

    def _note(self, form, values, inside):
        wrong = ((values + form.bias(self.cosine) >= 0) != self.lit)[inside]
        form = replace(form, wrong=float(wrong.mean()) if len(wrong) else 0.0, known=self._is_known(form))
        self.tried.append(form)
        return form

    def _is_known(self, form):
        own = self.constants if form.angle == "none" else self.factors
        pairs = [(form.constant, own), (form.low, self.constants), (form.high, self.constants), (form.offset, self.lengths)]
        return all(not n or any(abs(abs(n) - k) <= 1e-6 * k for k in among) for n, among in pairs)

    def _rank(self, form):
        """What is taken of forms that give the picture alike, smallest first: a constant that the shader is given before a factor of the
        angle, and that before a number that stands somewhere in its text."""
        given = not form.constant or any(abs(abs(form.constant) - k) <= 1e-6 * k for k in self.given)
        usual = self.usual.index(form.angle) if form.angle != "none" else 3
        is_limited = form.high is not None if form.angle == "tangent" else form.low is not None
        group = (0 if given else 2) if form.is_constant else 1 if given or form.angle != "none" else 3
        return not form.known, group, usual, form.angle != "none" and not is_limited, form.parts, form.wrong

    def _constant(self, form, values, inside):
        """The form with the constant that gives most of the picture."""
        values_, lit = values[inside], self.lit[inside]
        tried = []
        for among in (self.given, self.constants):  # numbers that the shader is given before those of its text
            c, wrong, _ = lookup.best_constant(values_, lit, among)
            tried.append((wrong, len(tried), c))
        nearly = min(tried)[0] + NEARLY
        found = next((wrong, c) for wrong, _, c in tried if wrong <= nearly)
        if not found[1]:  # none is taken where it is nearly as good; one that the shader is given needs less to speak for it
            own = min(((float(np.mean((values_ + c >= 0) != lit)), c) for c in self.given[:20]), default=found)
            found = own if len(lit) and own[0] < found[0] - OF_GIVEN else found
        return self._note(replace(form, constant=found[1]), values, inside)

    def _angles(self, form, values, inside):
        v, lit, cosine = values[inside], self.lit[inside], self.cosine[inside]
        numbers = self.constants
        for name, of in ANGLES.items():
            factor = of(cosine)
            free, _, _ = lookup.best_constant(v / np.maximum(factor, 1e-3), lit)
            ranked = sorted({free, *self.factors} - {0.0}, key=lambda c: np.mean((v + c * factor >= 0) != lit))
            for c in ranked[:12]:
                one = replace(form, constant=c, angle=name)
                unlimited = self._note(one, values, inside)
                lows = [k for k in numbers if k < c * factor.max()]
                for low in lows:
                    self._limited(replace(one, low=low), low, unlimited, values, inside)
                for high in [k for k in numbers if k > 0.2 * c]:
                    self._limited(replace(one, high=high), high, unlimited, values, inside)

    def _limited(self, form, limit, unlimited, values, inside):
        """A form with a limit; where that alone decides the picture as well, and the angle does not, it is a constant."""
        found = self._note(form, values, inside)
        if self.is_thorough:  # sure pixels alone do not tell
            return
        alone = self._note(Form(constant=limit, linear=form.linear), values, inside)
        if alone.wrong <= found.wrong < unlimited.wrong:
            self.tried.remove(found)

    def _offsets(self, form):
        texel = np.sqrt(np.nanmedian(self.looked_up.texel_areas(self.places)))
        known = [k for k in self.lengths if 0.05 * texel < k < 20 * texel]
        for angle in ("none", "sine", "one_minus_cosine"):
            best = None
            for k in sorted({*known, *(texel * 2.0 ** np.arange(-3, 4, 0.5))}):
                one = replace(form, offset=float(k), offset_angle=angle, constant=0.0)
                values, inside = self.margins(one)
                own = (self._note(replace(one, constant=c), values, inside) for c in self.given[:8])
                for found in (self._note(one, values, inside), *own, self._constant(one, values, inside)):
                    best = found if best is None or found.wrong < best.wrong else best
            for k in best.offset * np.linspace(0.75, 1.4, 14):
                one = replace(best, offset=float(k))
                self._constant(one, *self.margins(one))

    def best(self, thorough=False):
        """The Forms that give the picture alike, of each kind the one that is taken first; the first of all first. `thorough`: all that come near
        it, of which something else has to tell the right one."""
        starts, self.is_thorough = [], thorough
        for linear in ((True, False) if self.linear else (False,)):
            form = Form(linear=linear)
            values, inside = self.margins(form)
            starts.append((self._constant(form, values, inside), values, inside))
        constant, values, inside = min(starts, key=lambda one: one[0].wrong)
        self.tried = [constant]
        enough = NEARLY + 2 / max(int(inside.sum()), 1)
        if thorough or self._rank(constant)[:2] != (False, 0) or constant.wrong > enough:
            form = replace(constant, constant=0.0)
            for c in self.constants if thorough else self.given:
                self._note(replace(form, constant=c), values, inside)
            self._angles(form, values, inside)
            self._offsets(form)
        least = min(one.wrong for one in self.tried)
        if thorough:
            return sorted(dict.fromkeys(one for one in self.tried if one.wrong <= least + NEAR), key=self._rank)[:MOST_FORMS]
        alike = [one for one in self.tried if one.wrong <= least + enough + (0 if one.is_constant else OF_NORMALS)]
        kinds = {}
        for one in sorted(alike, key=self._rank):
            kinds.setdefault((one.angle, one.offset_angle, bool(one.offset), bool(one.constant), one.known), one)
        return list(kinds.values())


def find(looked_up, places, normals_, lit, numbers, linear, thorough=False):
    """The Forms that the test of a LookedUp map may have, the likeliest first. `lit`: whether the light reaches each of the places; `numbers`:
    those of the frame; `linear`: whether its sampler interpolates, and compares nothing; `thorough`: as Search.best()."""
    return Search(looked_up, places, normals_, lit, numbers, linear).best(thorough)
