"""How the frame's own test decides, found from the picture: which cascade, which constant, which filter."""
from dataclasses import dataclass, replace

import numpy as np

from . import fit, forms, lookup, moments

LARGEST = 0.1  # of stored depths: what a bias of cascades is not larger than
FEW_OF_A_LAYER = 5e-3  # share of the pixels that tell no constant of a layer's own
PARTLY = 2e-3  # share of partly lit pixels, below which there is no filter
SURELY = 0.9  # correlation of partly lit pixels with an average of comparisons from which on that is the filter, or share of them that it makes
SAME = 0.015  # four steps of eight bits
UNKNOWN = 5e-3  # by so much more the picture must speak for numbers that the frame has not
ALIKE = 3e-4  # correlations of forms with the picture that differ by less tell none of them
STRETCHED = 1e-3  # of a map's width and height: what a reader widens them by is said
UNDERSTOOD = 0.95  # share of the pixels that a test must decide as the picture has them, else it is another test


@dataclass
class Test:
    """How the frame's own test decides, as far as the picture tells."""

    selection: lookup.Selection
    # Share of sure pixels that the test as described decides as the picture has them; None where the map is no projection, or an exponential one.
    agreement: float | None
    partly_lit: float  # share of pixels between lit and shadowed
    radius: float | None  # of the filter, texels; None where there is none
    exponent: lookup.Exponent | None  # of an exponential map
    fitted: moments.Fit | None = None  # of a map of moments
    form: forms.Form | None = None  # of a map of one layer
    unread: str = ""  # why the map is not believed


def _moment_test(layers, pixels, numbers, fitted):
    """The test of a map of moments: which layer is read, and how the picture agrees."""
    places = _Places.of(layers, pixels)
    lights = []
    for layer in layers:
        layer.constant = fitted.constant
        averages, inside = lookup.averages(layer, places.at, "drawn")
        lights.append(np.where(inside, fitted.light(averages, lookup.texel_places(layer, places.at)[2]), 1.0))
    inside = [lookup.texel_places(layer, places.at)[3] for layer in layers]
    sure = np.abs(places.value - 0.5) > 0.1
    of_sure = [lookup.Margins(light[sure] - 0.5, held[sure], None, None) for light, held in zip(lights, inside)]
    some = places.only(sure)
    options = lookup.choices(of_sure, some.value > 0.5, some.keys, numbers.all, numbers.vectors, some.told)
    index = {one: lookup.index_of(one, inside, places.keys) for one in options}
    light = {one: np.where(k < 0, 1.0, np.take_along_axis(np.array(lights), np.maximum(k, 0)[None], 0)[0]) for one, k in index.items()}
    off = {one: float(np.sqrt(np.mean((light[one] - places.value) ** 2))) if len(places.at) else 0.0 for one in options}
    selection = next(one for one in options if off[one] <= min(off.values()) + 1e-4)
    held = np.any(inside, axis=0) & sure
    right = (light[selection] >= 0.5) == (places.value > 0.5)
    return Test(selection, float(right[held].mean()) if held.any() else 1.0, _partly_lit(places.value), 1.5, None, fitted)


def _partly_lit(value):
    return float(((value > lookup.SURE) & (value < 1 - lookup.SURE)).mean()) if len(value) else 0.0


def believe(found, layers, test):
    """Takes a map back that is not understood: the picture then says where the shadow is wrong, and not why."""
    if layers[0].matrix is None:
        return
    why = ""
    if test.fitted and not test.fitted.is_believed:
        why = (f"its texels are those of {test.fitted.content.kind}, and no constants of that give the picture: "
               f"{100 * test.fitted.wrong:.1f} % of the pixels are off by more than {moments.OFF:g}")
    elif any(layer.is_colour and layer.content is None and not (0 <= layer.texels.min() <= layer.texels.max() <= 1) for layer in layers):
        why = "its colours are no depth, distance, power or exponential of these"
    elif test.exponent is None and any(layer.is_colour and layer.content is None and layer.is_blurred for layer in layers):
        why = "what its casters leave is no depth, and passes of its own make something else of it before it is read"
    elif any(fit.is_warped(layer.matrix) for layer in layers):
        why = "a sun's map that is warped towards the eye, which a capture's matrix cannot say"
    elif test.agreement is not None and test.agreement < UNDERSTOOD:
        why = f"the test as found decides {100 * test.agreement:.1f} % of the pixels within the map as the picture has them"
    stretch = layers[0].reader.stretch if why and layers[0].reader else (1.0, 1.0)
    if max(abs(one - 1) for one in stretch) > STRETCHED:
        why += (f". Its reader widens x by {stretch[0]:.4g} and y by {stretch[1]:.4g} against the matrix that the casters were drawn with: two aspects, of the map "
                "and of the window, perhaps")
    if why:
        for layer in layers:
            layer.matrix = None
        test.unread = why


@dataclass
class _Kernel:
    """Comparisons of how many texels give partly lit pixels, and how well."""

    score: float = 0.0  # correlation with the picture
    exact: float = 0.0  # share of the places of which it makes what they have: of acne's greys, which are nearly all alike, no correlation tells
    reach: int | None = None  # texels to either side; None where no average fits
    light: np.ndarray | None = None  # what the average makes of each place

    @property
    def is_sure(self):
        return max(self.score, self.exact) >= SURELY


def _kernel(looked_up, places, bias, value, sampler):
    """The _Kernel of partly lit places. The picture's encoding may be misread, which bends the values: their order stays."""
    best = _Kernel()
    for reach, step in [(reach, 1) for reach in range(4) if sampler == "compares" or reach] + [(1, 2)]:
        light = looked_up.filtered(places, bias, reach, sampler, step)
        score = float(np.corrcoef(light, value)[0, 1]) if np.ptp(light) > 0 and np.ptp(value) > 0 else 0.0
        same = float(np.mean(np.abs(light - value) < SAME)) if len(value) else 0.0
        if score > best.score and (score >= SURELY or same >= best.exact):
            best = _Kernel(score, same, reach * step, light)
    return best


def _few(partly):
    """Some of the places that are partly lit."""
    return np.flatnonzero(partly)[::max(1, int(partly.sum()) // 5000)]


def _with_kernels(looked_up, tried, places, normals, value, bilinear):
    """(the form, its _Kernel) of the forms `tried`, likeliest first, of whose comparisons partly lit places are an average."""
    cosine = forms.cosines(looked_up.layers[0].place, places, normals)
    of = lambda form: _kernel(looked_up, form.moved(places, normals, cosine), form.bias(cosine), value, _sampler(form, bilinear))
    kernels = [of(form) for form in tried]
    by = "score" if any(kernel.score >= SURELY for kernel in kernels) else "exact"
    scores = [getattr(kernel, by) - (0 if form.known else UNKNOWN) for form, kernel in zip(tried, kernels)]
    best = next(k for k, score in enumerate(scores) if score >= max(scores) - ALIKE)
    return tried[best], kernels[best]


def _sampler(form, bilinear):
    return "interpolates" if form.linear else "compares" if bilinear else "nearest"


def _by_filter(looked_up, alike, places, normals, pixels, partly, bilinear, more=lambda: []):
    """(the form, how far its filter reads, texels, or None) of those that decide the sure pixels alike: that of whose comparisons partly lit
    pixels are an average. `more`: forms to be tried where it is of none. Of a picture that does not say how it is encoded that average tells."""
    if partly.sum() < lookup.FEW:
        return alike[0], None
    few = _few(partly)
    of_few = lambda values: values[pixels.asked][few]
    looked_up = looked_up.of(few)
    alike = [*alike, *(replace(form, linear=False) for form in alike if form.linear)]
    form, kernel = _with_kernels(looked_up, alike, places[few], normals[few], of_few(pixels.visibility), bilinear)
    if not (kernel.is_sure and form.known) and (others := more()):
        some = slice(None, None, max(1, len(few) // 1000))
        other, _ = _with_kernels(looked_up.of(some), others, places[few][some], normals[few][some], of_few(pixels.visibility)[some], bilinear)
        form, kernel = _with_kernels(looked_up, [form, other], places[few], normals[few], of_few(pixels.visibility), bilinear)
    beside = 0.5 if _sampler(form, bilinear) == "nearest" else 1.0
    if not kernel.is_sure:
        cosine = forms.cosines(looked_up.layers[0].place, places[few], normals[few])
        reach = looked_up.filter_radius(form.moved(places[few], normals[few], cosine), form.bias(cosine))
        return form, None if reach is None else float(reach) if bilinear else reach + beside
    off = lambda values: float(np.sqrt(np.mean((of_few(values) - kernel.light) ** 2)))
    if pixels.otherwise is not None and off(pixels.otherwise) < 0.7 * off(pixels.visibility):
        pixels.visibility, pixels.otherwise = pixels.otherwise, pixels.visibility
        pixels.is_read_otherwise = True
    return form, kernel.reach + beside


def _shared_constant(margins, sure, numbers):
    """The constant of all layers with which some choice of them gives most of the picture: without it a choice is guessed from acne."""
    few = slice(None, None, max(1, len(sure.at) // 8000))
    some = [lookup.Margins(m.values[few], m.inside[few], None, None) for m in margins]
    sure = sure.only(few)
    tried = sorted({0.0, *(abs(n) for n in (*numbers.given, *numbers.alone) if 0 < abs(n) < LARGEST), *10.0 ** np.arange(-5, -1.4, 0.5)})
    share = {c: lookup.choose_layers([replace(m, values=m.values + c) for m in some], sure.value > 0.5, sure.keys, numbers.all, numbers.vectors,
                                     sure.told)[0].share for c in tried}
    own = {0.0, *(abs(n) for n in numbers.given)}
    return min((c for c in tried if share[c] <= min(share.values()) + 0.1 * lookup.NOISE), key=lambda c: (c not in own, c))


@dataclass
class _Places:
    """The compared pixels' places, and the picture of them."""

    at: np.ndarray
    normals: np.ndarray
    value: np.ndarray
    told: np.ndarray  # whether the map decides the light there
    keys: dict  # by which a layer of several may be chosen

    @classmethod
    def of(cls, layers, pixels):
        at, value = pixels.positions[pixels.asked], pixels.visibility[pixels.asked]
        keys = {"view_z": -at[:, 2], "distance": np.linalg.norm(at, axis=1)} if layers[0].place.apex is None else {}
        return cls(at, forms.normals(pixels.positions, pixels.drawn)[pixels.asked], value, pixels.told[pixels.asked], keys)

    def only(self, kept):
        return _Places(self.at[kept], self.normals[kept], self.value[kept], self.told[kept], {name: key[kept] for name, key in self.keys.items()})

    @property
    def sure(self):
        return (self.value < lookup.SURE) | (self.value > 1 - lookup.SURE)

    def looked_up(self, layers, selection):
        return lookup.LookedUp(layers, lookup.index_of(selection, [lookup.texel_places(layer, self.at)[3] for layer in layers], self.keys))


def _margins_of(layers, places, form):
    """Margins of every layer with the form's bias in them."""
    cosine = forms.cosines(layers[0].place, places.at, places.normals)
    moved, bias = form.moved(places.at, places.normals, cosine), form.bias(cosine)
    return [replace(one, values=one.values + bias) for one in (lookup.margins(layer, moved) for layer in layers)]


def _chosen(layers, places, form, numbers, bilinear):
    """The Selection of layers: what gives the sure pixels; of those that do so alike, the one of whose texels partly lit pixels are averages."""
    sure, unsure = places.only(places.sure), places.only(_few(~places.sure))
    options = lookup.choices(_margins_of(layers, sure, form), sure.value > 0.5, sure.keys, numbers.all, numbers.vectors, sure.told)
    least = min(one.share for one in options)
    alike = [one for one in options if one.share <= least + 0.2 * lookup.NOISE]
    near = [one for one in options if one.share <= least + lookup.NOISE]
    if len(near) > 1 and len(unsure.at) >= lookup.FEW:
        cosine = forms.cosines(layers[0].place, unsure.at, unsure.normals)
        moved, bias = form.moved(unsure.at, unsure.normals, cosine), form.bias(cosine)
        scores = [_kernel(unsure.looked_up(layers, one), moved, bias, unsure.value, _sampler(form, bilinear)).score for one in near]
        if max(scores) >= SURELY:
            return next(one for one, score in zip(near, scores) if score >= max(scores) - ALIKE)
    stand_together = [one for one in alike if one.limits and any(set(one.limits) - {np.inf} <= set(v) for v in numbers.vectors)]
    return (stand_together or alike)[0]


def _forms(found, layers, sure, selection, numbers, thorough=False):
    """The Forms that decide the sure pixels alike, the likeliest first."""
    linear = found.sampler == "linear" and not any(layer.is_blurred for layer in layers)
    return forms.find(sure.looked_up(layers, selection), sure.at, sure.normals, sure.value > 0.5, numbers, linear, thorough)


def _of_layers(found, layers, places, numbers):
    """(the Selection, the Forms that decide the sure pixels alike) of a map of one layer or several, whose bias they share."""
    sure = places.only(places.sure)
    shared = _shared_constant([lookup.margins(layer, sure.at) for layer in layers], sure, numbers) if len(layers) > 1 else 0.0
    selection = _chosen(layers, places, forms.Form(shared), numbers, found.is_bilinear)
    alike = _forms(found, layers, sure, selection, numbers)
    if len(layers) > 1:  # once more, now that its bias is known
        before, selection = selection, _chosen(layers, places, alike[0], numbers, found.is_bilinear)
        if (selection.by, selection.limits) != (before.by, before.limits):
            alike = _forms(found, layers, sure, selection, numbers)
    return selection, alike


def _of_each_layer(looked_up, sure, numbers):
    """(share of the sure pixels that a constant for each layer decides otherwise, those constants)."""
    values, inside = looked_up.margins(sure.at)
    lit, wrong, constants = sure.value > 0.5, 0, []
    for k in range(len(looked_up.layers)):
        mine = (looked_up.index == k) & inside
        constant, share, _ = lookup.best_constant(values[mine], lit[mine], numbers.all)
        constants.append(constant if mine.sum() >= FEW_OF_A_LAYER * len(mine) else None)
        wrong += share * mine.sum()
    return wrong / max(int(inside.sum()), 1), constants


def _one_constant(layers, places, numbers, exponent):
    """The Selection where no form of a bias is asked for: a paraboloid's halves, which share a constant, and exponential maps, which have none."""
    sure = places.only(places.sure)
    lit, margins = sure.value > 0.5, [lookup.margins(layer, sure.at) for layer in layers]
    selection, chosen = lookup.choose_layers(margins, lit, sure.keys, numbers.all)
    if layers[0].half:
        values = np.choose(np.maximum(chosen, 0), [m.values for m in margins])
        constant, _, _ = lookup.best_constant(values[chosen >= 0], lit[chosen >= 0], numbers.all)
        for layer in layers:
            layer.constant = constant
    return selection


def find_test(found, layers, pixels, numbers, exponent, fitted=None):
    """The choice of cascades, the reader's own bias and the filter's reach, found from the picture."""
    if layers[0].matrix is None:
        return Test(lookup.Selection("first", (), 0.0), None, 0.0, None, None)
    if fitted:
        return _moment_test(layers, pixels, numbers, fitted)
    places, bilinear = _Places.of(layers, pixels), found.is_bilinear
    sure, alike, constants = places.sure, None, [0.0] * len(layers)
    if layers[0].half or exponent is not None:
        selection = _one_constant(layers, places, numbers, exponent)
        constants = [layer.constant for layer in layers]
    else:
        selection, alike = _of_layers(found, layers, places, numbers)
        least, of_each = _of_each_layer(places.only(sure).looked_up(layers, selection), places.only(sure), numbers)
        constants = [alike[0].constant] * len(layers)
        if len(layers) > 1 and least < alike[0].wrong - 0.5 * lookup.NOISE:
            constants = [alike[0].constant if one is None else one for one in of_each]
            alike = None
    for layer, constant in zip(layers, constants):
        layer.constant = constant
    form = alike[0] if alike else forms.Form()
    cosine = forms.cosines(layers[0].place, places.at, places.normals)
    moved, bias = form.moved(places.at, places.normals, cosine), form.bias(cosine)
    blended = np.zeros(len(places.at), bool)
    if selection.by != "first":
        answers = [lookup.answer(layer, moved, bilinear, bias if alike else None) for layer in layers]
        selection, blended = lookup.find_blends(answers, places.value, places.keys[selection.by], selection)
    unsure = ~sure & ~blended
    partly = float(unsure.mean()) if len(sure) else 0.0
    looked_up, radius = places.looked_up(layers, selection), None
    # Where layers blend their own soft edges are partly lit by that as well: the sampler says that it reads four texels.
    of_blends = 1.0 if bilinear and blended.any() else None
    if alike:
        more = lambda: _forms(found, layers, places.only(sure), selection, numbers, thorough=True)
        form, radius = _by_filter(looked_up, alike, places.at, places.normals, pixels, unsure, bilinear, more)
        if pixels.is_read_otherwise:
            read = ("sRGB", "linear ones") if numbers.encodes is False else ("linear ones", "sRGB")
            found.notes.append(f"the picture's numbers are read as {read[0]}, not as {read[1]}: partly lit pixels are averages of comparisons then")
        for layer in layers:
            layer.constant = form.constant
        radius = radius if partly > PARTLY or bilinear else None  # a sampler that weighs comparisons says so itself
    elif partly > PARTLY:
        each = np.array([layer.constant for layer in layers])[looked_up.index]
        reach = looked_up.of(unsure).filter_radius(places.at[unsure], each[unsure])
        radius = None if reach is None else float(reach) if bilinear else reach + 0.5
    radius = radius or of_blends
    agreement = None if exponent else _agreement(looked_up.of(sure), places.only(sure), form if alike else None)
    return Test(selection, agreement, partly, radius, exponent, form=form if alike else None)


def _agreement(looked_up, sure, form):
    """The share of the sure pixels within the map that the test decides as the picture has them."""
    if form is None:
        values, inside = looked_up.margins(sure.at)
        values = values + np.array([layer.constant for layer in looked_up.layers])[looked_up.index]
    else:
        cosine = forms.cosines(looked_up.layers[0].place, sure.at, sure.normals)
        moved = form.moved(sure.at, sure.normals, cosine)
        values, inside = looked_up.between_texels(moved) if form.linear else looked_up.margins(moved)
        values = values + form.bias(cosine)
    held = inside | (looked_up.index < 0) & np.any([lookup.texel_places(layer, sure.at)[3] for layer in looked_up.layers], axis=0)
    right = np.where(looked_up.index < 0, ~sure.told, values >= 0) == (sure.value > 0.5)
    return float(right[held].mean()) if held.any() else 1.0
