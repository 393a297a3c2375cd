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
#include "taps.glsl"
#define IS(number) (MISTAKE == (number))

float mean_of_box(Comparison c, ivec2 low, ivec2 count) {
  float lit = 0.0, weights = 0.0;
  for (int row = 0; row < count.y; ++row)
    for (int column = 0; column < count.x; ++column) {
      bool rim = row == 0 || column == 0 || row + 1 == count.y || column + 1 == count.x;
      float weight = IS(15) && rim ? 0.5 : 1.0;
      lit += weight * lit_at(c, low + ivec2(column, row));
      weights += weight;
    }
  if (IS(8)) return min(lit, 1.0);
  if (IS(13)) return lit < weights ? 0.0 : 1.0;
  if (IS(14)) return lit > 0.0 ? 1.0 : 0.0;
  if (IS(7)) return min(lit / float(BOX_SIZE), 1.0);
  return lit / weights;
}

float technique_visibility(ShadowTest test, vec3 position, vec3 normal, vec3 to_light) {
  if (!test.at.inside) return IS(17) ? 0.0 : 1.0;
  Comparison c = make_comparison(test, normal);
  ivec2 own = ivec2(floor(IS(16) ? c.at.uv + 0.5 : c.at.uv)), low = own - BOX_SIZE / 2, count = ivec2(BOX_SIZE);
  if (IS(1)) low = own, count = ivec2(1);
  if (IS(2)) low = own - BOX_SIZE / 2 + 1;
  if (IS(3)) low = own;
  if (IS(4)) low = own - BOX_SIZE + 1;
  if (IS(5)) count -= 1;
  if (IS(6)) count += 1;
  if (IS(9)) low.y = own.y, count.y = 1;
  if (IS(10)) low.x = own.x, count.x = 1;
  float lit = mean_of_box(c, low, count);
  if (IS(11)) lit = lit >= 0.5 ? 1.0 : 0.0;
  return IS(12) ? 1.0 - lit : lit;
}
