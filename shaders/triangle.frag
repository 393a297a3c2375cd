// Primitive ids of the camera's pass (PRIMITIVE_IDS), holes of alpha-masked
// materials (ALPHA_MASK), only what lies behind a map's first layer (PEEL), casters with a bias of their own (CASTER_BIAS). Without any, the depth pass needs no fragment shader.
#include "shared_constants.h"

layout(location = first_primitive_uniform) uniform uint first_primitive;

#ifdef PRIMITIVE_IDS
layout(location = 0) out uint primitive_id;
#endif
#ifdef PEEL
#include "peel.glsl"
#endif
#ifdef CASTER_BIAS
#include "light_map.glsl"
#include "caster_bias.glsl"
#endif
#ifdef ALPHA_MASK
#include "material.glsl"
#include "triangles.glsl"
in vec2 vertex_uv;
#ifdef VERTEX_COLORS
in float vertex_alpha;
#else
const float vertex_alpha = 1.0;
#endif
#endif

void main() {
#ifdef PEEL
  if (!lies_behind(clamp(gl_FragCoord.z, 0.0, 1.0))) discard;
#endif
#ifdef CASTER_BIAS
  float stored = clamp(gl_FragCoord.z, 0.0, 1.0);
  float slope = max(abs(dFdx(gl_FragCoord.z)), abs(dFdy(gl_FragCoord.z)));
  if (!holds_caster(stored)) discard;
  gl_FragDepth = biased_caster(stored, slope);
#endif
  uint primitive = first_primitive + uint(gl_PrimitiveID);
#ifdef ALPHA_MASK
  if (is_hole(material_at(triangle_at(primitive).material), vertex_uv, vertex_alpha)) discard;
#endif
#ifdef PRIMITIVE_IDS
  primitive_id = primitive;
#endif
}
