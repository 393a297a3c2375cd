// The surface point of a pixel, from the primitive that the rasterizer found visible there. It is the exact meeting of
// the pixel's ray with the primitive's plane or sphere, rather than an interpolated position (Burns and Hunt 2013, "The Visibility
// Buffer"). Permutations SMOOTH_NORMALS (some mesh has normals), VERTEX_COLORS (some mesh has them), TEXTURES and
// ALPHA_MASK.

#include "camera.glsl"
#include "world.glsl"
#include "sphere.glsl"
#ifdef SOLIDS
#include "solid_surface.glsl"
#endif
#include "material.glsl"
#include "triangles.glsl"

struct Receiver {
  vec3 position;   // relative to the frame's reference
  vec3 normal;     // geometric, unit, on the viewer's side
  vec3 shading;    // shading normal, on the geometric normal's side
  vec3 to_eye;     // unit
  vec2 uv;
#ifdef VERTEX_COLORS
  vec4 color;
#endif
  uint material;
};

vec3 face_forward(vec3 n, vec3 direction) { return dot(n, direction) > 0.0 ? -n : n; }

// Where the ray meets the plane n . p = d, put back onto the plane. A rounding error then moves the point along the
// surface, by far less than a pixel, and not off it, which a shadow test would see.
vec3 meet_plane(vec3 origin, vec3 direction, vec3 n, float d, float t_min, float t_max) {
  float t = (d - dot(n, origin)) / dot(n, direction);
  // A sliver seen edge-on can be drawn where the ray meets its plane far away: keep to the primitive's own depths.
  t = t > t_min ? min(t, t_max) : t_min;
  vec3 p = origin + t * direction;
  return p - n * (dot(n, p) - d);
}

void interpolate(TriangleData t, vec3 a, vec3 b, vec3 c, inout Receiver r) {
#if defined(SMOOTH_NORMALS) || defined(TEXTURES) || defined(VERTEX_COLORS)
  vec3 n = cross(b - a, c - a);
  float area = dot(n, n);
  float wb = clamp(dot(cross(r.position - a, c - a), n) / area, 0.0, 1.0);
  float wc = clamp(dot(cross(b - a, r.position - a), n) / area, 0.0, 1.0 - wb);
  float wa = 1.0 - wb - wc;
#ifdef SMOOTH_NORMALS
  vec3 shading = wa * normal_of(t, t.a) + wb * normal_of(t, t.b) + wc * normal_of(t, t.c);
  if (dot(shading, shading) > 0.0) {
    shading = normalize(shading);
    r.shading = dot(shading, r.normal) < 0.0 ? -shading : shading;
  }
#endif
#ifdef TEXTURES
  r.uv = wa * uv_of(t.a) + wb * uv_of(t.b) + wc * uv_of(t.c);
#endif
#ifdef VERTEX_COLORS
  r.color = wa * color_of(t.a) + wb * color_of(t.b) + wc * color_of(t.c);
#endif
#endif
}

Receiver triangle_receiver(uint id, vec3 origin, vec3 direction) {
  Receiver r;
  TriangleData t = triangle_at(id);
  vec3 a = position_of(t, t.a), b = position_of(t, t.b), c = position_of(t, t.c);
  vec3 eye = camera.eye_and_reach.xyz;
  vec3 depths = vec3(dot(camera.forward.xyz, a - eye), dot(camera.forward.xyz, b - eye),
                     dot(camera.forward.xyz, c - eye));
  float t_min = min(depths.x, min(depths.y, depths.z)), t_max = max(depths.x, max(depths.y, depths.z));
  vec4 plane = plane_of(id, t);
  r.position = meet_plane(origin, direction, plane.xyz, plane.w, max(t_min, 0.0), t_max);
  r.normal = face_forward(plane.xyz, direction);
  r.shading = r.normal;
  r.uv = vec2(0.0);
  r.material = t.material;
  interpolate(t, a, b, c, r);
  return r;
}

#ifdef SOLIDS
layout(binding = solid_distance_unit) uniform sampler2D solid_distance;

// Where the pixel's ray meets the solid, as its impostor found, put back onto it. Nothing is searched for again, so that
// this program stays small.
vec3 solid_receiver(ShapeData shape, vec3 origin, vec3 direction, out vec3 normal) {
  float t = texelFetch(solid_distance, ivec2(window_position(gl_FragCoord)), 0).r;
  vec3 p = to_solid(shape, origin + t * direction - shape.center_and_radius.xyz);
  normal = from_solid(shape, solid_surface(shape, p));
  return shape.center_and_radius.xyz + from_solid(shape, p);
}
#endif

Receiver shape_receiver(ShapeData shape, vec3 origin, vec3 direction) {
  Receiver r;
  if (shape.kind == uint(shape_plane)) {
    r.position = meet_plane(origin, direction, shape.normal.xyz, shape.normal.w, 0.0, infinite);
    r.normal = face_forward(shape.normal.xyz, direction);
#ifdef SOLIDS
  } else if (shape.kind >= uint(shape_quadric)) {
    r.position = solid_receiver(shape, origin, direction, r.normal);
    r.normal = face_forward(r.normal, direction);
#endif
  } else {
    vec3 center = shape.center_and_radius.xyz;
    float t_near, t_far;
    sphere_crossings(origin, direction, center, shape.center_and_radius.w, t_near, t_far);
    float t = t_near > 0.0 ? t_near : t_far;
#ifdef ALPHA_MASK
    if (is_hole(material_at(shape.material), shape_uv(shape, origin + t * direction))) t = t_far;
#endif
    vec3 outward = normalize(origin + t * direction - center);
    r.position = center + shape.center_and_radius.w * outward;  // put back onto the sphere, as in meet_plane
    r.normal = face_forward(outward, direction);
  }
  r.shading = r.normal;
#ifdef TEXTURES
  r.uv = shape_uv(shape, r.position);
#else
  r.uv = vec2(0.0);
#endif
#ifdef VERTEX_COLORS
  r.color = vec4(1.0);
#endif
  r.material = shape.material;
  return r;
}

Receiver receiver_at(uint primitive, vec2 window) {
  vec3 origin = pixel_origin(window), direction = pixel_direction(window);
  uint triangle_count = camera.counts.x;
  Receiver r;
  if (primitive < triangle_count)
    r = triangle_receiver(primitive, origin, direction);
  else
    r = shape_receiver(shape_at(primitive - triangle_count), origin, direction);
  r.to_eye = normalize(-direction);
  return r;
}
