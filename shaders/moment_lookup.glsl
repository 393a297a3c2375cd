// The filtered moments at a receiver, and its own distance with the bias taken off.
#include "moments.glsl"
#include "camera.glsl"

layout(binding = moments_unit) uniform sampler2DArray moment_map;

// Where the receiver's plane shows at another window position, in texels from the receiver's own.
vec2 texels_to(Texel at, vec3 position, vec3 normal, vec2 window) {
  vec3 origin = pixel_origin(window), direction = pixel_direction(window);
  vec3 there = origin + direction * (dot(normal, position - origin) / dot(normal, direction));
  return project_to_face(at.face, there).uv - at.uv;
}

// Texels that a pixel covers on its longer side, as a mipmap level.
float pixel_level(Texel at, vec3 position, vec3 normal) {
#ifdef MIPMAPS
  vec2 across = texels_to(at, position, normal, window_position(gl_FragCoord) + vec2(1.0, 0.0));
  vec2 down = texels_to(at, position, normal, window_position(gl_FragCoord) + vec2(0.0, 1.0));
  float level = 0.5 * log2(max(dot(across, across), dot(down, down)));
  return clamp(level, 0.0, float(MAX_LEVEL));  // not a number becomes 0
#else
  return 0.0;
#endif
}

MOMENTS filtered_moments(ShadowTest test, vec3 position, vec3 normal) {
  vec2 padded = test.at.uv + float(MOMENT_BORDER);
  vec3 where = vec3(padded / vec2(textureSize(moment_map, 0).xy), test.at.face);
  COUNT_LOOKUPS(1);
  vec4 read = textureLod(moment_map, where, pixel_level(test.at, position, normal));
#if defined(MOMENTS_ESM)
  return read.x;
#elif defined(MOMENTS_VSM)
  return read.xy;
#else
  return read;
#endif
}

// The receiver's own range_share, nearer to the light by the constant and the slope bias; -infinity where the slope bias
// knows no bound.
float biased_share(ShadowTest test, vec3 normal) {
  float bias = light.bias.x;
#ifdef SLOPE_BIAS
#ifdef PERSPECTIVE
  float along_ray = test.at.distance / test.at.local.z;
#else
  float along_ray = 1.0;
#endif
  bias += light.bias.y * texel_depth_slope(test.at, to_face(test.at.face, normal)) * along_ray;
#endif
  return range_share(test.at.distance - bias);
}

// Variances are known no better than the rounding of the squares that they are the difference of: four roundings of
// 2^-24 each, relative to the second moment.
const float rounding = 4.0 / 16777216.0;

// Chebyshev's one-sided inequality: at most this share lies at or beyond x (Donnelly and Lauritzen 2006, equation 5).
float chebyshev(vec2 moments, float x) {
  if (!(x > moments.x)) return 1.0;
  float variance = max(moments.y - moments.x * moments.x, rounding * moments.y);
  float d = x - moments.x;
  return variance / (variance + d * d);
}

// Cuts the dark end off, where bleeding lies, and stretches the rest (Lauritzen 2007, GPU Gems 3, section 8.4.3).
float reduce_bleeding(float visibility) {
  return clamp((visibility - light.filter_radii.z) / (1.0 - light.filter_radii.z), 0.0, 1.0);
}
