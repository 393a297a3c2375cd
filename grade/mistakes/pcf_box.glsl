// Percentage-closer filtering over a box as a student writes it, with the usual mistakes: MISTAKE is the number of one, 0 of
// none. The grader reads this list (mistakes.cpp); each sentence goes on from "as if". After one that "hides the
// rest" too little is left for later checks to go on as if it were mended.
// mistake 1, which hides the rest: one texel was compared with, and not a box of them
// mistake 2: the box began one texel too far to the right and up
// mistake 3: the box began at the receiver's own texel
// mistake 4: the box ended at the receiver's own texel
// mistake 5: the box lacked its last row and column
// mistake 6: the box had a row and a column too many
// mistake 7: the sum was divided by the side of the box, not by the texels in it
// mistake 8: the sum was not divided
// mistake 9: the box was a row, without height
// mistake 10: the box was a column, without width
// mistake 11: the mean was rounded to lit or shadowed
// mistake 12: light and shadow were exchanged
// mistake 13: one shadowed texel made all of the box dark
// mistake 14: one lit texel made all of the box light
// mistake 15: the texels at the rim of the box counted half
// mistake 16: the box stood around the nearest corner of a texel (places are rounded, not cut)
// mistake 17: what lies beside the map was in shadow
// mistake 18: the box was always three texels wide
// mistake 19: the depths in the box were averaged before the comparison
// mistake 20: the box began one texel too far to the left and down
// mistake 21: the box was as wide to each side as it should be in all
// mistake 22: the sum was divided by 9, whatever the size of the box
// mistake 23: the sum was divided by one texel too many on each side of the box
// mistake 24: only the corners of the box were compared with
// mistake 25: the receiver's own texel was counted twice
// mistake 26: there was no bias
// mistake 27: the receiver's own texel was left out
// mistake 28: texels counted the less, the farther they are from the middle
// mistake 29: the box had only every second texel
// mistake 30: the box lacked its last row and column, and the sum was divided by all
// mistake 31: the box was its quarter to the right and up
// mistake 32: the box was its quarter to the right and up, and the sum was divided by all
// mistake 33: the bias was taken twice
// mistake 34: the box stood half a texel to the left and down (0.5 is taken away before the cut)
// mistake 35: the mean was squared
// mistake 36: the texels of the box lay two texels apart
#include "taps.glsl"
#define IS(number) (MISTAKE == (number))

float mean_depth_compared(Comparison c, ivec2 low, ivec2 count) {
  Tap mean = tap_at(c, low + count / 2);
  mean.occluder = 0.0;
  for (int i = 0; i < count.x * count.y; ++i) mean.occluder += tap_at(c, low + ivec2(i % count.x, i / count.x)).occluder;
  mean.occluder /= float(count.x * count.y);
  return lit_by(c, mean);
}

float mean_of_box(Comparison c, ivec2 low, ivec2 count) {
  float lit = 0.0, weights = 0.0;
  for (int row = 0; row < count.y; ++row)
    for (int column = 0; column < count.x; ++column) {
      bool rim = row == 0 || column == 0 || row + 1 == count.y || column + 1 == count.x;
      ivec2 off = abs(ivec2(column, row) - count / 2);
      if (IS(36)) off = 2 * (ivec2(column, row) - count / 2);
      float weight = IS(15) && rim ? 0.5 : 1.0;
      if (IS(24) && (off.x != count.x / 2 || off.y != count.y / 2)) continue;
      if (IS(29) && (column + row) % 2 == 1) continue;
      if (off == ivec2(0)) weight = IS(25) ? 2.0 : IS(27) ? 0.0 : weight;
      if (IS(28)) weight = float((count.x / 2 + 1 - off.x) * (count.y / 2 + 1 - off.y));
      lit += weight * lit_at(c, IS(36) ? low + count / 2 + off : low + ivec2(column, row));
      weights += weight;
    }
  if (IS(8)) return min(lit, 1.0);
  if (IS(30) || IS(32)) return lit / float(BOX_SIZE * BOX_SIZE);
  if (IS(35)) return (lit / weights) * (lit / weights);
  if (IS(22)) return min(lit / 9.0, 1.0);
  if (IS(23)) return lit / float((BOX_SIZE + 1) * (BOX_SIZE + 1));
  if (IS(13)) return lit < weights ? 0.0 : 1.0;
  if (IS(14)) return lit > 0.0 ? 1.0 : 0.0;
  if (IS(7)) return min(lit / float(BOX_SIZE), 1.0);
  return lit / weights;
}

float technique_visibility(ShadowTest test, vec3 position, vec3 normal, vec3 to_light) {
  if (!test.at.inside) return IS(17) ? 0.0 : 1.0;
  Comparison c = make_comparison(test, normal);
  ivec2 own = ivec2(floor(c.at.uv + (IS(16) ? 0.5 : IS(34) ? -0.5 : 0.0))), low = own - BOX_SIZE / 2, count = ivec2(BOX_SIZE);
  if (IS(1)) low = own, count = ivec2(1);
  if (IS(2)) low = own - BOX_SIZE / 2 + 1;
  if (IS(3)) low = own;
  if (IS(4)) low = own - BOX_SIZE + 1;
  if (IS(5) || IS(30)) count -= 1;
  if (IS(31) || IS(32)) low = own, count = ivec2(BOX_SIZE / 2 + 1);
  if (IS(6)) count += 1;
  if (IS(9)) low.y = own.y, count.y = 1;
  if (IS(10)) low.x = own.x, count.x = 1;
  if (IS(18)) low = own - 1, count = ivec2(3);
  if (IS(20)) low = own - BOX_SIZE / 2 - 1;
  if (IS(21)) low = own - BOX_SIZE, count = ivec2(2 * BOX_SIZE + 1);
  if (IS(26)) c.slack = 0.0;
  if (IS(33)) c.slack *= 2.0;
  float lit = IS(19) ? mean_depth_compared(c, low, count) : mean_of_box(c, low, count);
  if (IS(11)) lit = lit >= 0.5 ? 1.0 : 0.0;
  return IS(12) ? 1.0 - lit : lit;
}
