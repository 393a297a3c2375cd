"""Which mesh of the camera's pass is which of the light's: the same vertices in the same order, moved by one matrix for all.

Several objects may share one mesh, drawn in another order in each pass. A pair is then supposed, which gives the light's matrix,
and holds where that matrix brings the other casters to where they were drawn.
"""
import numpy as np

from . import fit

TRIED = 6  # casters from which a matrix is supposed
CLOSE = 0.01  # of the largest coordinate: two objects that share a mesh lie farther apart than a bias moves one
SAMPLES = 16  # vertices that are compared


def _sampled(points):
    return points[:: max(1, len(points) // SAMPLES)][:SAMPLES]


def _distance(matrix, view, clip):
    off = fit.homogeneous(_sampled(view)) @ matrix.T - _sampled(clip)
    return float(np.abs(off).max() / max(np.abs(clip).max(), 1e-30))


def _best(matrix, clip, options, views):
    """(distance, option) of the nearest camera mesh."""
    return min(((_distance(matrix, views[k], clip), k) for k in options), default=(np.inf, None))


def _supposed(casters, options, views):
    """The matrix that most casters agree with, or None where each has one camera mesh at most, or none is solid."""
    if all(len(o) <= 1 for o in options):
        return None
    best, most = None, 0
    order = sorted((k for k in range(len(casters)) if options[k]), key=lambda k: (len(options[k]), -len(casters[k][1])))
    for k in order[:TRIED]:
        for option in options[k]:
            found = fit.fit_light(views[option], casters[k][1])
            if found.rank < 4 or found.residuals.max() > CLOSE:
                continue
            agree = sum(_best(found.matrix, clip, options[i], views)[0] < CLOSE for i, (_, clip) in enumerate(casters))
            if agree > most:
                best, most = found.matrix, agree
        if most == len(casters):
            break
    return best


def pair(casters, cameras):
    """For each caster (source, clip positions) the place of its camera mesh among `cameras` [(source, positions in view space)], or
    None where the camera does not draw it."""
    by_source = {}
    for k, (source, _) in enumerate(cameras):
        by_source.setdefault(source, []).append(k)
    views = [view for _, view in cameras]
    options = [[k for k in by_source.get(source, []) if len(views[k]) == len(clip)] for source, clip in casters]
    matrix = _supposed(casters, options, views)
    if matrix is None:
        return [o[0] if o else None for o in options]
    nearest = [_best(matrix, clip, o, views) for (_, clip), o in zip(casters, options)]
    return [option if off < CLOSE else None for off, option in nearest]
