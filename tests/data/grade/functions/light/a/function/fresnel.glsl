float fresnel(float cosine, float n1, float n2) {
  float sine2 = n1 / n2 * sqrt(max(0.0, 1.0 - cosine * cosine));
  if (sine2 > 1.0) return 1.0;
  float cosine2 = sqrt(1.0 - sine2 * sine2);
  float s = (n1 * cosine - n2 * cosine2) / (n1 * cosine + n2 * cosine2);
  float p = (n2 * cosine - n1 * cosine2) / (n2 * cosine + n1 * cosine2);
  return (s * s + p * p) / 2.0;
}
