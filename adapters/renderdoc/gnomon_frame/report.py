"""What was found, in sentences for a person: each finding with how it was found and its residual."""
import numpy as np

from .extract import polygon_offset


def _kind(layers):
    place = layers[0].place
    if place.apex is None:
        return "sun" if len(layers) == 1 else f"sun with {len(layers)} cascades"
    return "spot light" if len(layers) == 1 and not layers[0].distance else f"point light with a map of {len(layers)} parts"


def light_line(number, frame, found, layers):
    """A line of --list."""
    texture = frame.textures[found.passes.texture]
    x, y, width, height = layers[0].state.viewport
    casters = sum(len(layer.events) for layer in layers)
    return (f"light {number}: {_kind(layers)}, map {texture.width} x {texture.height} {texture.format} (texture {texture.id}, {width:.0f} x {height:.0f} "
            f"from {x:.0f}, {y:.0f}), {casters} draws of casters, read by {len(found.passes.readers)} draws from event {found.passes.readers[0].event} on")


def _times(angle):
    return "" if angle == "none" else f" times the {angle.replace('_', ' ')} of the angle to the light"


def _form(form):
    """What is said of the reader's bias and of how it reads."""
    out = []
    limits = [f"at least {form.low:.3g}" if form.low is not None else "", f"at most {form.high:.3g}" if form.high is not None else ""]
    limits = "".join(", " + one for one in limits if one)
    if form.angle != "none":
        out.append(f"the reader's test lets {form.constant:.3g} times the {form.angle.replace('_', ' ')} of the angle between normal and light pass, "
                   f"of stored depth{limits}")
    elif form.constant:
        out.append(f"the reader's test lets {form.constant:.3g} of stored depth pass")
    if form.offset:
        out.append(f"places are moved {form.offset:.3g} world units{_times(form.offset_angle)} along their normals")
    if form.linear:
        out.append("the sampler interpolates depths before they are compared")
    how = "found from the picture" if form.known else ("found from the picture alone: no constant of the frame is that number, so that the bias may "
                                                       "be of another form")
    return [f"{one} ({how})" for one in out[:1]] + out[1:]


def _moments(fitted):
    content = fitted.content
    said = [f"minimum variance {fitted.variance:.3g}" if fitted.variance else "", f"light bleeding reduction {fitted.reduction:.3g}" if fitted.reduction else "",
            f"bias {fitted.constant:.3g}" if fitted.constant else ""]
    of = f" with the exponents {', '.join(f'{one:.3g}' for one in content.exponents)}" if content.exponents else ""
    return (f"the map's texels are those of {content.kind}{of}; its formula gives the picture to {fitted.off:.3f}, root of the mean square"
            + "".join(", " + one for one in said if one))


def findings(frame, found, layers, test):
    """Sentences, the most important first."""
    lens = found.view.lens
    out = []
    texture = frame.textures[found.passes.texture]
    part = "cascade" if layers[0].place.apex is None else "part"
    for k, layer in enumerate(layers):
        which = f"{part} {k + 1}: " if len(layers) > 1 else ""
        how = "the distances that they store are larger" if layer.distance else "their matrix and the reader's differ by that"
        if layer.has_caster_bias:
            out.append(f"{which}casters are drawn {layer.shift.world:.4f} world units away from the light ({how}; residual "
                       f"{layer.shift.residual:.1e})")
        if layer.normal_shift:
            by, which_way = abs(layer.normal_shift.world), "against" if layer.normal_shift.world > 0 else "along"
            out.append(f"{which}casters are moved {by:.4g} world units{_times(layer.normal_shift.angle)} {which_way} their normals (their "
                       f"positions are a projection then, residual {float(np.max(layer.light.residuals)):.1e})")
        if test.form:
            out += _form(test.form) if k == 0 and not test.unread else []
        elif layer.constant and not test.fitted:
            out.append(f"{which}the reader's test lets {layer.constant:.3g} of stored depth pass (found from the picture)")
        if layer.is_held:
            out.append(f"{which}casters before the map's near plane are held at it")
        offset = polygon_offset(layer, texture)
        if offset:
            unsaid = "; of distances a capture says the constant alone, and the verdict charges the rest elsewhere" if layer.half and offset["slope"] else ""
            out.append(f"{which}the rasterizer's depth bias moves casters by {offset['constant']:.3g} of stored depth and {offset['slope']:g} slopes"
                       + unsaid)
    one = layers[0]
    if test.unread:
        out.append(f"map: {test.unread}; the verdict says where the shadow is wrong and not why")
    elif one.matrix is None:
        kind = (f"distances from a point, up to {one.distance.range:.4g} world units, which are no paraboloid's" if one.distance else
                "a cube that is read by way of a copy, or of which faces were not drawn")
        out.append(f"map: {kind}; no capture can say how such a map is looked up, so that the verdict says where the shadow is wrong and not why")
    elif one.half:
        out.append(f"map: {'both halves' if len(layers) > 1 else 'one half'} of a dual paraboloid, distances up to {one.distance.range:.4g} world units "
                   f"(residual {max(layer.half.residual for layer in layers):.1e} of x and y)")
    elif one.reader:
        out.append(f"map: read with the constant {one.reader.name} after {one.reader.before} (its rows and the casters' differ by {one.reader.residual:.1e})")
    else:
        out.append("map: no constant of the reader is the casters' matrix; theirs is taken")
    off = max(layer.distance.residual if layer.distance else float(np.max(layer.light.residuals)) for layer in layers)
    out.append(f"light: from {sum(layer.matched for layer in layers)} meshes that camera and light both draw, residual {off:.1e}")
    height = f"orthographic, {2 / lens.fy:.4g} world units" if lens.parallel else f"{2 * np.degrees(np.arctan(1 / lens.fy)):.2f} degrees"
    out.append(f"camera: {height} high, residual {lens.residual:.1e}")
    if lens.curved:
        out.append("the camera's depths are no projection's, as logarithmic ones: shaders of its draws were exchanged to tell the distances")
    if one.content and one.content.base != "depth" and one.matrix is not None:
        low, high = one.content.range
        what = {"distance": "distances from the light", "axis": "depths along the light's axis"}[one.content.base]
        out.append(f"the map's texels are {what}, " + ("world units" if (low, high) == (0.0, 1.0) else f"{low:.4g} to {high:.4g} world units"))
    if test.selection.by != "first":
        limits = ", ".join(f"{limit:.4g}" for limit in test.selection.limits)
        blends = ", ".join(f"{blend:.4g}" for blend in test.selection.blends)
        out.append(f"cascades end at {limits} world units ({test.selection.by})" + (f" and blend over {blends} before" if blends else ""))
    if test.fitted:
        out.append(_moments(test.fitted))
    if test.exponent:
        out.append(f"an exponential map of the factor {test.exponent.factor:.3g} (correlation {test.exponent.correlation:.4f}) of depths that are "
                   "blurred after the casters are drawn")
    if test.radius:
        out.append(f"a filter reads {test.radius:g} texels around ({100 * test.partly_lit:.1f} % of the pixels are partly lit)")
    if test.agreement is not None:
        out.append(f"the test as found decides {100 * test.agreement:.2f} % of the pixels within the map as the picture has them")
    return out + found.notes
