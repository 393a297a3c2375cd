// Sphere or plane (permutation SPHERE) in a light's depth map: casts the ray through the texel's centre and writes its true
// depth. Culling leaves out the shape's front or back side as seen by the light. A caster before the map's near depth
// is stored at it, one beyond the far depth is not stored.
#include "shared_constants.h"

layout(location = shape_uniform) uniform int shape_index;
layout(location = face_uniform) uniform int face;
layout(location = cull_uniform) uniform int cull;

#include "light_map.glsl"
#include "world.glsl"
#include "sphere.glsl"
#ifdef ALPHA_MASK
#include "material.glsl"
#endif
#ifdef PRIMITIVE_IDS
layout(location = 0) out uint primitive_id;
#endif

bool usable(ShapeData shape, vec3 origin, vec3 direction, float t) {
#ifdef PERSPECTIVE
  if (!(t > 0.0)) return false;
#endif
  if (isnan(t) || isinf(t)) return false;
#ifdef ALPHA_MASK
  if (is_hole(materials[shape.material], shape_uv(shape, origin + t * direction))) return false;
#endif
  return true;
}

void main() {
  ShapeData shape = shapes[shape_index];
  vec2 offset = (2.0 * gl_FragCoord.xy / light.origin_and_size.w - 1.0) * light.extent_and_depths.xy;
  vec3 sideways = offset.x * light.right[face].xyz + offset.y * light.up[face].xyz;
  // t is the depth along forward in both projections.
#ifdef PERSPECTIVE
  vec3 origin = light.origin_and_size.xyz;
  vec3 direction = light.forward[face].xyz + sideways;
#else
  vec3 origin = light.origin_and_size.xyz + sideways;
  vec3 direction = light.forward[face].xyz;
#endif
#ifdef SPHERE
  float t_near, t_far;
  if (!sphere_crossings(origin, direction, shape.center_and_radius.xyz, shape.center_and_radius.w, t_near, t_far))
    discard;
  bool near_counts = cull != cull_front && usable(shape, origin, direction, t_near);
  if (!near_counts && cull == cull_back) discard;
  float t = near_counts ? t_near : t_far;
#else
  float facing = dot(shape.normal.xyz, direction);
  if ((cull == cull_back && facing > 0.0) || (cull == cull_front && facing < 0.0)) discard;
  float t = (shape.normal.w - dot(shape.normal.xyz, origin)) / facing;
#endif
  if (!usable(shape, origin, direction, t)) discard;
  float stored = stored_from_depth(t);
  if (stored >= map_clear_depth) discard;
  gl_FragDepth = max(stored, 0.0);
#ifdef PRIMITIVE_IDS
  primitive_id = shape.primitive;
#endif
}
