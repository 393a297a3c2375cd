// The verdict of the irregular z-buffer (izb/izb.glsl) on this pixel.
#include "camera.glsl"

layout(std430, binding = izb_shadows_buffer) readonly buffer IzbShadows { uint shadows[]; };

float technique_visibility(ShadowTest test, vec3 position, vec3 normal, vec3 to_light) {
  uint pixel = uint(gl_FragCoord.y) * uint(camera.size.x) + uint(gl_FragCoord.x);
  return shadows[pixel] != 0u ? 0.0 : 1.0;
}
