# Cycles, Blender's path tracer, on a scene of programs_bench: the same triangles, camera, sun and materials; one sample at
# each pixel's centre, a sun without size, no bounces, the sky for the eye alone. Run as
#   blender --background --factory-startup --python-exit-code 1 --python cycles_peer.py -- SCENE.json WIDTH HEIGHT OUT.png
# Says on a line of its own how long the render alone took: after Blender's start and the reading of the file, with
# the making of the hierarchy and the writing of the picture.
import json
import math
import os
import sys
import time

import bpy
import numpy
from mathutils import Matrix, Vector


def read_ply(path):
    with open(path, "rb") as file:
        data = file.read()
    header, _, body = data.partition(b"end_header\n")
    counts = {}
    for line in header.decode().splitlines():
        words = line.split()
        if words[0] == "element":
            counts[words[1]] = int(words[2])
    vertices, faces = counts["vertex"], counts["face"]
    positions = numpy.frombuffer(body, "<f4", 3 * vertices)
    face = numpy.dtype([("count", "u1"), ("corners", "<u4", 3)])
    triangles = numpy.frombuffer(body, face, faces, 12 * vertices)["corners"]
    return positions, numpy.ascontiguousarray(triangles)


def add_mesh(path, grey):
    positions, triangles = read_ply(path)
    mesh = bpy.data.meshes.new("model")
    mesh.vertices.add(len(positions) // 3)
    mesh.vertices.foreach_set("co", positions)
    mesh.loops.add(triangles.size)
    mesh.loops.foreach_set("vertex_index", triangles.ravel())
    mesh.polygons.add(len(triangles))
    mesh.polygons.foreach_set("loop_start", numpy.arange(0, triangles.size, 3, dtype=numpy.int32))
    mesh.polygons.foreach_set("loop_total", numpy.full(len(triangles), 3, dtype=numpy.int32))
    mesh.update()
    material = bpy.data.materials.new("grey")
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    diffuse, output = (tree.nodes.new(n) for n in ("ShaderNodeBsdfDiffuse", "ShaderNodeOutputMaterial"))
    diffuse.inputs["Color"].default_value = (grey, grey, grey, 1)
    tree.links.new(diffuse.outputs[0], output.inputs["Surface"])
    mesh.materials.append(material)
    add(bpy.data.objects.new("model", mesh))


def add(item):
    bpy.context.scene.collection.objects.link(item)
    return item


# Looks along -z, with y up.
def frame(forward, up, origin):
    back = -forward.normalized()
    right = up.cross(back).normalized()
    return Matrix.Translation(origin) @ Matrix((right, back.cross(right), back)).transposed().to_4x4()


def add_camera(camera):
    eye, target = Vector(camera["eye"]), Vector(camera["target"])
    item = add(bpy.data.objects.new("camera", bpy.data.cameras.new("camera")))
    item.matrix_world = frame(target - eye, Vector((0, 1, 0)), eye)
    item.data.sensor_fit = "VERTICAL"
    item.data.angle_y = math.radians(camera["vertical_fov_degrees"])
    item.data.clip_start, item.data.clip_end = 1e-3, 1e5
    bpy.context.scene.camera = item


def add_sun(light):
    data = bpy.data.lights.new("sun", "SUN")
    data.angle, data.energy = 0.0, math.pi  # a white surface that faces it has radiance 1
    direction = Vector(light["direction"])
    side = Vector((0, 1, 0)) if abs(direction.normalized().y) < 0.9 else Vector((1, 0, 0))
    add(bpy.data.objects.new("sun", data)).matrix_world = frame(direction, side, Vector((0, 0, 0)))


def add_sky(color):
    world = bpy.data.worlds.new("sky")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Color"].default_value = (*color, 1)
    seen = world.cycles_visibility
    seen.diffuse = seen.glossy = seen.transmission = seen.scatter = False
    bpy.context.scene.world = world


def set_up(width, height, out):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.device, cycles.samples, cycles.max_bounces = "CPU", 1, 0
    cycles.light_sampling_threshold = 0.0
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.pixel_filter_type, cycles.filter_width = "BLACKMAN_HARRIS", 0.01  # the pixel's centre
    render = scene.render
    render.resolution_x, render.resolution_y, render.resolution_percentage = width, height, 100
    render.use_compositing = render.use_sequencer = False
    render.dither_intensity = 0.0
    render.image_settings.file_format, render.image_settings.color_mode = "PNG", "RGB"
    render.filepath = out
    scene.view_settings.view_transform, scene.view_settings.look = "Standard", "None"


def main():
    path, width, height, out = sys.argv[sys.argv.index("--") + 1:]
    with open(path) as file:
        scene = json.load(file)
    for item in list(bpy.data.objects):
        bpy.data.objects.remove(item)
    add_mesh(os.path.join(os.path.dirname(path), scene["meshes"][0]["file"]), scene["materials"][0]["diffuse"])
    add_camera(scene["camera"])
    add_sun(scene["lights"][0])
    add_sky(scene["background"])
    set_up(int(width), int(height), out)
    start = time.perf_counter()
    bpy.ops.render.render(write_still=True)
    print(f"\nrender_ms {1000 * (time.perf_counter() - start):.1f}", flush=True)


main()
