// First pass of the irregular z-buffer. Each pixel's receiver, worked out as the ray tracer does, is tested against the
// infinite planes and linked into the list of the texel that it falls into. Pixels that no light can reach are left out.
#include "shared_constants.h"
layout(binding = visibility_unit) uniform usampler2D visible_primitive;
#include "izb/izb.glsl"
#include "camera.glsl"
#include "world.glsl"
#include "triangles.glsl"
#ifdef SOLIDS
#define NO_SLOPES
#include "izb/solid.glsl"
layout(binding = solid_distance_unit) uniform sampler2D solid_distance;
#endif
layout(location = triangle_count_uniform) uniform uint triangle_count;

layout(std430, binding = izb_points_buffer) writeonly buffer IzbPoints { double points[]; };  // of each pixel's receiver
layout(std430, binding = izb_normals_buffer) writeonly buffer IzbNormals { double normals64[]; };
layout(std430, binding = izb_errors_buffer) writeonly buffer IzbErrors { float errors[]; };   // rounded up
layout(std430, binding = izb_links_buffer) writeonly buffer IzbLinks { uvec2 links[]; };      // next pixel + 1, primitive

const uint no_id = 0xffffffffu;

// Not normalised: its part along the view direction is 1.
dvec3 pixel_direction64(dvec2 window) {
  double x = (2.0LF * window.x / double(izb.size.x) - 1.0LF) * izb.right_and_tan_x.w;
  double y = (1.0LF - 2.0LF * window.y / double(izb.size.y)) * izb.up_and_tan_y.w;
  return izb.forward.xyz + x * izb.right_and_tan_x.xyz + y * izb.up_and_tan_y.xyz;
}

// Where that ray starts.
dvec3 pixel_origin64(dvec2 window) {
  double x = (2.0LF * window.x / double(izb.size.x) - 1.0LF) * izb.half_extent.x;
  double y = (1.0LF - 2.0LF * window.y / double(izb.size.y)) * izb.half_extent.y;
  return izb.eye.xyz + x * izb.right_and_tan_x.xyz + y * izb.up_and_tan_y.xyz;
}

Receiver64 triangle_receiver(uint id, dvec3 origin, dvec3 direction) {
  TriangleData triangle = triangle_at(id);
  dvec3 a = vertex(triangle.a), b = vertex(triangle.b), c = vertex(triangle.c);
  Crossing at;
  sheared_crossing(origin, direction, a, b, c, true, at);
  dvec2 w = at.weights;
  double first = 1.0LF - w.x - w.y;
  dvec3 pa = first * a, pb = w.x * b, pc = w.y * c;
  Receiver64 r;
  r.position = pa + pb + pc;
  dvec3 extent = max(a, max(b, c)) - min(a, min(b, c));
  r.error = error_gamma(7) * (abs(pa) + abs(pb) + abs(pc)) + error_gamma(24) * dvec3(max_component(extent));
  dvec3 n = cross(b - a, c - a);
  r.normal = n / sqrt(dot(n, n));
  return r;
}

Receiver64 sphere_receiver(uint index, dvec3 origin, dvec3 direction) {
  dvec4 sphere = double_shape_at(index).center_and_radius;
  dvec3 center = sphere.xyz;
  double radius = sphere.w;
  double t_near, t_far;
  sphere_crossings64(origin, direction, center, radius, t_near, t_far);
  double t = t_near > 0.0LF ? t_near : t_far;
#ifdef ALPHA_MASK
  vec3 near_point = vec3(origin + t * direction - izb.reference.xyz);
  if (masked_hole(shape_at(index).material, shape_uv(shape_at(index), near_point))) t = t_far;
#endif
  dvec3 offset = origin + t * direction - center;
  dvec3 on_sphere = offset * (radius / sqrt(dot(offset, offset)));
  Receiver64 r;
  r.position = center + on_sphere;
  r.error = error_gamma(16) * abs(on_sphere) + error_gamma(2) * abs(r.position) + dvec3(error_gamma(8) * radius);
  r.normal = on_sphere / sqrt(dot(on_sphere, on_sphere));
  return r;
}

Receiver64 plane_receiver(uint index, dvec3 origin, dvec3 direction) {
  DoubleShape plane = double_shape_at(index);
  dvec3 point = plane.center_and_radius.xyz, n = plane.normal.xyz;
  dvec3 p = origin + dot(n, point - origin) / dot(n, direction) * direction;
  Receiver64 r;
  r.position = p - dot(n, p - point) * n;
  r.error = error_gamma(8) * dot(abs(n), abs(p) + abs(point)) * abs(n) + error_gamma(2) * abs(r.position);
  r.normal = n;
  return r;
}

#ifdef SOLIDS
// The impostor's crossing, followed along the ray to double precision, then put onto the surface (raytrace/shapes/solid.cpp,
// solid_point).
Receiver64 solid_receiver(uint index, dvec3 origin, dvec3 direction, double t) {
  ShapeData shape = shape_at(index);
  DoubleShape s = double_shape_at(index);
  dvec3 o = to_solid64(s, origin - s.center_and_radius.xyz), d = to_solid64(s, direction);
  double diagonal = box_diagonal64(s), cap, steepness = 0.0LF;
  int axis = -1;
  dvec3 p = o + t * d;
  dvec4 f = dvec4(0.0LF);
  for (int step = 0; step < 7; ++step) {  // four along the ray, two along the gradient, and what is left
    f = solid_gradient64(shape, s, p);
    steepness = sqrt(dot(f.xyz, f.xyz));
    if (step == 0) axis = nearest_cap(shape, s, p, f, cap);
    if (axis >= 0) {
      t = (cap - o[axis]) / d[axis];
      p = o + t * d;
      p[axis] = cap;
      break;
    }
    double along = f.w / dot(f.xyz, d);
    dvec3 move = f.w / dot(f.xyz, f.xyz) * f.xyz;
    if (step < 4) {
      if (abs(along) < 1e-4LF * diagonal) t -= along;
      p = o + t * d;
    } else if (step < 6 && dot(move, move) < 1e-6LF * diagonal * diagonal) {
      p -= move;
    }
  }
  double off = axis >= 0 ? 0.0LF : min(2.0LF * abs(f.w) / steepness, 1e-6LF * diagonal);
  if (isnan(off)) off = 1e-6LF * diagonal;
  Receiver64 r;
  r.position = s.center_and_radius.xyz + from_solid64(s, p);
  double size = max_component(abs(p)) + diagonal;
  r.error = error_gamma(8) * (abs(r.position) + abs(s.center_and_radius.xyz)) + dvec3(error_gamma(64) * size + off);
  r.normal = solid_normal64(shape, s, p);
  return r;
}
#endif

// Clearly: where the light lies in the receiver's own plane, rounding decides which way it faces, and the ray tracer's
// rounding may decide otherwise.
bool faces_away(Receiver64 r) {
#ifdef DIRECTIONAL
  dvec3 towards = -izb.light.xyz;
  double error = error_gamma(24) * dot(abs(r.normal), abs(towards));
#else
  dvec3 towards = izb.light.xyz - r.position;
  double error = error_gamma(24) * dot(abs(r.normal), abs(izb.light.xyz) + abs(r.position)) + dot(abs(r.normal), r.error);
#endif
  return !(dot(r.normal, towards) > -error);
}

// A sun's rays along a plane, but for rounding, are not blocked by it, as in the ray tracer (ambiguous_ray.cpp,
// intersects_plane).
bool plane_blocks(uint index, Receiver64 r, ShadowRay ray) {
  DoubleShape plane = double_shape_at(index);
  dvec3 point = plane.center_and_radius.xyz, n = plane.normal.xyz;
  double height = dot(n, point - ray.origin);
  double slope = dot(n, ray.direction);
  dvec3 error = r.error + abs(ray.origin - r.position);
  if (abs(height) <= dot(abs(n), error_gamma(5) * abs(point - ray.origin) + error)) return false;  // it lies on the plane
#ifdef DIRECTIONAL
  if (abs(slope) <= error_gamma(8) * dot(abs(n), abs(ray.direction))) return false;
#endif
  double t = height / slope;
  if (!in_range(ray, t)) return false;
#ifdef ALPHA_MASK
  vec3 p = vec3(ray.origin + t * ray.direction - izb.reference.xyz);
  if (masked_hole(shape_at(index).material, shape_uv(shape_at(index), p))) return false;
#endif
  return true;
}

bool planes_block(Receiver64 r) {
  ShadowRay ray = shadow_ray(r);
  for (uint i = 0u; i < uint(izb.size.w); ++i) {
    if (shape_at(i).kind != uint(shape_plane) || shape_at(i).primitive == r.primitive) continue;
#ifdef NON_CASTERS
    if (!casts_shadow(shape_at(i).material)) continue;
#endif
    if (plane_blocks(i, r, ray)) return true;
  }
  return false;
}

int grid_face(dvec3 position) {
#ifdef CUBE
  dvec3 d = position - izb.origin.xyz;
  dvec3 a = abs(d);
  if (a.x >= a.y && a.x >= a.z) return d.x >= 0.0LF ? 0 : 1;
  if (a.y >= a.z) return d.y >= 0.0LF ? 2 : 3;
  return d.z >= 0.0LF ? 4 : 5;
#else
  return 0;
#endif
}

void main() {
  uint pixel = uint(gl_FragCoord.y) * uint(izb.size.x) + uint(gl_FragCoord.x);
  uint primitive = texelFetch(visible_primitive, ivec2(window_position(gl_FragCoord)), 0).r;
  shadows[pixel] = 0u;
  if (primitive == no_id) return;
  dvec2 window = floor(dvec2(window_position(gl_FragCoord))) + 0.5LF;
  dvec3 origin = pixel_origin64(window), direction = pixel_direction64(window);
  double length = sqrt(dot(direction, direction));
  direction /= length;
  Receiver64 r;
  if (primitive < triangle_count) r = triangle_receiver(primitive, origin, direction);
  else if (shape_at(primitive - triangle_count).kind == uint(shape_plane))
    r = plane_receiver(primitive - triangle_count, origin, direction);
#ifdef SOLIDS
  else if (shape_at(primitive - triangle_count).kind >= uint(shape_quadric)) {
    double t = double(texelFetch(solid_distance, ivec2(window_position(gl_FragCoord)), 0).r) * length;
    r = solid_receiver(primitive - triangle_count, origin, direction, t);
  }
#endif
  else r = sphere_receiver(primitive - triangle_count, origin, direction);
  if (dot(r.normal, direction) > 0.0LF) r.normal = -r.normal;
  r.primitive = primitive;
  if (faces_away(r)) return;
  if (planes_block(r)) {
    shadows[pixel] = 1u;
    return;
  }
  int face = grid_face(r.position);
  dvec3 at = on_grid(face, r.position);
#ifdef PERSPECTIVE
  if (!(at.z > 0.0LF)) return;
#endif
#ifdef CUBE
  at.xy = clamp(at.xy, dvec2(0.0LF), dvec2(double(izb.size.z) - 0.5LF));
#endif
  if (any(lessThan(at.xy, dvec2(0.0LF))) || any(greaterThanEqual(at.xy, dvec2(double(izb.size.z))))) return;
  uint i = 3u * pixel;
  for (int k = 0; k < 3; ++k) {
    points[i + uint(k)] = r.position[k];
    normals64[i + uint(k)] = r.normal[k];
    errors[i + uint(k)] = float(r.error[k]) * (1.0 + 2e-7);
  }
  uint next = imageAtomicExchange(heads, ivec3(ivec2(at.xy), face), pixel + 1u);
  links[pixel] = uvec2(next, primitive);
}
