// Calls one of the functions beside it, each pixel with a case of its own (gnomon shaders --call).
layout(binding = 0) uniform samplerBuffer case_numbers;
layout(location = 0) out vec4 answer;

#include "function/$FUNCTION.glsl"

float case_number(int i) {
  int pixel = int(gl_FragCoord.y) * 128 + int(gl_FragCoord.x);
  return texelFetch(case_numbers, pixel * NUMBERS + i).r;
}

vec3 case_vector(int i) {
  return vec3(case_number(i), case_number(i + 1), case_number(i + 2));
}

void main() {
  CALL_FUNCTION;
}
