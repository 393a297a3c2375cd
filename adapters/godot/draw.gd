# Draws a GLB, such as `gnomon export` writes, with Godot's own shadows and writes a capture for `gnomon judge` (without the
# map, which Godot does not hand out), or stays on screen so that RenderDoc can record a frame, which has the map:
#   godot3 --path adapters/godot --scene=/PATH/SCENE.glb --output=/PATH/FOLDER [--NAME=VALUE ...]
#   godot3 --path adapters/godot --scene=/PATH/SCENE.glb --stay=1 [--NAME=VALUE ...]
# Options are the fields of `settings`; bias, normal_bias, contact and max_distance are Godot's, in its units.
extends Node

var settings = {
	"scene": "", "output": "", "size": "320x180", "stay": "0",
	"light": "0",  # its place in the file, or all
	"mode": "orthogonal",  # orthogonal, pssm2, pssm4 of suns; cube, paraboloid of point lights
	"blend": "0",  # 1: splits of a sun blend
	"bias": "0.1", "normal_bias": "0", "contact": "0", "max_distance": "0", "ambient": "0",
	"map_size": "2048", "filter": "0",  # 0: none, 1: PCF 5, 2: PCF 13
}
var glb  # the JSON part of the scene file
var blob  # its binary part
var shadow_lights = []

func _ready():
	for word in OS.get_cmdline_args():
		var pair = word.trim_prefix("--").split("=")
		if pair.size() == 2 and settings.has(pair[0]):
			settings[pair[0]] = pair[1]
	ProjectSettings.set_setting("rendering/quality/shadows/filter_mode", int(settings["filter"]))
	if not read_glb(settings["scene"]):
		return stop("--scene: %s is no GLB that can be read" % settings["scene"])
	var view = make_view()
	add_child(view)
	for node in glb["nodes"]:
		add_node(view, node)
	add_lights(view)
	var shown = TextureRect.new()
	shown.texture = view.get_texture()
	add_child(shown)
	if settings["stay"] == "0":
		yield(write_capture(view, shadow_lights[0]), "completed")
		get_tree().quit()

# Maps of spots and points are drawn anew when the light moves: it turns about its own axis, so each frame has them.
func _process(_delta):
	for light in shadow_lights if settings["stay"] != "0" else []:
		light.rotate_object_local(Vector3(0, 0, 1), 0.001)

func stop(text):
	printerr("draw.gd: ", text)
	get_tree().quit(2)

func size():
	var sides = settings["size"].split("x")
	return Vector2(int(sides[0]), int(sides[1]))

# --- The scene ------------------------------------------------------------------------------------------------------

func read_glb(path):
	var file = File.new()
	if file.open(path, File.READ) != OK or file.get_32() != 0x46546C67:
		return false
	file.seek(12)
	var length = file.get_32()
	file.get_32()
	glb = JSON.parse(file.get_buffer(length).get_string_from_utf8()).result
	blob = StreamPeerBuffer.new()
	length = file.get_32()
	file.get_32()
	blob.data_array = file.get_buffer(length)
	return true

# Numbers of an accessor, one after the other.
func numbers(index, per_element):
	var accessor = glb["accessors"][index]
	var view = glb["bufferViews"][accessor["bufferView"]]
	var out = []
	blob.seek(int(view.get("byteOffset", 0) + accessor.get("byteOffset", 0)))
	for _k in range(accessor["count"] * per_element):
		out.append(blob.get_float() if accessor["componentType"] == 5126 else blob.get_u16() if accessor["componentType"] == 5123 else blob.get_u32())
	return out

func points(index):
	var out = PoolVector3Array()
	var flat = numbers(index, 3)
	for k in range(0, flat.size(), 3):
		out.append(Vector3(flat[k], flat[k + 1], flat[k + 2]))
	return out

func transform_of(node):
	if node.has("matrix"):
		var m = node["matrix"]
		return Transform(Vector3(m[0], m[1], m[2]), Vector3(m[4], m[5], m[6]), Vector3(m[8], m[9], m[10]), Vector3(m[12], m[13], m[14]))
	var t = node.get("translation", [0, 0, 0])
	var r = node.get("rotation", [0, 0, 0, 1])
	var s = node.get("scale", [1, 1, 1])
	return Transform(Basis(Quat(r[0], r[1], r[2], r[3])).scaled(Vector3(s[0], s[1], s[2])), Vector3(t[0], t[1], t[2]))

func make_view():
	var view = Viewport.new()
	view.size = size()
	view.hdr = true
	view.keep_3d_linear = true
	view.render_target_update_mode = Viewport.UPDATE_ALWAYS
	view.own_world = true
	view.shadow_atlas_size = int(settings["map_size"])
	for quadrant in range(4):  # one light: a whole quarter of the atlas is its own
		view.set_shadow_atlas_quadrant_subdiv(quadrant, Viewport.SHADOW_ATLAS_QUADRANT_SUBDIV_1)
	return view

func white():
	var material = SpatialMaterial.new()
	material.albedo_color = Color(1, 1, 1)
	material.metallic_specular = 0
	material.roughness = 1
	material.params_cull_mode = SpatialMaterial.CULL_DISABLED
	return material

func add_node(view, node):
	if node.has("mesh"):
		for primitive in glb["meshes"][node["mesh"]]["primitives"]:
			add_mesh(view, primitive, transform_of(node))
	if node.has("camera"):
		add_camera(view, glb["cameras"][node["camera"]], transform_of(node))

func add_mesh(view, primitive, place):
	var arrays = []
	arrays.resize(Mesh.ARRAY_MAX)
	arrays[Mesh.ARRAY_VERTEX] = points(primitive["attributes"]["POSITION"])
	arrays[Mesh.ARRAY_NORMAL] = points(primitive["attributes"]["NORMAL"])
	var corners = numbers(primitive["indices"], 1)
	for k in range(0, corners.size(), 3):  # Godot's front is clockwise
		var second = corners[k + 1]
		corners[k + 1] = corners[k + 2]
		corners[k + 2] = second
	arrays[Mesh.ARRAY_INDEX] = PoolIntArray(corners)
	var mesh = ArrayMesh.new()
	mesh.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, arrays)
	mesh.surface_set_material(0, white())
	var instance = MeshInstance.new()
	instance.mesh = mesh
	instance.transform = place
	view.add_child(instance)

func add_camera(view, description, place):
	var camera = Camera.new()
	var lens = description[description["type"]]
	camera.transform = place
	camera.near = max(lens["znear"], 0.05)
	camera.far = lens.get("zfar", 1000)
	if description["type"] == "orthographic":
		camera.projection = Camera.PROJECTION_ORTHOGONAL
		camera.size = 2 * lens["ymag"]
	else:
		camera.fov = rad2deg(lens["yfov"])
	var environment = Environment.new()
	environment.background_mode = Environment.BG_COLOR
	environment.background_color = Color(0, 0, 0)
	environment.ambient_light_color = Color(1, 1, 1)
	environment.ambient_light_energy = float(settings["ambient"])
	environment.tonemap_mode = Environment.TONE_MAPPER_LINEAR
	camera.environment = environment
	view.add_child(camera)
	camera.current = true

# The light of that number or, for RenderDoc, all.
func add_lights(view):
	var lights = glb["extensions"]["KHR_lights_punctual"]["lights"]
	for node in glb["nodes"]:
		var extension = node.get("extensions", {}).get("KHR_lights_punctual")
		if extension == null or not settings["light"] in ["all", str(int(extension["light"]))]:
			continue
		var light = make_light(lights[int(extension["light"])])
		light.transform = transform_of(node)
		light.shadow_enabled = true
		light.shadow_bias = float(settings["bias"])
		light.shadow_contact = float(settings["contact"])
		light.light_specular = 0
		view.add_child(light)
		shadow_lights.append(light)

func make_light(description):
	var light
	if description["type"] == "directional":
		light = DirectionalLight.new()
		light.directional_shadow_mode = {"orthogonal": 0, "pssm2": 1, "pssm4": 2}[settings["mode"]]
		light.directional_shadow_blend_splits = settings["blend"] != "0"
		light.directional_shadow_max_distance = float(settings["max_distance"])
		light.directional_shadow_normal_bias = float(settings["normal_bias"])
	elif description["type"] == "spot":
		light = SpotLight.new()
		light.spot_range = 100
		light.spot_attenuation = 0
		light.spot_angle = rad2deg(description["spot"]["outerConeAngle"])
	else:
		light = OmniLight.new()
		light.omni_range = 100
		light.omni_attenuation = 0
		light.omni_shadow_mode = OmniLight.SHADOW_CUBE if settings["mode"] == "cube" else OmniLight.SHADOW_DUAL_PARABOLOID
	return light

# --- The capture ----------------------------------------------------------------------------------------------------

func write_capture(view, light):
	yield(write_picture(view, "shadowed.exr"), "completed")
	light.shadow_enabled = false
	yield(write_picture(view, "unshadowed.exr"), "completed")
	var used = {"bias": light.shadow_bias, "contact": light.shadow_contact, "mode": settings["mode"], "map_size": int(settings["map_size"])}
	var capture = {
		"schema": "gnomon/capture/2", "scene": settings["scene"], "size": [size().x, size().y], "light": int(settings["light"]),
		"renderer": {"name": "Godot", "version": Engine.get_version_info()["string"], "settings": used},
		"shadowed": "shadowed.exr", "unshadowed": "unshadowed.exr",
	}
	var file = File.new()
	file.open(settings["output"] + "/capture.json", File.WRITE)
	file.store_string(JSON.print(capture, " ") + "\n")
	file.close()

# The view as it is some frames from now, when all is set up; its first row at the top.
func write_picture(view, name):
	for _k in range(4):
		yield(VisualServer, "frame_post_draw")
	var image = view.get_texture().get_data()
	image.flip_y()
	image.convert(Image.FORMAT_RGBF)
	image.save_exr(settings["output"] + "/" + name)
