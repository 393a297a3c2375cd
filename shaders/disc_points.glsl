// Evenly spread points of the unit disc and square, turned or shifted by another amount at every pixel, so that too few of
// them give noise instead of bands.
#include "camera.glsl"

// In [0, 1), evenly spread over every neighbourhood of pixels (Jimenez 2014, "Next Generation Post Processing in Call of
// Duty: Advanced Warfare": interleaved gradient noise).
float pixel_noise() {
  return fract(52.9829189 * fract(dot(window_position(gl_FragCoord), vec2(0.06711056, 0.00583715))));
}

// Point i of n on a spiral with the golden angle between neighbours (Vogel 1979, "A better way to construct the sunflower head").
vec2 disc_point(int i, int n, float turn) {
  const float golden_angle = 2.399963229728653;
  const float full_circle = 6.283185307179586;
  float angle = golden_angle * float(i) + full_circle * turn;
  return sqrt((float(i) + 0.5) / float(n)) * vec2(cos(angle), sin(angle));
}

// Point i of the sequence with the plastic number's ratios (Roberts 2018, "The Unreasonable Effectiveness of Quasirandom
// Sequences"), in [-1, 1]^2.
vec2 square_point(int i, float shift) {
  return 2.0 * fract(vec2(0.7548776662466927, 0.5698402909980532) * float(i) + 0.5 + shift) - 1.0;
}
