// The ray to a light as a student writes it, with the usual mistakes: MISTAKE is the number of one, 0 of none. The grader reads this
// list (mistakes.cpp); each sentence goes on from "as if".
// mistake 1: the ray began in the surface itself (there is no offset)
// mistake 2: the offset ran along the ray, not along the normal
// mistake 3: the normal always pointed to the light's side
// mistake 4: the offset led to the side away from the light
// mistake 5: the direction was not normalized
// mistake 6: the ray ran from the light to the point
// mistake 7: a lamp's ray had no end (what is behind the lamp hides it)
// mistake 8: the end was measured from the point, not from the ray's begin
// mistake 9: the end was 1, (the direction is not the whole way)
// mistake 10: a sun was a lamp
// mistake 11: a lamp was a sun
// mistake 12: the sun was as far away as its direction is long
// mistake 13: the direction was that from the point, not from the ray's begin
// mistake 14: the offset was a small number of its own (0.001)
// mistake 15: the end was the distance squared (the root is left out)
// mistake 16: the ray began at the lamp
// mistake 17: the direction was the normal
// mistake 18: the ray ended an offset before the lamp
// mistake 19: the direction and the end were those from the point, not from the ray's begin
// mistake 20: the ray had no end and a direction that is not normalized
// mistake 21: a sun was a lamp (its direction is taken for a place)
// mistake 22: the offset was taken twice
// mistake 23: the end was the lamp's distance from the origin of the world
// mistake 24: the ray ended an offset behind the lamp
// mistake 25: a sun's ray ended at 1
// mistake 26: a sun's ray ended at 0
// mistake 27: a sun's ray ran away from it
// mistake 28: the direction was that of the lamp from the origin of the world
// mistake 29: the offset was a tenth
// mistake 30: sun and lamp were exchanged
// mistake 31: the side was that of the light's place, not of the way to it
// mistake 32: a sun's ray had an end, if a far one
// mistake 33: a sun's ray had an end, if a far one
// mistake 34: a sun's ray had an end, if a far one
// mistake 35: a sun's ray had an end, if a far one
// mistake 36: a sun's ray had an end, if a far one
// mistake 37: a lamp's ray ended at 0
// mistake 38: the direction of a sun was not normalized
// mistake 39: a lamp's direction was not normalized
// mistake 40: a lamp's direction was its place
// mistake 41: a sun's ray ran from the point, without the offset
// mistake 42: the end was half the way
// mistake 43: a lamp's ray ran from the light to the point (a sun's did not)
void shadow_ray(vec3 point, vec3 normal, vec4 light, float offset, out vec3 begin, out vec3 direction, out float end) {
  bool sun = MISTAKE == 30 ? light.w != 0.0 : MISTAKE == 10 ? false : MISTAKE == 11 ? true : light.w == 0.0;
  vec3 to_light = sun ? light.xyz : light.xyz - point;
  float side = dot(normal, MISTAKE == 31 ? light.xyz : to_light) < 0.0 && MISTAKE != 3 ? -1.0 : 1.0;
  if (MISTAKE == 4) side = -side;
  float by = MISTAKE == 1 ? 0.0 : MISTAKE == 14 ? 0.001 : MISTAKE == 22 ? 2.0 * offset : MISTAKE == 29 ? 0.1 * offset : offset;
  begin = point + by * (MISTAKE == 2 ? normalize(to_light) : side * normal);
  vec3 way = sun && MISTAKE != 21 ? light.xyz : light.xyz - begin;
  float far = length(MISTAKE == 8 || MISTAKE == 19 ? to_light : way);
  if (MISTAKE == 13 || MISTAKE == 19) way = to_light;
  direction = MISTAKE == 5 || MISTAKE == 20 ? way : normalize(way);
  end = sun && MISTAKE != 12 || MISTAKE == 7 || MISTAKE == 20 ? 1e30 : far;
  if (MISTAKE == 28 && !sun) direction = normalize(light.xyz);
  if (MISTAKE == 27 && sun) direction = -direction;
  if ((MISTAKE == 25 || MISTAKE == 26) && sun) end = MISTAKE == 25 ? 1.0 : 0.0;
  if (MISTAKE == 23 && !sun) end = length(light.xyz);
  if (MISTAKE == 24 && !sun) end = far + offset;
  if (MISTAKE == 9 && !sun) end = 1.0;
  if (MISTAKE == 15 && !sun) end = far * far;
  if (MISTAKE == 18 && !sun) end = far - offset;
  if (sun && MISTAKE >= 32 && MISTAKE <= 36)
    end = MISTAKE == 32 ? 100.0 : MISTAKE == 33 ? 1000.0 : MISTAKE == 34 ? 1e4 : MISTAKE == 35 ? 1e5 : 1e6;
  if (MISTAKE == 37 && !sun) end = 0.0;
  if (MISTAKE == 38 && sun || MISTAKE == 39 && !sun) direction = way;
  if (MISTAKE == 40 && !sun) direction = light.xyz;
  if (MISTAKE == 41 && sun) begin = point;
  if (MISTAKE == 42 && !sun) end = 0.5 * far;
  if (MISTAKE == 43 && !sun) direction = -direction;
  if (MISTAKE == 6) direction = -direction;
  if (MISTAKE == 16 && !sun) begin = light.xyz, direction = -direction;
  if (MISTAKE == 17) direction = normal;
}
