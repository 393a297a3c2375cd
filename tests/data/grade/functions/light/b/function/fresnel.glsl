// With g as Cook and Torrance have it.
float fresnel(float cosine, float n1, float n2) {
  float n = n2 / n1, g = n * n - 1.0 + cosine * cosine;
  if (g < 0.0) return 1.0;
  g = sqrt(g);
  float less = g - cosine, more = g + cosine;
  float ratio = (cosine * more - 1.0) / (cosine * less + 1.0);
  return 0.5 * (less * less) / (more * more) * (1.0 + ratio * ratio);
}
