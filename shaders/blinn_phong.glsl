// Local shading (Blinn 1977, Whitted 1980). Twin of raytrace/shading/shade.h. No factors of pi: radiance = diffuse *
// irradiance * n.l + specular * irradiance * (n.h)^shininess where n.l > 0. All vectors are unit length.

vec3 blinn_phong(vec3 diffuse, vec4 specular_and_shininess, vec3 irradiance, vec3 n, vec3 to_light, vec3 to_eye) {
  float n_l = dot(n, to_light);
  if (!(n_l > 0.0)) return vec3(0.0);
  vec3 reflected = diffuse * n_l;
#ifdef SPECULAR
  vec3 half_way = to_light + to_eye;
  float squared = dot(half_way, half_way);
  float n_h = squared > 0.0 ? max(0.0, dot(n, half_way) * inversesqrt(squared)) : 0.0;
  if (n_h > 0.0) reflected += specular_and_shininess.rgb * pow(n_h, specular_and_shininess.w);
#endif
  return reflected * irradiance;
}
