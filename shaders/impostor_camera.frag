// Sphere, plane or solid (permutations SPHERE, SOLID) in the camera's pass: casts the pixel's ray and writes its true depth.
#include "shared_constants.h"

layout(location = shape_uniform) uniform int shape_index;
layout(location = shape_in_frame_uniform) uniform vec4 shape_in_frame;  // relative to the eye: centre and radius, or normal and offset

#include "camera.glsl"
#include "world.glsl"
#include "sphere.glsl"
#ifdef SOLID
layout(location = solid_from_frame_uniform) uniform mat4 solid_from_frame;  // local from relative to the eye
#include "solid.glsl"
#endif
#ifdef ALPHA_MASK
#include "material.glsl"
#endif

layout(location = primitive_output) out uint primitive_id;
#ifdef SOLID
layout(location = solid_distance_output) out float solid_distance;
#endif

bool usable(vec3 direction, float t) {
  if (!(t > 0.0) || isinf(t)) return false;
#ifdef ALPHA_MASK
  ShapeData shape = shape_at(uint(shape_index));
  if (is_hole(material_at(shape.material), shape_uv(shape, pixel_origin(gl_FragCoord.xy) + t * direction))) return false;
#endif
  return true;
}

void main() {
  vec3 from_eye = pixel_offset(gl_FragCoord.xy), direction = pixel_direction(gl_FragCoord.xy);
#ifdef SOLID
  ShapeData shape = shape_at(uint(shape_index));
  vec3 local_origin = mat3(solid_from_frame) * from_eye + solid_from_frame[3].xyz;
  vec3 local_direction = mat3(solid_from_frame) * direction;
  float t, from = 0.0;
  bool found = false;
  for (int side = 0; side < most_sides && !found; ++side) {
    if (!solid_next(shape, local_origin, local_direction, from, t)) discard;
    found = usable(direction, t);
    from = solid_after(shape, local_direction, t);
  }
#elif defined(SPHERE)
  float t, t_far;
  if (!sphere_crossings(from_eye, direction, shape_in_frame.xyz, shape_in_frame.w, t, t_far)) discard;
  if (!usable(direction, t)) t = t_far;
#else
  float t = (shape_in_frame.w - dot(shape_in_frame.xyz, from_eye)) / dot(shape_in_frame.xyz, direction);
#endif
  if (!usable(direction, t)) discard;
  primitive_id = shape_at(uint(shape_index)).primitive;
#ifdef SOLID
  solid_distance = t;
#endif
  gl_FragDepth = reversed_depth(t);
}
