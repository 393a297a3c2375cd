"""What was found, in sentences for a person: each finding with how it was found and its residual."""
import numpy as np


def _kind(layers):
    place = layers[0].place
    if place.apex is None:
        return "sun" if len(layers) == 1 else f"sun with {len(layers)} cascades"
    return "spot light" if len(layers) == 1 else f"point light with {len(layers)} faces"


def light_line(number, frame, found, layers):
    """A line of --list."""
    texture = frame.textures[found.passes.texture]
    x, y, width, height = layers[0].state.viewport
    casters = sum(len(layer.events) for layer in layers)
    return (f"light {number}: {_kind(layers)}, map {texture.width} x {texture.height} {texture.format} (texture {texture.id}, {width:.0f} x {height:.0f} "
            f"from {x:.0f}, {y:.0f}), {casters} draws of casters, read by {len(found.passes.readers)} draws from event {found.passes.readers[0].event} on")


def findings(found, layers, test):
    """Sentences, the most important first."""
    lens = found.view.lens
    out = []
    for k, layer in enumerate(layers):
        which = f"cascade {k + 1}: " if len(layers) > 1 else ""
        if layer.shift and abs(layer.shift.world) > 1e-6:
            out.append(f"{which}casters are drawn {layer.shift.world:.4f} world units away from the light (their matrix and the reader's differ by "
                       f"that; residual {layer.shift.residual:.1e})")
        if layer.constant:
            out.append(f"{which}the reader's test lets {layer.constant:.3g} of stored depth pass (found from the picture)")
        bias = layer.state.depth_bias
        if bias["constant"] or bias["slope"]:
            out.append(f"{which}the rasterizer's depth bias is {bias['constant']:g}, slope {bias['slope']:g}, clamp {bias['clamp']:g}")
    one = layers[0]
    if one.reader:
        out.append(f"map: read with the constant {one.reader.name} after {one.reader.before} (its rows and the casters' differ by {one.reader.residual:.1e})")
    else:
        out.append("map: no constant of the reader is the casters' matrix; theirs is taken")
    out.append(f"light: from {sum(layer.matched for layer in layers)} meshes that camera and light both draw, residual {max(float(np.max(l.light.residuals)) for l in layers):.1e}")
    out.append(f"camera: {2 * np.degrees(np.arctan(1 / lens.fy)):.2f} degrees high, residual {lens.residual:.1e}")
    if test.selection.by != "first":
        limits = ", ".join(f"{limit:.4g}" for limit in test.selection.limits)
        out.append(f"cascades end at {limits} world units ({test.selection.by})")
    if test.radius:
        out.append(f"a filter reads {test.radius:g} texels around ({100 * test.partly_lit:.1f} % of the pixels are partly lit)")
    out.append(f"the test as found decides {100 * test.agreement:.2f} % of the pixels as the picture has them")
    return out + found.notes
