// Second pass of the irregular z-buffer: one triangle (or sphere or solid, permutations SPHERE, SOLID) against the pixels of
// one texel.
#include "shared_constants.h"

layout(location = face_uniform) uniform int face;
#include "izb/izb.glsl"
#include "world.glsl"
#include "triangles.glsl"

// What the first pass stored.
layout(binding = izb_points_unit) uniform usamplerBuffer point_bits;
layout(binding = izb_normals_unit) uniform usamplerBuffer normal_bits;
layout(binding = izb_errors_unit) uniform samplerBuffer error_texels;
layout(binding = izb_links_unit) uniform usamplerBuffer link_texels;

Receiver64 stored_receiver(uint pixel, uint primitive) {
  return Receiver64(three_doubles(point_bits, pixel), three_doubles(normal_bits, pixel),
                    dvec3(texelFetch(error_texels, int(pixel)).xyz), primitive);
}

// A `Blocker` is what each pixel of a texel is tested against, read once for all of them.
#ifdef SPHERE
layout(location = shape_uniform) uniform int shape_index;

struct Blocker {
  ShapeData shape;
  dvec3 center;
  double radius;
};

Blocker blocker() {
  dvec4 sphere = double_shape_at(shape_index).center_and_radius;
  return Blocker(shape_at(shape_index), sphere.xyz, sphere.w);
}

bool sphere_is_hole(ShapeData shape, ShadowRay ray, double t) {
#ifdef ALPHA_MASK
  vec3 p = vec3(ray.origin + t * ray.direction - izb.reference.xyz);
  return masked_hole(shape.material, shape_uv(shape, p));
#else
  return false;
#endif
}

// Of the sphere that the receiver lies on, its own or an equal surface, only the far side can be in its way, from within
// (ambiguous_ray.cpp, start_on).
bool blocks(Blocker sphere, Receiver64 r, ShadowRay ray) {
  double t_near, t_far;
  if (!sphere_crossings64(ray.origin, ray.direction, sphere.center, sphere.radius, t_near, t_far)) return false;
  dvec3 offset = r.position - sphere.center;
  bool own = r.primitive == sphere.shape.primitive ||
             abs(sqrt(dot(offset, offset)) - sphere.radius) <= lies_on_within(r, sphere.center, sphere.radius);
  if (own && !(dot(r.normal, ray.origin - sphere.center) < 0.0LF)) return false;
  bool near_counts = !own && in_range(ray, t_near) && !sphere_is_hole(sphere.shape, ray, t_near);
  if (!near_counts && (!in_range(ray, t_far) || sphere_is_hole(sphere.shape, ray, t_far))) return false;
  return !is_below(r, sphere.center, sphere.radius) && !is_beyond(ray, sphere.center, sphere.radius);
}
#elif defined(SOLID)
#include "izb/solid_blocks.glsl"
layout(location = shape_uniform) uniform int shape_index;

struct Blocker {
  ShapeData shape;
  DoubleShape s;
};

Blocker blocker() { return Blocker(shape_at(shape_index), double_shape_at(shape_index)); }

// Where the ray first meets it (solid_visibility.cpp, intersects_solid).
bool solid_is_hole(ShapeData shape, ShadowRay ray, double t) {
#ifdef ALPHA_MASK
  vec3 p = vec3(ray.origin + t * ray.direction - izb.reference.xyz);
  return masked_hole(shape.material, shape_uv(shape, p));
#else
  return false;
#endif
}

// The reach of the solid's box from its centre along a world direction.
double reach_along(DoubleShape s, dvec3 direction) {
  return dot(abs(to_solid64(s, direction)), 0.5LF * (s.box_max.xyz - s.box_min.xyz));
}

// The receiver lies on it, which is its own or the same surface in another description (solid_visibility.cpp).
bool starts_on(ShapeData shape, DoubleShape s, Receiver64 r, dvec3 local) {
  if (r.primitive == shape.primitive) return true;
  double within = lies_on_within(r, s.center_and_radius.xyz, box_diagonal64(s));
  if (any(lessThan(local, s.box_min.xyz - within)) || any(greaterThan(local, s.box_max.xyz + within))) return false;
  dvec4 f = solid_gradient64(shape, s, local);
  double cap, height = f.w / sqrt(dot(f.xyz, f.xyz));
  int axis = nearest_cap(shape, s, local, f, cap);
  return axis < 0 ? abs(height) <= within : height <= within && abs(local[axis] - cap) <= within;
}

bool blocks(Blocker solid, Receiver64 r, ShadowRay ray) {
  ShapeData shape = solid.shape;
  DoubleShape s = solid.s;
  int own = 0;
  dvec3 local = to_solid64(s, r.position - s.center_and_radius.xyz);
  if (starts_on(shape, s, r, local)) {
    own = dot(solid_normal64(shape, s, local), r.normal) > 0.0LF ? 1 : -1;
    if (own == 1 && s.center_and_radius.w != 0.0LF) return false;  // nothing convex shadows its own outside
  }
  double t;
  dvec3 origin = to_solid64(s, ray.origin - s.center_and_radius.xyz);
  if (!solid_crossed(shape, s, origin, to_solid64(s, ray.direction), ray.end, own, t) ||
      solid_is_hole(shape, ray, t))
    return false;
  dvec3 center = s.center_and_radius.xyz + from_solid64(s, 0.5LF * (s.box_min.xyz + s.box_max.xyz));
  return !is_below(r, center, reach_along(s, r.normal)) && !is_beyond(ray, center, reach_along(s, ray.direction));
}
#else
flat in uint primitive;

struct Blocker {
  TriangleData t;
  dvec3 a, b, c;
};

Blocker blocker() {
  TriangleData t = triangle_at(primitive);
  return Blocker(t, vertex(t.a), vertex(t.b), vertex(t.c));
}

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

bool blocks(Blocker caster, Receiver64 r, ShadowRay ray) {
  if (r.primitive == primitive) return false;
  Crossing at;
  if (!sheared_crossing(ray.origin, ray.direction, caster.a, caster.b, caster.c, false, at) || !in_range(ray, at.first) ||
      !in_range(ray, at.last))
    return false;
  if (triangle_is_hole(caster.t, at.weights)) return false;
  return !(is_below(r, caster.a, 0.0LF) && is_below(r, caster.b, 0.0LF) && is_below(r, caster.c, 0.0LF)) &&
         !(is_beyond(ray, caster.a, 0.0LF) && is_beyond(ray, caster.b, 0.0LF) && is_beyond(ray, caster.c, 0.0LF));
}
#endif

void main() {
  Blocker tested = blocker();
  uint link = imageLoad(heads, ivec3(ivec2(gl_FragCoord.xy), face)).r;
  while (link != 0u) {
    uint pixel = link - 1u;
    uvec2 next_and_primitive = texelFetch(link_texels, int(pixel)).xy;
    link = next_and_primitive.x;
    if (shadows[pixel] != 0u) continue;
    Receiver64 r = stored_receiver(pixel, next_and_primitive.y);
    if (blocks(tested, r, shadow_ray(r))) shadows[pixel] = 1u;
  }
}
