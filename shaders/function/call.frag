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

#ifdef CALLS_bvh_walk
int boxes_asked = 0, leaves_asked = 0;
#define of_node(node, i) (node >= 0 && node < int(case_number(0)) ? case_number(3 + 4 * node + i) : -1.0)
float box_entry(int node) {
  ++boxes_asked;
  return of_node(node, 0);
}
int left_child(int node) { return int(of_node(node, 1)); }
int right_child(int node) { return int(of_node(node, 2)); }
float hit_in_leaf(int node) {
  ++leaves_asked;
  return of_node(node, 3);
}
#endif

#ifdef CALLS_bvh_split
vec3 triangle_corner(int triangle, int corner) { return case_vector(1 + 9 * triangle + 3 * corner); }
#endif

void main() {
  CALL_FUNCTION;
}
