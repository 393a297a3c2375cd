# Cycles, Blender's path tracer: a second truth beside Gnomon's. One sample at each pixel's centre, lights without size, no
# bounces; the visibility is the ratio of two pictures in white, with the light's shadows and without. Options:
# --shadowTerminatorOffset, Blender's geometry offset: how far rays start off a smooth surface where the light grazes; 0 here. Run by capture.mjs: blender --background --factory-startup --python cycles.py -- TASK.json RESULT.json
import os
import sys
import tempfile

import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import common  # noqa: E402


defaults = {"shadowTerminatorOffset": 0.0}


# Of the geometry, where a shadow ray starts; the other one would change the light that arrives.
def set_terminator_offset(offset):
    for item in bpy.data.objects:
        item.cycles.shadow_terminator_geometry_offset = offset
        item.cycles.shadow_terminator_offset = 0.0


def set_up_cycles():
    scene = bpy.context.scene
    cycles = scene.cycles
    cycles.samples, cycles.max_bounces = 1, 0
    cycles.transparent_max_bounces = 64
    cycles.light_sampling_threshold = 0.0  # weak lights are not left to chance
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.pixel_filter_type, cycles.filter_width = "BLACKMAN_HARRIS", 0.01  # the pixel's centre


def main():
    task = common.read_task()
    settings = common.settings_of(task, defaults)
    width, height = task["width"], task["height"]
    common.load(task["scene"])
    light = common.choose_light(task.get("light"))
    common.whiten()
    set_terminator_offset(settings["shadowTerminatorOffset"])
    common.set_up(task["scene"], "CYCLES", width, height)
    set_up_cycles()
    with tempfile.TemporaryDirectory() as folder:
        common.add_output(folder, "Position")
        shadowed = common.draw(folder, "shadowed", width, height)
        position = common.pixels(os.path.join(folder, "Position-0001.exr"), width, height)
        light.data.use_shadow = light.data.cycles.cast_shadow = False
        unshadowed = common.draw(folder, "unshadowed", width, height)
    # Blender's world has z up.
    x, y, z = position[..., 0], position[..., 2], -position[..., 1]
    encoded = common.encoded
    common.write_result({
        "renderer": {"name": "Cycles", "version": f"Blender {bpy.app.version_string}", "settings": {"samples": 1, **settings}},
        "light": light.name, "shadowed": encoded(shadowed[..., 0]), "unshadowed": encoded(unshadowed[..., 0]),
        "covered": encoded(unshadowed[..., 3]), "position": [encoded(p) for p in (x, y, z)]})


main()
