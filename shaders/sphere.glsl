// Ray against sphere without catastrophic cancellation (Haines, Guenther and Akenine-Moeller 2019, "Precision
// Improvements for Ray/Sphere Intersection", Ray Tracing Gems, chapter 7). The direction need not be unit length.

// Both crossings in multiples of `direction`, near one first. False when the ray's line misses; both are then the point of
// closest approach, for a silhouette pixel that the rasterizer's rounding has decided the other way.
bool sphere_crossings(vec3 origin, vec3 direction, vec3 center, float radius, out float t_near, out float t_far) {
  vec3 to_origin = origin - center;
  float a = dot(direction, direction);
  float b = -dot(to_origin, direction);
  t_near = b / a;
  t_far = t_near;
  vec3 nearest = to_origin + t_near * direction;  // the line's point nearest to the centre
  float discriminant = radius * radius - dot(nearest, nearest);
  if (!(discriminant >= 0.0)) return false;
  float c = dot(to_origin, to_origin) - radius * radius;
  float q = b + (b >= 0.0 ? 1.0 : -1.0) * sqrt(a * discriminant);
  float t0 = q != 0.0 ? c / q : 0.0;
  float t1 = q / a;
  t_near = min(t0, t1);
  t_far = max(t0, t1);
  return true;
}
