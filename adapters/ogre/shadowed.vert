#version 330
uniform mat4 clip_from_object, world_from_object, texture_from_world;
in vec4 vertex;
in vec3 normal;
out vec4 in_map;
out vec3 normal_world;
void main() {
  gl_Position = clip_from_object * vertex;
  in_map = texture_from_world * (world_from_object * vertex);
  normal_world = mat3(world_from_object) * normal;
}
