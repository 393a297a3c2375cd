// The hard test as a student writes it, with the usual mistakes: MISTAKE is the number of one, 0 of none. The grader reads
// this list (mistakes.cpp); each sentence goes on from "as if". After one that "hides the rest" the picture is too flat for
// later checks to go on as if it were mended.
// mistake 1: right and up were exchanged
// mistake 2: right was mirrored
// mistake 3: up was mirrored (the rows of the map counted from the other end)
// mistake 4: right and up were both mirrored
// mistake 5: the light's axes were transposed (a matrix where its inverse belongs)
// mistake 6: the light looked the other way (forward is negated)
// mistake 7: positions were not counted from where the view stands
// mistake 8: right and up were not divided by the depth
// mistake 9: right and up were divided by the distance in place of the depth
// mistake 10: the size of the view was left out
// mistake 11: the view's width was taken for its height, too
// mistake 12: -1 ... 1 was taken for 0 ... 1
// mistake 13: 0.5 was not added after the halving
// mistake 14: nothing was halved on the way from -1 ... 1 to 0 ... 1
// mistake 15: places were multiplied by one texel less than the map has
// mistake 16: the nearest corner of a texel was read (places are rounded, not cut)
// mistake 17: the lookup was half a texel off the other way
// mistake 18: the lookup was one texel off to the right
// mistake 19: the lookup was one texel off upward
// mistake 20: what lies beside the map was in shadow
// mistake 21: the map's last texels went on beside it
// mistake 22: the map was repeated beside itself
// mistake 23: a texel without a caster was in shadow
// mistake 24: the stored value was a depth in world units
// mistake 25: the stored value counted from the far end
// mistake 26: the distance to the light was compared with a depth
// mistake 27: gaps were measured along the view's axis, not along the ray
// mistake 28: gaps were shortened twice (divided by the ray's slant, not multiplied)
// mistake 29: a lamp had one view
// mistake 30: a lamp's view was chosen by the direction to the lamp, not from it
// mistake 31: all of a lamp's views were in the map's first layer
// mistake 32: there was no bias
// mistake 33, which hides the rest: the bias had the wrong sign
// mistake 34: the bias was taken twice
// mistake 35: the bias was in texels
// mistake 36: the bias was LearnOpenGL's, max(0.05 (1 - n.l), 0.005), in world units
// mistake 37: the bias was LearnOpenGL's, max(0.05 (1 - n.l), 0.005), in stored depth
// mistake 38: the bias grew with the slope without an end
// mistake 39: the bias shifted the place along the normal, and not the depth
// mistake 40: the bias shifted the place along the normal taken in the light's axes
// mistake 41: the comparison was the wrong way round
// mistake 42: a surface in front of the stored one was in shadow, too (the difference without its sign)
// mistake 43: shadows were half as dark
// mistake 44: the depths of four texels were averaged before the comparison
// mistake 45: the bias was ten times as large
// mistake 46: the map had half as many texels on a side
// mistake 47: texels were read beside the map, too (no place is left out)
// mistake 48: the bias was half as large
// mistake 49: the bias was 0.005 world units, whatever is asked for
// mistake 50: the bias was 0.05 world units, whatever is asked for
// mistake 51: the bias was multiplied by n.l (it shrinks with the slope)
// mistake 52: the bias was divided by n.l
// mistake 53: the lookup was one texel off to the left
// mistake 54: the lookup was one texel off downward
// mistake 55: the lookup was one texel off to the right and upward
// mistake 56: the lookup was one texel off to the left and downward
// mistake 57: half of the view's size was all of it (places are halved twice)
// mistake 58: half of the view's size was to be halved (places are twice as far out)
// mistake 59: right and up were multiplied by the size of the view, not divided
// mistake 60: the view's depths were taken for its size
// mistake 61: 0.5 was added without the halving
// mistake 62: a sun's view were a perspective one (right and up are divided by the depth)
// mistake 63: what lies beside the map to the right or above was in it
// mistake 64: what lies beside the map to the left or below was in it
// mistake 65: what lies beside the map had to do so both ways, by column and by row
// mistake 66: the light was dimmed by its angle (n.l), too
// mistake 67: four texels were compared with, and their answers averaged
// mistake 68: the depths of a texel and of its neighbours to the right and above were averaged
// mistake 69: the stored value was compared with the depth by the view's farthest
#define IS(number) (MISTAKE == (number))

vec2 view_place(int face, vec3 local) {
  vec2 view = local.xy, extent = light.extent_and_depths[face].xy;
  if (IS(1)) view = view.yx;
  if (IS(2) || IS(4)) view.x = -view.x;
  if (IS(3) || IS(4)) view.y = -view.y;
#ifdef PERSPECTIVE
  if (IS(9)) view /= length(local);
  else if (!IS(8)) view /= local.z;
#else
  if (IS(62)) view /= local.z;
#endif
  if (IS(57)) extent *= 2.0;
  if (IS(58)) extent *= 0.5;
  if (IS(59)) extent = 1.0 / extent;
  if (IS(60)) extent = light.extent_and_depths[face].zw;
  if (IS(11)) extent = extent.xx;
  return IS(10) ? view : view / extent;
}

vec2 map_place(vec2 view, float size) {
  if (IS(15)) size -= 1.0;
  if (IS(46)) size *= 0.5;
  if (IS(12)) return view * size;
  if (IS(13)) return 0.5 * view * size;
  if (IS(14)) return (view + 1.0) * size;
  if (IS(61)) return (view + 0.5) * size;
  vec2 place = (0.5 * view + 0.5) * size;
  if (IS(16)) place += 0.5;
  if (IS(17)) place -= 0.5;
  if (IS(18)) place.x += 1.0;
  if (IS(19)) place.y += 1.0;
  if (IS(53) || IS(56)) place.x -= 1.0;
  if (IS(54) || IS(56)) place.y -= 1.0;
  if (IS(55)) place += 1.0;
  return place;
}

float mean_depth(vec2 place, int face, float size) {
  ivec2 low = ivec2(floor(IS(68) ? place : place - 0.5)), last = ivec2(size) - 1;
  float sum = 0.0;
  for (int k = 0; k < 4; ++k) {
    ivec3 texel = ivec3(clamp(low + ivec2(k % 2, k / 2), ivec2(0), last), face);
    sum += depth_from_stored(texel, texelFetch(depth_map, texel, 0).r);
  }
  return sum / 4.0;
}

float own_bias(vec3 normal, vec3 to_light, float texel_width) {
  float bias = light.bias.x, facing = max(dot(normal, to_light), 1e-4);
  if (IS(32) || IS(39) || IS(40)) return 0.0;
  if (IS(33)) return -bias;
  if (IS(34)) return 2.0 * bias;
  if (IS(45)) return 10.0 * bias;
  if (IS(48)) return 0.5 * bias;
  if (IS(49)) return 0.005;
  if (IS(50)) return 0.05;
  if (IS(51)) return bias * max(dot(normal, to_light), 0.0);
  if (IS(52)) return bias / facing;
  if (IS(35)) return bias * texel_width;
  if (IS(36)) return max(0.05 * (1.0 - facing), 0.005);
  if (IS(38)) return bias * sqrt(max(1.0 - facing * facing, 0.0)) / facing;
  return bias;
}

float technique_visibility(ShadowTest test, vec3 position, vec3 normal, vec3 to_light) {
  COUNT_LOOKUPS(1);
#ifdef CUBE
  vec3 from_lamp = position - light.origin_and_size.xyz;
  int face = IS(29) ? 0 : cube_face(IS(30) ? -from_lamp : from_lamp);
#else
  int face = 0;
#endif
  float size = light.origin_and_size.w;
  vec3 right = light.right[face].xyz, up = light.up[face].xyz, forward = light.forward[face].xyz;
  vec3 along_normal = IS(40) ? vec3(dot(right, normal), dot(up, normal), dot(forward, normal)) : normal;
  vec3 moved = position + (IS(39) || IS(40) ? light.bias.x * along_normal : vec3(0.0));
  vec3 offset = IS(7) ? moved : moved - light.origin_and_warp[face].xyz;
  vec3 local = IS(5) ? right * offset.x + up * offset.y + forward * offset.z
                     : vec3(dot(right, offset), dot(up, offset), dot(forward, offset));
  if (IS(6)) local.z = -local.z;
#ifdef PERSPECTIVE
  if (local.z <= 0.0) return 1.0;
#endif
  vec2 place = map_place(view_place(face, local), size);
  bvec2 low = lessThan(place, vec2(0.0)), high = greaterThanEqual(place, vec2(size));
  bool beside = IS(63) ? any(low) : IS(64) ? any(high) : IS(65) ? all(low) || all(high) : any(low) || any(high);
  if (beside) {
    if (IS(20)) return 0.0;
    if (!IS(21) && !IS(22) && !IS(47)) return 1.0;
    if (!IS(47)) place = IS(22) ? mod(place, size) : clamp(place, vec2(0.0), vec2(size - 0.5));
  }
  ivec3 texel = ivec3(ivec2(floor(place)), IS(31) ? 0 : face);
  float stored = texelFetch(depth_map, texel, 0).r;
  if (!holds_caster(stored)) return IS(23) ? 0.0 : 1.0;
  float depth = depth_from_stored(texel, IS(25) ? 1.0 - stored : stored);
  if (IS(24)) depth = stored;
  if (IS(44) || IS(68)) depth = mean_depth(place, face, size);
#ifdef PERSPECTIVE
  float slant = length(offset) / local.z;
  float width = 2.0 * light.extent_and_depths[face].x * local.z / size;
#else
  float slant = 1.0;
  float width = 2.0 * light.extent_and_depths[face].x / size;
#endif
  float gap = IS(26) ? length(offset) - depth : local.z - depth;
  if (!IS(27)) gap = IS(28) ? gap / slant : gap * slant;
  bool is_shadowed = gap > own_bias(normal, to_light, width);
  if (IS(37))
    is_shadowed = stored_from_depth(texel, local.z) - max(0.05 * (1.0 - dot(normal, to_light)), 0.005) > stored;
  if (IS(69)) is_shadowed = local.z / light.extent_and_depths[face].w - light.bias.x > stored;
  if (IS(67)) {
    float lit = 0.0;
    for (int k = 0; k < 4; ++k) {
      ivec3 beside_it = texel + ivec3(k % 2, k / 2, 0);
      lit += local.z - depth_from_stored(beside_it, texelFetch(depth_map, beside_it, 0).r) > light.bias.x ? 0.0 : 0.25;
    }
    return lit;
  }
  if (IS(41)) is_shadowed = gap < light.bias.x;
  if (IS(42)) is_shadowed = abs(gap) > light.bias.x;
  float lit = IS(66) ? max(dot(normal, to_light), 0.0) : 1.0;
  return is_shadowed ? (IS(43) ? 0.5 : 0.0) : lit;
}
