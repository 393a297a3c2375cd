// Depth peeling (Everitt 2001): what lies at or before the first layer of a map is left out. `peel_face_and_step` holds the
// map's face and a step of its number format, within which two depths are the same.

layout(binding = first_layer_unit) uniform sampler2DArray first_layer;
layout(location = peel_uniform) uniform vec2 peel_face_and_step;

bool lies_behind(float stored) {
  float first = texelFetch(first_layer, ivec3(gl_FragCoord.xy, int(peel_face_and_step.x)), 0).r;
#ifdef REVERSED
  return stored < first * (1.0 - peel_face_and_step.y);
#else
  return stored > first + peel_face_and_step.y;
#endif
}
