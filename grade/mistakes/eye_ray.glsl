// The eye's ray as a student writes it, with the usual mistakes: MISTAKE is the number of one, 0 of none. The grader reads this
// list (mistakes.cpp); each sentence goes on from "as if".
// mistake 1: the ray went through the pixel's corner (0.5 is left out)
// mistake 2: the picture was square (its aspect is left out)
// mistake 3: the aspect was height over width
// mistake 4: the aspect belonged to the height
// mistake 5: the field of view was the picture's width, not its height
// mistake 6: the angle was in radians
// mistake 7: the whole angle was the half
// mistake 8: the angle was its own tangent
// mistake 9: rows were counted from the bottom (the picture is upside down)
// mistake 10: columns were counted from the right (the picture is mirrored)
// mistake 11: the direction was not normalized
// mistake 12: the camera looked backwards (forward is negated)
// mistake 13: the last pixel's middle was at the picture's edge (it is divided by one pixel less)
// mistake 14: right and up were exchanged
// mistake 15: -1 ... 1 were 0 ... 1
// mistake 16: the field of view was left out
// mistake 17: the angle was in radians (and the picture stands behind the eye where its tangent is negative)
// mistake 18: the ray went through the pixel's far corner (1 is added, not 0.5)
// mistake 19: the rows' 0.5 was left out
// mistake 20: the columns' 0.5 was left out
// mistake 21: 0.5 was added after the doubling (brackets are left out)
// mistake 22: the angle was halved twice
// mistake 23: the aspect came in twice
// mistake 24: the aspect was a whole number (its division is one of integers)
// mistake 25: the picture was half as large (-1 ... 1 is -0.5 ... 0.5)
// mistake 26: the picture was twice as large
// mistake 27: rows and columns were both counted from the wrong end
// mistake 28: the ray ran from the picture to the eye
// mistake 29: the sine was taken for the tangent
// mistake 30: the aspect was left out, and the picture is mirrored
vec3 eye_ray(vec2 pixel, vec2 size, float degrees, vec3 right, vec3 up, vec3 forward) {
  vec2 middle = pixel + (MISTAKE == 1 || MISTAKE == 13 ? 0.0 : MISTAKE == 18 ? 1.0 : MISTAKE == 21 ? 0.25 : 0.5);
  if (MISTAKE == 19) middle.y = pixel.y;
  if (MISTAKE == 20) middle.x = pixel.x;
  vec2 place = middle / (MISTAKE == 13 ? max(size - 1.0, 1.0) : size);
  if (MISTAKE != 15) place = 2.0 * place - 1.0;
  if (MISTAKE != 9) place.y = MISTAKE == 15 ? 1.0 - place.y : -place.y;
  if (MISTAKE == 27) place = -place;
  if (MISTAKE == 10 || MISTAKE == 30) place.x = -place.x;
  float angle = (MISTAKE == 7 ? 1.0 : 0.5) * (MISTAKE == 6 || MISTAKE == 17 ? degrees : radians(degrees));
  if (MISTAKE == 22) angle *= 0.5;
  float high = MISTAKE == 16 ? 1.0 : MISTAKE == 8 ? angle : MISTAKE == 29 ? sin(angle) : tan(angle), aspect = size.x / size.y;
  if (MISTAKE == 3) aspect = 1.0 / aspect;
  if (MISTAKE == 23) aspect *= aspect;
  if (MISTAKE == 24) aspect = floor(aspect);
  if (MISTAKE == 25) high *= 0.5;
  if (MISTAKE == 26) high *= 2.0;
  vec2 reach = high * vec2(aspect, 1.0);
  if (MISTAKE == 2 || MISTAKE == 30) reach = vec2(high);
  if (MISTAKE == 4) reach = high * vec2(1.0, aspect);
  if (MISTAKE == 5) reach = high * vec2(1.0, 1.0 / aspect);
  place *= reach;
  if (MISTAKE == 14) place = place.yx;
  vec3 to = place.x * right + place.y * up + (MISTAKE == 12 ? -forward : forward);
  if (MISTAKE == 17) to *= sign(high);
  if (MISTAKE == 28) to = -to;
  return MISTAKE == 11 ? to : normalize(to);
}
