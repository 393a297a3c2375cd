#version 330
uniform sampler2D shadow_map;
uniform vec4 to_light;
uniform float bias;
in vec4 in_map;
in vec3 normal_world;
out vec4 colour;
void main() {
  vec3 at = in_map.xyz / in_map.w;  // z from -1, as OGRE's matrix has it
  float lit = 0.5 * at.z + 0.5 - bias > texture(shadow_map, at.xy).r ? 0.0 : 1.0;
  colour = vec4(vec3(0.1 + 0.9 * lit * max(0.0, dot(normalize(normal_world), normalize(to_light.xyz)))), 1.0);
}
