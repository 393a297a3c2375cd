// The irregular z-buffer (Johnson et al. 2005, "The irregular Z-buffer: Hardware acceleration for irregular data
// structures"; Story 2015, "Hybrid Ray-Traced Shadows"). Each texel of a light's grid holds the list of the pixels whose
// receivers fall into it, and each triangle tests the pixels of every texel that it touches. Everything is in world space
// and double precision; receivers, shadow rays and tests follow ray_offset.h and visibility.cpp in raytrace/precision,
// tracer.cpp and shapes/intersect.h, so that they decide like the ray tracer wherever that one is certain. Twin of raster/passes/izb_pass.cpp.

layout(std140, binding = izb_block) uniform Izb {
  dvec4 eye;
  dvec4 right_and_tan_x;
  dvec4 up_and_tan_y;
  dvec4 forward;
  dvec4 half_extent;   // of an orthographic picture; 0 of a pinhole camera
  dvec4 light;         // position, or (directional) the way that light travels
  dvec4 reference;     // of what the other shaders see
  dvec4 origin;        // of the grid
  dvec4 face_right[6];    // w: half extent along it
  dvec4 face_up[6];
  dvec4 face_forward[6];
  ivec4 size;          // image width and height, texels on a side, shapes
} izb;

// What both passes read lies in buffer textures, which hold more than a storage block and, in software, are read by many
// pixels at a time. Three doubles are two texels of three words.
layout(binding = izb_vertices_unit) uniform usamplerBuffer vertex_bits;
layout(binding = izb_shapes_unit) uniform usamplerBuffer double_shape_bits;
struct DoubleShape {         // as ShapeData (world.glsl), in the world
  dvec4 center_and_radius;  // of a sphere; of a plane: a point; of a solid: its origin, and 1 if it is convex
  dvec4 normal;             // of a plane; or a solid's local z axis
  dvec4 tangent;            // of a solid: its local x and y axes
  dvec4 bitangent;
  dvec4 coefficients;       // quadric: of x^2, y^2, z^2, z; torus: both radii
  dvec4 box_min;            // of a solid, local; w: a quadric's constant
  dvec4 box_max;            // w: solid_open, solid_closed, solid_uncut
};
layout(std430, binding = izb_shadows_buffer) buffer IzbShadows { uint shadows[]; };  // of each pixel
layout(r32ui, binding = izb_heads_image) uniform uimage2DArray heads;                // first pixel + 1

const double no_end = 1e300LF;

double error_gamma(int operations) {
  double e = double(operations) * 1.1102230246251565e-16LF;
  return e / (1.0LF - e);
}

double max_component(dvec3 v) { return max(v.x, max(v.y, v.z)); }

dvec3 three_doubles(usamplerBuffer bits, uint index) {
  uvec3 first = texelFetch(bits, int(2u * index)).xyz, last = texelFetch(bits, int(2u * index + 1u)).xyz;
  return dvec3(packDouble2x32(first.xy), packDouble2x32(uvec2(first.z, last.x)), packDouble2x32(last.yz));
}

dvec3 vertex(uint i) { return three_doubles(vertex_bits, i); }

dvec4 double_shape_texels(int at) {
  uvec4 first = texelFetch(double_shape_bits, at), last = texelFetch(double_shape_bits, at + 1);
  return dvec4(packDouble2x32(first.xy), packDouble2x32(first.zw), packDouble2x32(last.xy), packDouble2x32(last.zw));
}

DoubleShape double_shape_at(uint index) {
  int at = int(index) * double_shape_texel_count;
  return DoubleShape(double_shape_texels(at), double_shape_texels(at + 2), double_shape_texels(at + 4),
                     double_shape_texels(at + 6), double_shape_texels(at + 8), double_shape_texels(at + 10),
                     double_shape_texels(at + 12));
}

struct Receiver64 {
  dvec3 position, normal, error;
  uint primitive;
};

struct ShadowRay {
  dvec3 origin, direction;
  double end;  // hits count in (0, end)
};

ShadowRay shadow_ray(Receiver64 r) {
  dvec3 origin = r.position + dot(abs(r.normal), r.error) * r.normal;  // only receivers that face the light are asked for
#ifdef DIRECTIONAL
  return ShadowRay(origin, -izb.light.xyz, no_end);
#else
  dvec3 way = izb.light.xyz - origin;
  double distance = sqrt(dot(way, way));
  double error = error_gamma(8) * distance + dot(r.error + abs(origin - r.position), dvec3(1.0LF));
  return ShadowRay(origin, way / distance, distance - error);
#endif
}

bool in_range(ShadowRay ray, double t) { return t > 0.0LF && t < ray.end; }

// Nothing at or below the receiver's tangent plane, but for rounding, can be in its way (ambiguous_ray.cpp, below_horizon).
bool is_below(Receiver64 r, dvec3 p, double radius) {
  dvec3 d = p - r.position;
  double bound = error_gamma(8) * (dot(abs(r.normal), abs(d)) + radius) + dot(abs(r.normal), r.error);
  return dot(r.normal, d) + radius <= bound;
}

// How far off a surface of this place and size a receiver may be computed to lie that lies on it.
double lies_on_within(Receiver64 r, dvec3 place, double size) {
  dvec3 one = dvec3(1.0LF);
  return 2.0LF * dot(r.error, one) + error_gamma(16) * (dot(abs(r.position) + abs(place), one) + size);
}

// Nor anything wholly beyond the light (ambiguous_ray.cpp, beyond_light).
bool is_beyond(ShadowRay ray, dvec3 p, double radius) {
#ifdef DIRECTIONAL
  return false;
#else
  dvec3 offset = p - ray.origin;
  double reach = radius * sqrt(dot(ray.direction, ray.direction));
  double end = ray.end * dot(ray.direction, ray.direction);
  double bound = error_gamma(8) * (dot(abs(ray.direction), abs(offset)) + reach + abs(end));
  return dot(ray.direction, offset) - reach >= end - bound;
#endif
}

// The axes in an order that puts the direction's largest component last (intersect.h).
int largest_axis(dvec3 d) {
  dvec3 a = abs(d);
  int axis = a.x >= a.y ? 0 : 1;
  return a.z > (axis == 0 ? a.x : a.y) ? 2 : axis;
}
dvec3 permuted(dvec3 v, int last) { return last == 0 ? v.yzx : last == 1 ? v.zxy : v; }

// Where a ray crosses a triangle: `t` in multiples of the direction, and `first` and `last` between which it lies whatever was
// rounded; the weights of the second and third corner.
struct Crossing {
  double t, first, last;
  dvec2 weights;
};

// The roundings of the three edge functions together (ambiguous_ray.cpp, intersects_triangle).
double edge_error(dvec2 shear, dvec3 a, dvec3 b, dvec3 c, dvec2 p, dvec2 q, dvec2 r) {
  dvec3 reach = max(abs(a), max(abs(b), abs(c)));
  dvec2 error = error_gamma(12) * (reach.xy + abs(shear) * reach.z);
  return 2.0LF * dot(error.yx, abs(p) + abs(q) + abs(r));
}

// Woop, Benthin, Wald 2013. `anywhere`: of the triangle's plane.
bool sheared_crossing(dvec3 origin, dvec3 direction, dvec3 a, dvec3 b, dvec3 c, bool anywhere, out Crossing crossing) {
  int last = largest_axis(direction);
  dvec3 d = permuted(direction, last);
  dvec2 shear = d.xy / d.z;
  a = permuted(a - origin, last), b = permuted(b - origin, last), c = permuted(c - origin, last);
  precise dvec2 p = a.xy - shear * a.z;
  precise dvec2 q = b.xy - shear * b.z;
  precise dvec2 r = c.xy - shear * c.z;
  precise double u = r.x * q.y - r.y * q.x;
  precise double v = p.x * r.y - p.y * r.x;
  precise double w = q.x * p.y - q.y * p.x;
  crossing = Crossing(0.0LF, 0.0LF, 0.0LF, dvec2(0.0LF));
  if (!anywhere && (u < 0.0LF || v < 0.0LF || w < 0.0LF) && (u > 0.0LF || v > 0.0LF || w > 0.0LF)) return false;
  double det = u + v + w;
  if (det == 0.0LF) return false;
  double z = (u * a.z + v * b.z + w * c.z) / det;
  double low = min(a.z, min(b.z, c.z)), high = max(a.z, max(b.z, c.z));
  double error = edge_error(shear, a, b, c, p, q, r), spread = high - low;
  if (abs(det) > 2.0LF * error) spread = 2.0LF * error / (abs(det) - error) * (high - low) + error_gamma(8) * abs(z);
  dvec2 ends = dvec2(max(low, z - spread), min(high, z + spread)) / d.z;
  crossing = Crossing(clamp(z, low, high) / d.z, min(ends.x, ends.y), max(ends.x, ends.y), dvec2(v, w) / det);
  return true;
}

// Both crossings, near one first, after Haines et al. 2019 (intersect.h).
bool sphere_crossings64(dvec3 origin, dvec3 d, dvec3 center, double radius, out double t_near, out double t_far) {
  dvec3 offset = origin - center;
  double a = dot(d, d);
  double b = -dot(offset, d);
  t_near = b / a;
  t_far = t_near;
  dvec3 closest = offset + (b / a) * d;
  double discriminant = radius * radius - dot(closest, closest);
  if (!(discriminant >= 0.0LF)) return false;
  double power = dot(offset, offset) - radius * radius;
  double root = sqrt(a * discriminant);
  double q = b >= 0.0LF ? b + root : b - root;
  double other = q != 0.0LF ? power / q : 0.0LF;
  t_near = min(other, q / a);
  t_far = max(other, q / a);
  return true;
}

// Position on a face of the grid, texels; z: depth along forward, positive before a point or spot light.
dvec3 on_grid(int face, dvec3 position) {
  dvec3 d = position - izb.origin.xyz;
  double z = dot(d, izb.face_forward[face].xyz);
#ifdef PERSPECTIVE
  double w = z;
#else
  double w = 1.0LF;
#endif
  dvec2 half_extent = dvec2(izb.face_right[face].w, izb.face_up[face].w);
  dvec2 shown = dvec2(dot(d, izb.face_right[face].xyz), dot(d, izb.face_up[face].xyz)) / (w * half_extent);
  return dvec3(0.5LF * (shown + 1.0LF) * double(izb.size.z), z);
}

#if defined(ALPHA_MASK) || defined(NON_CASTERS)
#include "material.glsl"
#endif
#ifdef ALPHA_MASK
bool masked_hole(uint material, vec2 uv, float vertex_alpha) { return is_hole(material_at(material), uv, vertex_alpha); }
bool masked_hole(uint material, vec2 uv) { return masked_hole(material, uv, 1.0); }
#endif
