// Percentage-closer soft shadows (Fernando 2005): the mean depth of what blocks the light near the receiver says how wide
// the penumbra is; the comparisons are averaged over that width. Here each tap belongs to a point of the light: the ray from
// the receiver to it is followed to the blockers' depth, and the map is looked up there. The kernel so has the light's own
// shape and size: AREA_SUN, AREA_SPHERE, AREA_DISC or AREA_RECTANGLE.
#include "taps.glsl"
#include "disc_points.glsl"

// Where the ray to a light's point starts and how it goes, in the face's frame; the light's centre is the origin.
struct LightArea {
  vec3 receiver;
  vec3 u, v;  // from the light's centre; of a sun: tangents
};

LightArea light_area(Comparison c) {
  LightArea area;
  area.receiver = c.at.local;
#ifdef AREA_SPHERE
  // The disc that the receiver sees of the sphere.
  vec3 w = normalize(c.at.local);
  area.u = light.area_u.x * normalize(vec3(w.z, 0.0, -w.x));
  area.v = cross(w, area.u);
#else
  area.u = to_face(c.at.face, light.area_u.xyz);
  area.v = to_face(c.at.face, light.area_v.xyz);
#endif
  return area;
}

// Texels between the receiver's place and where the ray to the light's point s (in its own coordinates) is at a depth.
vec2 ray_offset(Comparison c, LightArea area, vec2 s, float depth) {
  vec3 e = s.x * area.u + s.y * area.v;
  vec3 p = area.receiver;
#ifdef AREA_SUN
  return (p.z - depth) * e.xy / texel_extent(c.at.face);
#else
  if (!(p.z > e.z)) return vec2(0.0);  // a receiver beside the light
  float t = (p.z - depth) / (p.z - e.z);
  vec3 q = mix(p, e, t);
  return (q.xy / q.z - p.xy / p.z) / texel_extent(c.at.face);
#endif
}

vec2 light_point(int i, int n, float turn) {
#ifdef AREA_RECTANGLE
  return square_point(i, turn);
#else
  return disc_point(i, n, turn);
#endif
}

// Mean depth of the blockers around the receiver; infinite where there is none. The search covers all that can block the
// light before the map's near depth, but no more texels than asked for.
float mean_blocker_depth(Comparison c, LightArea area, float turn) {
  float near = light.extent_and_depths[c.at.face].z;
  float reach = max(length(ray_offset(c, area, vec2(1.0, 0.0), near)), length(ray_offset(c, area, vec2(0.0, 1.0), near)));
  float scale = reach > light.filter_radii.y ? light.filter_radii.y / reach : 1.0;
  float sum = 0.0;
  float count = 0.0;
  for (int i = 0; i < BLOCKER_SAMPLES; ++i) {
    vec2 offset = scale * ray_offset(c, area, light_point(i, BLOCKER_SAMPLES, turn), near);
    Tap tap = tap_at(c, ivec2(floor(c.at.uv + offset)));
    if (shadows(c, tap)) {
      sum += tap.occluder;
      count += 1.0;
    }
  }
  return count > 0.0 ? sum / count : infinite;
}

float technique_visibility(ShadowTest test, vec3 position, vec3 normal, vec3 to_light) {
  if (!test.at.inside) return 1.0;
  Comparison c = make_comparison(test, normal);
  LightArea area = light_area(c);
  float turn = pixel_noise();
  float blocker = mean_blocker_depth(c, area, turn);
  if (isinf(blocker)) return 1.0;
  float lit = 0.0;
  for (int i = 0; i < FILTER_SAMPLES; ++i) {
    vec2 offset = ray_offset(c, area, light_point(i, FILTER_SAMPLES, turn), blocker);
    lit += lit_at(c, ivec2(floor(c.at.uv + offset)));
  }
  return lit / float(FILTER_SAMPLES);
}
