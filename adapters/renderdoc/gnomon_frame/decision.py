"""How the frame's own test decides, found from the picture: which cascade, which constant, which filter."""
from dataclasses import dataclass, replace

import numpy as np

from . import forms, lookup, moments

LARGEST = 0.1  # of stored depths: what a bias of cascades is not larger than
FEW_OF_A_LAYER = 5e-3  # share of the pixels that tell no constant of a layer's own
PARTLY = 2e-3  # share of partly lit pixels, below which there is no filter
SURELY = 0.9  # correlation of partly lit pixels with an average of comparisons from which on that is the filter
UNKNOWN = 5e-3  # by so much more the picture must speak for numbers that the frame has not
ALIKE = 3e-4  # correlations of forms with the picture that differ by less tell none of them
UNDERSTOOD = 0.95  # share of the pixels that a test must decide as the picture has them, else it is another test


@dataclass
class Test:
    """How the frame's own test decides, as far as the picture tells."""

    selection: lookup.Selection
    # Share of sure pixels that the test as described decides as the picture has them; None where the map is no projection, or an exponential one.
    agreement: float | None
    without_constant: float  # the same before the reader's own bias was looked for
    partly_lit: float  # share of pixels between lit and shadowed
    radius: float | None  # of the filter, texels; None where there is none
    exponent: lookup.Exponent | None  # of an exponential map
    fitted: moments.Fit | None = None  # of a map of moments
    form: forms.Form | None = None  # of a map of one layer
    unread: str = ""  # why the map is not believed


def _is_looked_up_in(selection, k, distance):
    """Whether a place of this distance from the camera is looked up in layer k alone; of layers without distances all are in the first."""
    if selection.by == "first":
        return k == 0
    limits, blends = (0.0, *selection.limits), selection.blends or (0.0,) * len(selection.limits)
    return (distance > limits[k]) & (distance < limits[k + 1] - blends[k])


def _moment_test(layers, pixels, numbers, fitted):
    """The test of a map of moments: which layer is read, and how the picture agrees."""
    value, places = pixels.visibility[pixels.asked], pixels.positions[pixels.asked]
    answers = []
    for layer in layers:
        layer.constant = fitted.constant
        averages, inside = lookup.averages(layer, places, "drawn")
        light = fitted.light(averages, lookup.texel_places(layer, places)[2])
        answers.append(lookup.Margins(np.where(inside, light - 0.5, 1.0), inside, None, None))
    sure = np.abs(value - 0.5) > 0.1
    keys = {"view_z": -places[:, 2], "distance": np.linalg.norm(places, axis=1)} if layers[0].place.apex is None else {}
    of_sure = [lookup.Margins(one.values[sure], one.inside[sure], None, None) for one in answers]
    selection, _ = lookup.choose_layers(of_sure, value[sure] > 0.5, {name: key[sure] for name, key in keys.items()}, numbers.all)
    partly = float(((value > lookup.SURE) & (value < 1 - lookup.SURE)).mean()) if len(value) else 0.0
    held = np.any([one.inside for one in of_sure], axis=0)
    right = (of_sure[0].values >= 0) == (value[sure] > 0.5) if len(layers) == 1 else np.full(held.shape, 1 - selection.share)
    agreement = float(right[held].mean()) if held.any() else 1.0
    return Test(selection, agreement, agreement, partly, 1.5, None, fitted)


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
    elif test.agreement is not None and test.agreement < UNDERSTOOD:
        why = f"the test as found decides {100 * test.agreement:.1f} % of the pixels within the map as the picture has them"
    if why:
        for layer in layers:
            layer.matrix = None
        test.unread = why


@dataclass
class _Kernel:
    """Comparisons of how many texels give partly lit pixels, and how well."""

    score: float = 0.0  # correlation with the picture
    reach: int | None = None  # texels to either side; None where no average fits
    light: np.ndarray | None = None  # what the average makes of each place


def _kernel(layer, places, bias, value, bilinear):
    """The _Kernel of partly lit places. The picture's encoding may be misread, which bends the values: their order stays."""
    best = _Kernel()
    for reach in range(4) if bilinear else range(1, 4):
        light = lookup.filtered(layer, places, bias, reach, bilinear)
        score = float(np.corrcoef(light, value)[0, 1]) if np.ptp(light) > 0 and np.ptp(value) > 0 else 0.0
        if score > best.score:
            best = _Kernel(score, reach, light)
    return best


def _by_filter(layer, alike, places, normals, pixels, partly, bilinear):
    """(the form, how far its filter reads, texels, or None) of those that decide the sure pixels alike: that of whose comparisons partly lit
    pixels are an average. Of a picture that does not say how it is encoded that average tells."""
    if partly.sum() < lookup.FEW:
        return alike[0], None
    few = np.flatnonzero(partly)[::max(1, int(partly.sum()) // 5000)]
    of_few = lambda values: values[pixels.asked][few]
    cosine = forms.cosines(layer.place, places[few], normals[few])
    tried = []
    for form in alike:
        moved, bias = form.moved(places[few], normals[few], cosine), form.bias(cosine)
        tried.append((_kernel(layer, moved, bias, of_few(pixels.visibility), bilinear), moved, bias))
    scores = [kernel.score - (0 if form.known else UNKNOWN) for (kernel, _, _), form in zip(tried, alike)]
    best = next(k for k, score in enumerate(scores) if score >= max(scores) - ALIKE)
    kernel, moved, bias = tried[best]
    if kernel.score < SURELY:
        reach = lookup.filter_radius(layer, moved, bias)
        return alike[best], None if reach is None else float(reach) if bilinear else reach + 0.5
    off = lambda values: float(np.sqrt(np.mean((of_few(values) - kernel.light) ** 2)))
    if pixels.otherwise is not None and off(pixels.otherwise) < 0.7 * off(pixels.visibility):
        pixels.visibility, pixels.otherwise = pixels.otherwise, pixels.visibility
        pixels.is_read_otherwise = True
    return alike[best], kernel.reach + (1.0 if bilinear else 0.5)


def _shared_constant(margins, lit, keys, numbers):
    """The constant of all layers with which some choice of them gives most of the picture: without it a choice is guessed from acne."""
    few = slice(None, None, max(1, len(lit) // 8000))
    some = [lookup.Margins(m.values[few], m.inside[few], None, None) for m in margins]
    keys = {name: key[few] for name, key in keys.items()}
    tried = sorted({0.0, *(abs(n) for n in (*numbers.given, *numbers.alone) if 0 < abs(n) < LARGEST), *10.0 ** np.arange(-5, -1.4, 0.5)})
    share = {c: lookup.choose_layers([replace(m, values=m.values + c) for m in some], lit[few], keys, numbers.all)[0].share for c in tried}
    own = {0.0, *(abs(n) for n in numbers.given)}
    return min((c for c in tried if share[c] <= min(share.values()) + 0.1 * lookup.NOISE), key=lambda c: (c not in own, c))


def find_test(found, layers, pixels, numbers, exponent, fitted=None):
    """The choice of cascades, the reader's own bias and the filter's reach, found from the picture."""
    if layers[0].matrix is None:
        return Test(lookup.Selection("first", (), 0.0), None, 0.0, 0.0, None, None)
    if fitted:
        return _moment_test(layers, pixels, numbers, fitted)
    value = pixels.visibility[pixels.asked]
    places = pixels.positions[pixels.asked]
    sure = (value < lookup.SURE) | (value > 1 - lookup.SURE)
    lit = value[sure] > 0.5
    at = places[sure]
    margins = [lookup.margins(layer, at) for layer in layers]
    keys = {"view_z": -at[:, 2], "distance": np.linalg.norm(at, axis=1)} if layers[0].place.apex is None else {}
    of_choice = _shared_constant(margins, lit, keys, numbers) if len(layers) > 1 and exponent is None and not layers[0].half else 0.0
    selection, chosen = lookup.choose_layers([replace(m, values=m.values + of_choice) for m in margins], lit, keys, numbers.all)
    before = selection.share
    right = (np.array(chosen < 0) & lit).astype(float)
    form, of_normals = None, forms.normals(pixels.positions, pixels.drawn)[pixels.asked]
    if layers[0].half:  # one test for both halves
        all_values = np.choose(np.maximum(chosen, 0), [m.values for m in margins])
        constant, _, _ = lookup.best_constant(all_values[chosen >= 0], lit[chosen >= 0], numbers.all)
    for k, layer in enumerate(layers):
        mine = chosen == k
        if layers[0].half:
            layer.constant = constant
        elif exponent is None and len(layers) == 1:
            alike = forms.find(layer, at, of_normals[sure], lit, numbers, found.sampler == "linear" and not layer.is_blurred)
            form, radius = _by_filter(layer, alike, places, of_normals, pixels, ~sure, found.is_bilinear)
            if pixels.is_read_otherwise:
                found.notes.append("the picture's numbers are read as linear ones, not as sRGB: partly lit pixels are averages of comparisons then")
            layer.constant = form.constant
            right[mine] = 1 - form.wrong
            continue
        elif exponent is None:  # whose soft shadows have no threshold
            layer.constant, least, _ = lookup.best_constant(margins[k].values[mine], lit[mine], numbers.all)
            shared = np.mean((margins[k].values[mine] + of_choice >= 0) != lit[mine]) if mine.any() else 0.0
            if mine.sum() < FEW_OF_A_LAYER * len(mine) or shared <= least + 0.1 * lookup.NOISE:
                layer.constant = of_choice  # what all layers share, where this one tells no other
        right[mine] = (margins[k].values[mine] + layer.constant >= 0) == lit[mine]
    blended, distance = np.zeros(len(value), bool), None
    bilinear = found.is_bilinear
    if selection.by != "first":
        answers = [lookup.answer(layer, places, bilinear) for layer in layers]
        distance = {"view_z": -places[:, 2], "distance": np.linalg.norm(places, axis=1)}[selection.by]
        selection, blended = lookup.find_blends(answers, value, distance, selection)
    unsure = ~sure & ~blended
    partly = float(unsure.mean()) if len(sure) else 0.0
    if form:
        radius = radius if partly > PARTLY else None
    else:
        # Where layers blend their own soft edges are partly lit by that as well: the sampler says that it reads four texels.
        radius = 1.0 if bilinear and blended.any() else None
    if not form and partly > PARTLY:
        reaches = (lookup.filter_radius(layer, places[unsure & _is_looked_up_in(selection, k, distance)]) for k, layer in enumerate(layers))
        reach = next((reach for reach in reaches if reach is not None), None)
        radius = radius if reach is None else float(reach) if bilinear else reach + 0.5
    held = np.any([m.inside for m in margins], axis=0)  # what is made of places outside is another matter
    agreement = None if exponent else float(right[held].mean()) if held.any() else 1.0
    return Test(selection, agreement, 1 - before, partly, radius, exponent, form=form)
