// Sphere, plane or solid (permutations SPHERE, SOLID) in a light's depth map: casts the ray through the texel's centre and writes its true
// depth. Culling leaves out the shape's front or back side as seen by the light. A caster before the map's near depth
// is stored at it, one beyond the far depth is not stored.
#include "shared_constants.h"

layout(location = shape_uniform) uniform int shape_index;
layout(location = face_uniform) uniform int face;
layout(location = cull_uniform) uniform int cull;
layout(location = shape_in_frame_uniform) uniform vec4 shape_in_frame;  // centre and radius, or normal and offset

#include "light_map.glsl"
#include "world.glsl"
#include "sphere.glsl"
#ifdef SOLID
layout(location = solid_from_frame_uniform) uniform mat4 solid_from_frame;  // local from the face's frame
#include "solid.glsl"
#endif
#ifdef ALPHA_MASK
#include "material.glsl"
#endif
#ifdef PEEL
#include "peel.glsl"
#endif
#ifdef CASTER_BIAS
#include "caster_bias.glsl"
#endif

// Ray of a texel in the face's own frame (right, up, forward); t along it is the depth in both projections.
struct TexelRay {
  vec3 origin, direction;
};

TexelRay texel_ray(vec2 at) {
  vec2 offset = (2.0 * at / light.origin_and_size.w - 1.0) * light.extent_and_depths[face].xy;
#ifdef WARP
  offset.y = unwarped(face, offset.y);
  offset.x *= warp_divisor(face, offset.y);
#endif
#ifdef PERSPECTIVE
  return TexelRay(vec3(0.0), vec3(offset, 1.0));
#else
  return TexelRay(vec3(offset, 0.0), vec3(0.0, 0.0, 1.0));
#endif
}

#ifdef CASTER_BIAS
vec3 normal_at(vec3 p) {
#ifdef SOLID
  return transpose(mat3(solid_from_frame)) * solid_surface(shape_at(uint(shape_index)), (solid_from_frame * vec4(p, 1.0)).xyz);
#elif defined(SPHERE)
  return p - shape_in_frame.xyz;
#else
  return shape_in_frame.xyz;
#endif
}

// By how much the stored depth of the plane through p with normal n changes over the texel along `axis`. Infinite where
// the plane is edge-on over it.
float slope_along(vec2 axis, vec3 p, vec3 n) {
  float stored[2], facing[2];
  for (int i = 0; i < 2; ++i) {
    vec2 at = gl_FragCoord.xy + (float(i) - 0.5) * axis;
    TexelRay ray = texel_ray(at);
    facing[i] = dot(n, ray.direction);
    stored[i] = stored_at(face, at.y, dot(n, p - ray.origin) / facing[i]);
  }
  return facing[0] * facing[1] > 0.0 ? abs(stored[1] - stored[0]) : uintBitsToFloat(0x7f800000u);
}
#endif

bool usable(TexelRay ray, float t) {
#ifdef PERSPECTIVE
  if (!(t > 0.0)) return false;
#endif
  if (isnan(t) || isinf(t)) return false;
#ifdef PEEL
  if (!lies_behind(clamp(stored_from_depth(ivec3(gl_FragCoord.xy, face), t), 0.0, 1.0))) return false;
#endif
#ifdef ALPHA_MASK
  ShapeData shape = shape_at(uint(shape_index));
  vec3 p = ray.origin + t * ray.direction;
  vec3 position = light.origin_and_warp[face].xyz + p.x * light.right[face].xyz + p.y * light.up[face].xyz +
                  p.z * light.forward[face].xyz;
  if (is_hole(material_at(shape.material), shape_uv(shape, position))) return false;
#endif
  return true;
}

void main() {
  TexelRay ray = texel_ray(gl_FragCoord.xy);
#ifdef SOLID
  ShapeData shape = shape_at(uint(shape_index));
  vec3 local_origin = (solid_from_frame * vec4(ray.origin, 1.0)).xyz, local_direction = mat3(solid_from_frame) * ray.direction;
#ifdef PERSPECTIVE
  float from = 0.0;
#else
  float from = -infinite_t;
#endif
  float t;
  bool found = false;
  for (int side = 0; side < most_sides && !found; ++side) {
    if (!solid_next(shape, local_origin, local_direction, from, t)) discard;
    found = usable(ray, t);
    if (found && cull != cull_none) {
      vec3 p = local_origin + t * local_direction;
      bool faces_light = dot(solid_surface(shape, p), local_direction) < 0.0;
      found = faces_light == (cull == cull_back);
    }
    from = solid_after(shape, local_direction, t);
  }
  if (!found) discard;
#elif defined(SPHERE)
  float t_near, t_far;
  if (!sphere_crossings(ray.origin, ray.direction, shape_in_frame.xyz, shape_in_frame.w, t_near, t_far)) discard;
  bool near_counts = cull != cull_front && usable(ray, t_near);
  if (!near_counts && cull == cull_back) discard;
  float t = near_counts ? t_near : t_far;
#else
  float facing = dot(shape_in_frame.xyz, ray.direction);
  if ((cull == cull_back && facing > 0.0) || (cull == cull_front && facing < 0.0)) discard;
  float t = (shape_in_frame.w - dot(shape_in_frame.xyz, ray.origin)) / facing;
#endif
  if (!usable(ray, t)) discard;
  float stored = stored_from_depth(ivec3(gl_FragCoord.xy, face), t);
  if (!holds_caster(stored)) discard;
  stored = clamp(stored, 0.0, 1.0);
#ifdef CASTER_BIAS
  vec3 p = ray.origin + t * ray.direction, n = normal_at(p);
  stored = biased_caster(stored, max(slope_along(vec2(1.0, 0.0), p, n), slope_along(vec2(0.0, 1.0), p, n)));
#endif
  gl_FragDepth = stored;
}
