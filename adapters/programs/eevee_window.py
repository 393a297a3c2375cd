"""Blender's window with EEVEE in it, for record.py: a sun that moves, so that its map is drawn in every frame.
blender --factory-startup --python eevee_window.py"""
import math

import bpy


def scene():
    """The sun's object."""
    for one in list(bpy.data.objects):
        bpy.data.objects.remove(one)
    bpy.ops.mesh.primitive_plane_add(size=12)
    bpy.ops.mesh.primitive_cube_add(size=1.4, location=(-1, 0, 0.9))
    bpy.ops.mesh.primitive_uv_sphere_add(radius=0.8, location=(1.2, 0.6, 0.9))
    light = bpy.data.lights.new("sun", "SUN")
    light.energy, light.angle, light.use_contact_shadow = 3, 0, False
    sun = bpy.data.objects.new("sun", light)
    sun.rotation_euler = (0.6, 0.3, 0)
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.location, camera.rotation_euler = (5, -6, 4.5), (1.05, 0, 0.7)
    for one in (sun, camera):
        bpy.context.scene.collection.objects.link(one)
    bpy.context.scene.camera = camera
    bpy.context.scene.render.engine = "BLENDER_EEVEE"
    eevee = bpy.context.scene.eevee
    eevee.use_soft_shadows, eevee.taa_samples, eevee.use_shadow_high_bitdepth = False, 1, True
    return sun


def draw_again():
    """Shows the camera's view, drawn anew with the sun elsewhere; called by a timer, which it answers with the seconds to the next call."""
    for area in bpy.context.window_manager.windows[0].screen.areas:
        if area.type == "VIEW_3D":
            space = area.spaces[0]
            space.shading.type, space.region_3d.view_perspective = "RENDERED", "CAMERA"
            space.overlay.show_overlays = space.show_gizmo = False
            area.tag_redraw()
    draw_again.sun.rotation_euler[1] = 0.3 + 0.05 * math.sin(0.3 * draw_again.frame)
    draw_again.frame += 1
    return 0.02


draw_again.sun, draw_again.frame = scene(), 0
bpy.app.timers.register(draw_again)
