// By geometry: the place nearest to the center, and half the chord.
float ray_sphere(vec3 origin, vec3 direction, vec3 center, float radius) {
  float size = length(direction);
  vec3 way = direction / size, to_center = center - origin;
  float along = dot(to_center, way);
  vec3 aside = to_center - along * way;
  float rest = radius * radius - dot(aside, aside);
  if (rest < 0.0) return -1.0;
  float half_chord = sqrt(rest);
  float t = along - half_chord;
  if (t < 0.0) t = along + half_chord;
  return t < 0.0 ? -1.0 : t / size;
}
