# What the scripts that run in Blender share: the scene with one light, in white, and its pictures as text.
import base64
import json
import os
import sys

import bpy
import numpy


if not hasattr(numpy, "bool"):
    numpy.bool = bool  # the importer of Blender 3.4 asks for it; NumPy 1.24 has dropped it


def load(path):
    bpy.ops.object.select_all(action="SELECT")
    bpy.ops.object.delete()
    bpy.ops.import_scene.gltf(filepath=path)


def choose_light(wanted):
    lights = [o for o in bpy.data.objects if o.type == "LIGHT"]
    chosen = [o for o in lights if wanted is None or o.name == wanted][:1]
    if not chosen:
        raise SystemExit(f"--light: no such light (got {wanted}, allowed {', '.join(o.name for o in lights)})")
    for light in lights:
        light.hide_render = light is not chosen[0]
    data = chosen[0].data
    if data.type == "SUN":
        data.angle = 0.0
    else:
        data.shadow_soft_size = 0.0
    return chosen[0]


# White and matte; a mask's own alpha stays.
def whiten():
    white = bpy.data.materials.new("white")
    white.use_nodes = True
    white.node_tree.nodes.clear()
    diffuse, output = (white.node_tree.nodes.new(n) for n in ("ShaderNodeBsdfDiffuse", "ShaderNodeOutputMaterial"))
    diffuse.inputs["Color"].default_value = (1, 1, 1, 1)
    white.node_tree.links.new(diffuse.outputs[0], output.inputs["Surface"])
    for mesh in bpy.data.meshes:
        for i, material in enumerate(mesh.materials):
            if material is None or material.blend_method != "CLIP":
                mesh.materials[i] = white
        if len(mesh.materials) == 0:
            mesh.materials.append(white)


def set_up(path, engine, width, height):
    scene = bpy.context.scene
    scene.camera = next(o for o in bpy.data.objects if o.type == "CAMERA")
    scene.camera.data.sensor_fit = "VERTICAL"
    scene.camera.data.angle_y = yfov_of(path)
    render = scene.render
    render.engine = engine
    render.resolution_x, render.resolution_y, render.resolution_percentage = width, height, 100
    render.film_transparent = True
    render.use_persistent_data = False
    render.image_settings.file_format = "OPEN_EXR"
    render.image_settings.color_depth = "32"
    scene.world = None


# Writes a pass, in full floats, beside the picture.
def add_output(folder, name):
    scene = bpy.context.scene
    setattr(scene.view_layers[0], f"use_pass_{'z' if name == 'Depth' else name.lower()}", True)
    scene.use_nodes = True
    tree = scene.node_tree
    tree.nodes.clear()
    layers, output = tree.nodes.new("CompositorNodeRLayers"), tree.nodes.new("CompositorNodeOutputFile")
    composite = tree.nodes.new("CompositorNodeComposite")
    output.base_path = folder
    output.format.file_format, output.format.color_depth = "OPEN_EXR", "32"
    output.file_slots[0].path = name + "-"
    tree.links.new(layers.outputs["Image"], composite.inputs["Image"])
    tree.links.new(layers.outputs[name], output.inputs[0])


# Four channels, the first row at the top.
def pixels(path, width, height):
    image = bpy.data.images.load(path)
    image.colorspace_settings.name = "Non-Color"
    image.alpha_mode = "CHANNEL_PACKED"
    values = numpy.empty(width * height * 4, numpy.float32)
    image.pixels.foreach_get(values)
    return values.reshape(height, width, 4)[::-1]


def draw(folder, name, width, height):
    bpy.context.scene.render.filepath = os.path.join(folder, name)
    bpy.ops.render.render(write_still=True)
    return pixels(os.path.join(folder, name + ".exr"), width, height)


def encoded(values):
    return {"floats": base64.b64encode(numpy.ascontiguousarray(values, numpy.float32).tobytes()).decode()}


def yfov_of(path):
    with open(path, "rb") as file:
        data = file.read()
    text = data[20:20 + int.from_bytes(data[12:16], "little")] if data[:4] == b"glTF" else data
    return json.loads(text)["cameras"][0]["perspective"]["yfov"]


# The task's own settings over the defaults; an unknown name is an error.
def settings_of(task, defaults):
    for name in task["settings"]:
        if name not in defaults:
            raise SystemExit(f"--{name}: no such option (allowed {', '.join(defaults)})")
    given = {**defaults, **task["settings"]}
    return {name: given[name] in (True, "true") if isinstance(defaults[name], bool) else given[name] for name in defaults}


def read_task():
    with open(sys.argv[sys.argv.index("--") + 1]) as file:
        return json.load(file)


def write_result(result):
    with open(sys.argv[sys.argv.index("--") + 2], "w") as file:
        json.dump(result, file)
