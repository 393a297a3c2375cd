# EEVEE, Blender's rasterizer. Options: --cascadeSize, --cubeSize (texels of a sun's four cascades, of a spot's or point's cube),
# --highBitDepth, --softShadows, --bias, --clipStart, --samples; their defaults are Blender's. Each pixel is seen at its
# centre; soft shadows of a light without size move the map a little for each sample. No map is handed over.
# The visibility is the ratio of two pictures in white, with the light's shadows and without; needs an OpenGL display, such as Xvfb's.
import os
import sys
import tempfile

import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import common  # noqa: E402

defaults = {"cascadeSize": 1024, "cubeSize": 512, "highBitDepth": False, "softShadows": True, "bias": 1.0, "clipStart": 0.05, "samples": 64}


def set_up_eevee(settings, light):
    eevee = bpy.context.scene.eevee
    eevee.shadow_cascade_size, eevee.shadow_cube_size = str(settings["cascadeSize"]), str(settings["cubeSize"])
    eevee.use_shadow_high_bitdepth, eevee.use_soft_shadows = settings["highBitDepth"], settings["softShadows"]
    eevee.taa_render_samples = settings["samples"]
    eevee.light_threshold = 0.0
    bpy.context.scene.render.filter_size = 0.0  # the pixel's centre
    light.shadow_buffer_bias, light.shadow_buffer_clip_start = settings["bias"], settings["clipStart"]


def main():
    task = common.read_task()
    settings = common.settings_of(task, defaults)
    width, height = task["width"], task["height"]
    common.load(task["scene"])
    light = common.choose_light(task.get("light"))
    common.whiten()
    common.set_up(task["scene"], "BLENDER_EEVEE", width, height)
    set_up_eevee(settings, light.data)
    with tempfile.TemporaryDirectory() as folder:
        common.add_output(folder, "Depth")
        shadowed = common.draw(folder, "shadowed", width, height)
        depth = common.pixels(os.path.join(folder, "Depth-0001.exr"), width, height)[..., 0]
        light.data.use_shadow = False
        unshadowed = common.draw(folder, "unshadowed", width, height)
    encoded = common.encoded
    depth = depth * (unshadowed[..., 3] > 0.5)  # 0 where nothing was drawn
    common.write_result({
        "renderer": {"name": "EEVEE", "version": f"Blender {bpy.app.version_string}", "settings": settings},
        "light": light.name, "shadowed": encoded(shadowed[..., 0]), "unshadowed": encoded(unshadowed[..., 0]),
        "depth": {"values": encoded(depth), "convention": "view_z"}})


main()
