// Visibility from an image of the camera's size that was worked out elsewhere (raster/external_visibility.h).

layout(binding = external_visibility_unit) uniform sampler2D external_visibility;

float technique_visibility(ShadowTest test, vec3 position, vec3 normal, vec3 to_light) {
  return texelFetch(external_visibility, ivec2(gl_FragCoord.xy), 0).r;
}
