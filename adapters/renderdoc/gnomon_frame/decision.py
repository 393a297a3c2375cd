"""How the frame's own test decides, found from the picture: which cascade, which constant, which filter."""
from dataclasses import dataclass

import numpy as np

from . import lookup


@dataclass
class Test:
    """How the frame's own test decides, as far as the picture tells."""

    selection: lookup.Selection
    agreement: float | None  # None where the map is no projection, or an exponential one; share of sure pixels that the test as described decides as the picture has them
    without_constant: float  # the same before the reader's own bias was looked for
    partly_lit: float  # share of pixels between lit and shadowed
    radius: float | None  # of the filter, texels; None where there is none
    exponent: lookup.Exponent | None  # of an exponential map


def _is_looked_up_in(selection, k, distance):
    """Whether a place of this distance from the camera is looked up in layer k alone; of layers without distances all are in the first."""
    if selection.by == "first":
        return k == 0
    limits, blends = (0.0, *selection.limits), selection.blends or (0.0,) * len(selection.limits)
    return (distance > limits[k]) & (distance < limits[k + 1] - blends[k])


def find_test(found, layers, pixels, numbers, exponent):
    """The choice of cascades, the reader's own bias and the filter's reach, found from the picture."""
    if layers[0].matrix is None:
        return Test(lookup.Selection("first", (), 0.0), None, 0.0, 0.0, None, None)
    value = pixels.visibility[pixels.asked]
    places = pixels.positions[pixels.asked]
    sure = (value < lookup.SURE) | (value > 1 - lookup.SURE)
    lit = value[sure] > 0.5
    at = places[sure]
    margins = [lookup.margins(layer, at) for layer in layers]
    keys = {"view_z": -at[:, 2], "distance": np.linalg.norm(at, axis=1)} if layers[0].place.apex is None else {}
    selection, chosen = lookup.choose_layers(margins, lit, keys, numbers)
    before = selection.share
    right = np.array(chosen < 0) & lit
    if layers[0].half:  # one test for both halves
        all_values = np.choose(np.maximum(chosen, 0), [m.values for m in margins])
        constant, _, _ = lookup.best_constant(all_values[chosen >= 0], lit[chosen >= 0], numbers)
    for k, layer in enumerate(layers):
        mine = chosen == k
        if layers[0].half:
            layer.constant = constant
        elif exponent is None:  # whose soft shadows have no threshold
            layer.constant, _, _ = lookup.best_constant(margins[k].values[mine], lit[mine], numbers)
        right[mine] = (margins[k].values[mine] + layer.constant >= 0) == lit[mine]
    blended, distance = np.zeros(len(value), bool), None
    bilinear = found.is_bilinear
    if selection.by != "first":
        answers = [lookup.answer(layer, places, bilinear) for layer in layers]
        distance = {"view_z": -places[:, 2], "distance": np.linalg.norm(places, axis=1)}[selection.by]
        selection, blended = lookup.find_blends(answers, value, distance, selection)
    unsure = ~sure & ~blended
    partly = float(unsure.mean()) if len(sure) else 0.0
    # Where layers blend their own soft edges are partly lit by that as well: the sampler says that it reads four texels.
    radius = 1.0 if bilinear and blended.any() else None
    if partly > 2e-3:
        reaches = (lookup.filter_radius(layer, places[unsure & _is_looked_up_in(selection, k, distance)]) for k, layer in enumerate(layers))
        reach = next((reach for reach in reaches if reach is not None), None)
        radius = radius if reach is None else float(reach) if bilinear else reach + 0.5
    agreement = None if exponent else float(right.mean()) if len(right) else 1.0
    return Test(selection, agreement, 1 - before, partly, radius, exponent)
