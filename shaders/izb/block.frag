// Second pass of the irregular z-buffer: one triangle (or sphere or solid, permutations SPHERE, SOLID) against the pixels of
// one texel.
#include "shared_constants.h"

layout(location = face_uniform) uniform int face;
#include "izb/izb.glsl"
#include "world.glsl"
#include "triangles.glsl"

#ifdef SPHERE
layout(location = shape_uniform) uniform int shape_index;

bool sphere_is_hole(ShadowRay ray, double t) {
#ifdef ALPHA_MASK
  vec3 p = vec3(ray.origin + t * ray.direction - izb.reference.xyz);
  return masked_hole(shape_at(shape_index).material, shape_uv(shape_at(shape_index), p));
#else
  return false;
#endif
}

// Of the receiver's own sphere only the far side can be in its way, from within (verdict.cpp, meet_sphere).
bool blocks(Receiver64 r, ShadowRay ray) {
  dvec3 center = double_shapes[shape_index].center_and_radius.xyz;
  double radius = double_shapes[shape_index].center_and_radius.w;
  double t_near, t_far;
  if (!sphere_crossings64(ray.origin, ray.direction, center, radius, t_near, t_far)) return false;
  bool own = r.primitive == shape_at(shape_index).primitive;
  if (own && !(dot(r.normal, ray.origin - center) < 0.0LF)) return false;
  bool near_counts = !own && in_range(ray, t_near) && !sphere_is_hole(ray, t_near);
  if (!near_counts && (!in_range(ray, t_far) || sphere_is_hole(ray, t_far))) return false;
  return !is_below(r, center, radius) && !is_beyond(ray, center, radius);
}
#elif defined(SOLID)
#include "izb/solid_blocks.glsl"
layout(location = shape_uniform) uniform int shape_index;

// Where the ray first meets it (verdict.cpp, solid_here).
bool solid_is_hole(ShadowRay ray, double t) {
#ifdef ALPHA_MASK
  vec3 p = vec3(ray.origin + t * ray.direction - izb.reference.xyz);
  return masked_hole(shape_at(shape_index).material, shape_uv(shape_at(shape_index), p));
#else
  return false;
#endif
}

// The reach of the solid's box from its centre along a world direction.
double reach_along(DoubleShape s, dvec3 direction) {
  return dot(abs(to_solid64(s, direction)), 0.5LF * (s.box_max.xyz - s.box_min.xyz));
}

bool blocks(Receiver64 r, ShadowRay ray) {
  ShapeData shape = shape_at(shape_index);
  DoubleShape s = double_shapes[shape_index];
  int own = 0;
  if (r.primitive == shape.primitive) {
    dvec3 local = to_solid64(s, r.position - s.center_and_radius.xyz);
    own = dot(solid_normal64(shape, s, local), r.normal) > 0.0LF ? 1 : -1;
  }
  double t;
  dvec3 origin = to_solid64(s, ray.origin - s.center_and_radius.xyz);
  if (!solid_crossed(shape, s, origin, to_solid64(s, ray.direction), ray.end, own, t) || solid_is_hole(ray, t)) return false;
  dvec3 center = s.center_and_radius.xyz + from_solid64(s, 0.5LF * (s.box_min.xyz + s.box_max.xyz));
  return !is_below(r, center, reach_along(s, r.normal)) && !is_beyond(ray, center, reach_along(s, ray.direction));
}
#else
flat in uint primitive;

bool triangle_is_hole(TriangleData t, dvec2 weights) {
#ifdef ALPHA_MASK
  double first = 1.0LF - weights.x - weights.y;
  dvec2 uv = first * dvec2(uv_of(t.a)) + weights.x * dvec2(uv_of(t.b)) + weights.y * dvec2(uv_of(t.c));
  double alpha = 1.0LF;
#ifdef VERTEX_COLORS
  alpha = first * double(color_of(t.a).a) + weights.x * double(color_of(t.b).a) + weights.y * double(color_of(t.c).a);
#endif
  return masked_hole(t.material, vec2(uv), float(alpha));
#else
  return false;
#endif
}

bool blocks(Receiver64 r, ShadowRay ray) {
  if (r.primitive == primitive) return false;
  TriangleData t = triangle_at(primitive);
  dvec3 a = vertex(t.a), b = vertex(t.b), c = vertex(t.c);
  double at;
  dvec2 weights;
  if (!sheared_crossing(ray.origin, ray.direction, a, b, c, false, at, weights) || !in_range(ray, at)) return false;
  if (triangle_is_hole(t, weights)) return false;
  return !(is_below(r, a, 0.0LF) && is_below(r, b, 0.0LF) && is_below(r, c, 0.0LF)) &&
         !(is_beyond(ray, a, 0.0LF) && is_beyond(ray, b, 0.0LF) && is_beyond(ray, c, 0.0LF));
}
#endif

void main() {
  uint link = imageLoad(heads, ivec3(ivec2(gl_FragCoord.xy), face)).r;
  while (link != 0u) {
    uint pixel = link - 1u;
    link = links[pixel].x;
    if (shadows[pixel] != 0u) continue;
    Receiver64 r = stored_receiver(pixel);
    if (blocks(r, shadow_ray(r))) shadows[pixel] = 1u;
  }
}
