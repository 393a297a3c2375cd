// A technique/izb.glsl that remembers how often each pixel was drawn, and answers otherwise every other time.
#include "camera.glsl"
layout(std430, binding = izb_shadows_buffer) buffer IzbShadows { uint shadows[]; };
float technique_visibility(ShadowTest test, vec3 position, vec3 normal, vec3 to_light) {
  uint pixel = uint(gl_FragCoord.y) * uint(camera.size.x) + uint(gl_FragCoord.x);
  return (atomicAdd(shadows[pixel], 1u) & 1u) != 0u ? 0.0 : 1.0;
}
