// Your first shadow map. The file compiles as it stands and draws everything lit; six steps make it a shadow test.
//
// The function is called once for each pixel and light. It returns 1.0 where the light reaches the surface and 0.0 where
// something stands in between. What it is given:
//
//   position   the point on the surface, world units
//   normal     its normal, of length 1;  to_light: the direction to the light, of length 1
//   face       which of the light's views to use: 0 for a sun or a spot light; a lamp has six, chosen below
//   light.origin_and_warp[face].xyz      where that view stands, as a point like `position`
//   light.right[face].xyz, light.up[face].xyz, light.forward[face].xyz    its three axes, of length 1
//   light.extent_and_depths[face].xy     half the width and half the height that it sees: world units for a sun; for a
//                                        spot light and a lamp at a distance of 1 along `forward`
//   light.origin_and_size.w              texels on one side of the square map
//   light.bias.x                         the bias (--bias), world units along the light's ray
//   texelFetch(depth_map, ivec3(column, row, face), 0).r     what the map stored in one texel
//   holds_caster(stored)                 false where nothing was drawn into that texel
//   depth_from_stored(ivec3(column, row, face), stored)      the stored value as a depth along `forward`, world units
//
// PERSPECTIVE is defined for spot lights and lamps, CUBE for lamps.

float light_that_arrives(vec3 position, vec3 normal, vec3 to_light) {
#ifdef CUBE
  int face = cube_face(position - light.origin_and_size.xyz);
#else
  int face = 0;
#endif

  // TODO 1: `position` in the light's own axes: how far right, how far up, and how far forward from where the view stands?

  // TODO 2: where is that in the view, from -1 to 1? A perspective view divides by the depth.

  // TODO 3: from -1 ... 1 to texels, 0 ... size. Whatever falls beside the map is lit: return 1.0.

  // TODO 4: read the texel. Where it holds no caster, the light meets nothing: return 1.0.

  // TODO 5: how far does the surface lie behind what the map stored? Measured along the light's ray, that is the difference
  //         of the depths in a sun's view; in a perspective view, that difference times (distance to the light / depth).

  // TODO 6: in shadow where that exceeds the bias.
  return 1.0;
}
