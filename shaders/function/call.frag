// Calls one of the functions beside it, each pixel with a case of its own (gnomon shaders --call). What is defined behind it, the
// function cannot name: there is no other way to a case's numbers than those that count.
layout(location = 0) out vec4 answer;

// What an exercise asks for is not handed to it: such a call does not compile, and the error says why.
#define reflect reflect_is_what_the_exercise_asks_for
#define refract refract_is_what_the_exercise_asks_for
#include "function/$FUNCTION.glsl"

layout(binding = 0) uniform samplerBuffer case_numbers;

#define case_number(i) \
  texelFetch(case_numbers, (int(gl_FragCoord.y) * 128 + int(gl_FragCoord.x)) * NUMBERS + (i)).r
#define case_vector(i) vec3(case_number(i), case_number((i) + 1), case_number((i) + 2))

// Nothing below calls a function of GLSL's that the file above could have made another one of, but texelFetch, which the grader
// refuses there.
#ifdef CALLS_bvh_walk
// A bit for each node whose box was asked, however often; and how many leaves were.
int boxes_asked = 0, leaves_asked = 0;
#define of_node(asked_node, i) \
  (asked_node >= 0 && asked_node < int(case_number(0)) ? case_number(3 + 4 * asked_node + i) : -1.0)
float box_entry(int asked_node) {
  if (asked_node >= 0 && asked_node < int(case_number(0))) boxes_asked |= 1 << asked_node;
  return of_node(asked_node, 0);
}
int left_child(int asked_node) { return int(of_node(asked_node, 1)); }
int right_child(int asked_node) { return int(of_node(asked_node, 2)); }
float hit_in_leaf(int asked_node) {
  ++leaves_asked;
  return of_node(asked_node, 3);
}
#endif

#ifdef CALLS_bvh_split
vec3 triangle_corner(int asked_triangle, int asked_corner) {
  return case_vector(1 + 9 * asked_triangle + 3 * asked_corner);
}
#endif

void main() {
  CALL_FUNCTION;
}
