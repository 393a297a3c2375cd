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
// mistake 31: the tangent was halved, not the angle
// mistake 32: the pixel's place was a whole number (its division is one of integers)
// mistake 33: every pixel was the first one (its division is one of integers)
// mistake 34: rows and columns were exchanged
// mistake 35: the width and the height were exchanged where pixels become places
// mistake 36: the tangent was divided by, not multiplied with
// mistake 37: the tangent shortened what leads forward, too
// mistake 38: the field of view was left out along the rows (to the right)
// mistake 39: the field of view was left out along the columns (upward)
// mistake 40: 180 degrees were 1 (pi is left out)
// mistake 41: 0.5 was taken away, not added
// mistake 42: the doubling was left out (0 ... 1 becomes -1 ... 0)
// mistake 43: the cosine was taken for the tangent
// mistake 44: the direction had nothing forward
// mistake 45: the camera's axes right and up were exchanged before the aspect
// mistake 46: the direction had length 1 in the picture alone (it is divided by the root of 3)
// mistake 47: the arc tangent was taken for the tangent
vec3 eye_ray(vec2 pixel, vec2 size, float degrees, vec3 right, vec3 up, vec3 forward) {
  if (MISTAKE == 34) pixel = pixel.yx;
  vec2 middle = pixel + (MISTAKE == 1 || MISTAKE == 13 ? 0.0 : MISTAKE == 18 ? 1.0 : MISTAKE == 21 ? 0.25 : MISTAKE == 41 ? -0.5 : 0.5);
  if (MISTAKE == 19) middle.y = pixel.y;
  if (MISTAKE == 20) middle.x = pixel.x;
  vec2 place = middle / (MISTAKE == 13 ? max(size - 1.0, 1.0) : MISTAKE == 35 ? size.yx : size);
  if (MISTAKE != 15) place = (MISTAKE == 42 ? 1.0 : 2.0) * place - 1.0;
  if (MISTAKE == 32) place = floor(2.0 * pixel / size) - 1.0;
  if (MISTAKE == 33) place = vec2(-1.0);
  if (MISTAKE != 9) place.y = MISTAKE == 15 ? 1.0 - place.y : -place.y;
  if (MISTAKE == 27) place = -place;
  if (MISTAKE == 10 || MISTAKE == 30) place.x = -place.x;
  float angle = (MISTAKE == 7 ? 1.0 : 0.5) * (MISTAKE == 6 || MISTAKE == 17 ? degrees : MISTAKE == 40 ? degrees / 180.0 : radians(degrees));
  if (MISTAKE == 22) angle *= 0.5;
  float high = MISTAKE == 16 ? 1.0 : MISTAKE == 8 ? angle : MISTAKE == 29 ? sin(angle) : MISTAKE == 43 ? cos(angle) : MISTAKE == 47 ? atan(angle) : MISTAKE == 31 ? 0.5 * tan(2.0 * angle) : MISTAKE == 36 ? 1.0 / tan(angle) : tan(angle), aspect = size.x / size.y;
  if (MISTAKE == 3) aspect = 1.0 / aspect;
  if (MISTAKE == 23) aspect *= aspect;
  if (MISTAKE == 24) aspect = floor(aspect);
  if (MISTAKE == 25) high *= 0.5;
  if (MISTAKE == 26) high *= 2.0;
  vec2 reach = high * vec2(aspect, 1.0);
  if (MISTAKE == 2 || MISTAKE == 30) reach = vec2(high);
  if (MISTAKE == 4) reach = high * vec2(1.0, aspect);
  if (MISTAKE == 5) reach = high * vec2(1.0, 1.0 / aspect);
  if (MISTAKE == 38) reach.x = aspect;
  if (MISTAKE == 39) reach.y = 1.0;
  place *= reach;
  if (MISTAKE == 45) place = place.yx / vec2(1.0, aspect) * vec2(aspect, 1.0);
  if (MISTAKE == 14) place = place.yx;
  vec3 to = place.x * right + place.y * up + (MISTAKE == 12 ? -forward : MISTAKE == 37 ? high * forward : MISTAKE == 44 ? vec3(0.0) : forward);
  if (MISTAKE == 17) to *= sign(high);
  if (MISTAKE == 28) to = -to;
  if (MISTAKE == 46) return to / sqrt(3.0);
  return MISTAKE == 11 ? to : normalize(to);
}
