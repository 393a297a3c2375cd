// Second pass of the irregular z-buffer: the rectangle of whole texels around each triangle, six vertices for each. A
// triangle that reaches behind a point or spot light covers the whole face unless it lies beside the face's pyramid. One
// without an area covers nothing: with the light on it, rounding would have it in the way of every receiver.
#include "shared_constants.h"
#include "izb/izb.glsl"
#include "triangles.glsl"
layout(location = face_uniform) uniform int face;
flat out uint primitive;

// More than rounding of a grid position, texels.
const double slack = 1e-6LF;

dvec3 local(dvec3 position) {
  dvec3 d = position - izb.origin.xyz;
  return dvec3(dot(d, izb.face_right[face].xyz) / izb.face_right[face].w, dot(d, izb.face_up[face].xyz) / izb.face_up[face].w,
               dot(d, izb.face_forward[face].xyz));
}

bool all_beyond(dvec3 a, dvec3 b, dvec3 c) {
  double tiny = 1e-9LF * (max_component(abs(a)) + max_component(abs(b)) + max_component(abs(c)));
  return (a.x > a.z + tiny && b.x > b.z + tiny && c.x > c.z + tiny) ||
         (-a.x > a.z + tiny && -b.x > b.z + tiny && -c.x > c.z + tiny) ||
         (a.y > a.z + tiny && b.y > b.z + tiny && c.y > c.z + tiny) ||
         (-a.y > a.z + tiny && -b.y > b.z + tiny && -c.y > c.z + tiny) ||
         (a.z < -tiny && b.z < -tiny && c.z < -tiny);
}

// Low and high corner in texels; low above high for nothing.
void texel_rectangle(dvec3 a, dvec3 b, dvec3 c, out dvec2 low, out dvec2 high) {
  double size = double(izb.size.z);
  low = dvec2(0.0LF);
  high = dvec2(size);
#ifdef PERSPECTIVE
  if (all_beyond(a, b, c)) {
    low = dvec2(1.0LF), high = dvec2(0.0LF);
    return;
  }
  double depth = min(a.z, min(b.z, c.z));
  if (!(depth > 1e-9LF * (abs(a.z) + abs(b.z) + abs(c.z)))) return;
  a.xy /= a.z, b.xy /= b.z, c.xy /= c.z;
#endif
  dvec2 least = min(a.xy, min(b.xy, c.xy)), most = max(a.xy, max(b.xy, c.xy));
  low = clamp(floor(0.5LF * (least + 1.0LF) * size - slack), dvec2(0.0LF), dvec2(size));
  high = clamp(floor(0.5LF * (most + 1.0LF) * size + slack) + 1.0LF, dvec2(0.0LF), dvec2(size));
}

// Twin of scene/world.cpp.
bool has_surface(dvec3 a, dvec3 b, dvec3 c) {
  precise dvec3 n = cross(b - a, c - a);
  precise double size2 = dot(n, n);
  return size2 > 0.0LF && !isinf(size2);
}

void main() {
  primitive = uint(gl_VertexID) / 6u;
  TriangleData t = triangle_at(primitive);
  dvec2 low, high;
  dvec3 a = vertex(t.a), b = vertex(t.b), c = vertex(t.c);
  texel_rectangle(local(a), local(b), local(c), low, high);
  int corner = gl_VertexID % 6;  // 0 1 2, 2 1 3 of a strip
  bool right = corner == 1 || corner == 4 || corner == 5, top = corner == 2 || corner == 3 || corner == 5;
  dvec2 at = dvec2(right ? high.x : low.x, top ? high.y : low.y);
  bool empty = low.x >= high.x || low.y >= high.y || !has_surface(a, b, c);
#ifdef NON_CASTERS
  empty = empty || !casts_shadow(t.material);
#endif
  gl_Position = empty ? vec4(0.0, 0.0, 0.0, 1.0) : vec4(vec2(2.0LF * at / double(izb.size.z) - 1.0LF), 0.5, 1.0);
}
