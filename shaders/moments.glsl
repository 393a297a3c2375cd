// What the filterable techniques store instead of depth. It is a function of the distance along the light ray, chosen by
// MOMENTS_VSM, _ESM, _EVSM or _MSM, that may be averaged like a colour. A cube's faces get a border of MOMENT_BORDER
// texels that repeats their neighbours, so that no average stops at an edge.

#if defined(MOMENTS_ESM)
#define MOMENTS float
#elif defined(MOMENTS_VSM)
#define MOMENTS vec2
#else
#define MOMENTS vec4
#endif

// The distance along the light ray as a share of the map's range, 0 at the near depth and 1 at the farthest corner.
float range_share(float distance) {
  vec4 extent = light.extent_and_depths[0];  // every face has the same
  float low = extent.z;
  float high = extent.w;
#ifdef PERSPECTIVE
  high *= length(vec3(extent.xy, 1.0));
#endif
  return (distance - low) / (high - low);
}

// Two warps of the distance that push apart what lies near and far (Lauritzen and McCool 2008, "Layered Variance Shadow Maps").
vec2 evsm_warp(float share) {
  float z = 2.0 * share - 1.0;
  return vec2(exp(light.moments.x * z), -exp(-light.moments.y * z));
}

MOMENTS moments_of(float share) {
#if defined(MOMENTS_ESM)
  return exp(light.moments.x * share);
#elif defined(MOMENTS_VSM)
  return vec2(share, share * share);
#elif defined(MOMENTS_EVSM)
  vec2 warped = evsm_warp(share);
  return vec4(warped.x, warped.x * warped.x, warped.y, warped.y * warped.y);
#else
  float z = 2.0 * share - 1.0;
  return vec4(z, z * z, z * z * z, z * z * z * z);
#endif
}
