// Sphere or plane (permutation SPHERE) in the camera's pass: casts the pixel's ray and writes its true depth.
#include "shared_constants.h"

layout(location = shape_uniform) uniform int shape_index;

#include "camera.glsl"
#include "world.glsl"
#include "sphere.glsl"
#ifdef ALPHA_MASK
#include "material.glsl"
#endif

layout(location = 0) out uint primitive_id;

bool usable(ShapeData shape, vec3 direction, float t) {
  if (!(t > 0.0) || isinf(t)) return false;
#ifdef ALPHA_MASK
  if (is_hole(materials[shape.material], shape_uv(shape, camera.eye_and_near.xyz + t * direction))) return false;
#endif
  return true;
}

void main() {
  ShapeData shape = shapes[shape_index];
  vec3 eye = camera.eye_and_near.xyz;
  vec3 direction = pixel_direction(gl_FragCoord.xy);
#ifdef SPHERE
  float t, t_far;
  if (!sphere_crossings(eye, direction, shape.center_and_radius.xyz, shape.center_and_radius.w, t, t_far)) discard;
  if (!usable(shape, direction, t)) t = t_far;
#else
  float t = (shape.normal.w - dot(shape.normal.xyz, eye)) / dot(shape.normal.xyz, direction);
#endif
  if (!usable(shape, direction, t)) discard;
  primitive_id = shape.primitive;
  gl_FragDepth = reversed_depth(t);
}
