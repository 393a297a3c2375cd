// The bias that a map's casters are drawn with: a constant along the light ray, and a factor of the slope as glPolygonOffset
// has it (OpenGL 4.5, section 14.6.5). Done here, for the unit of that call's constant changes with the depth format and
// from polygon to polygon, and shapes are no polygons.

layout(location = caster_bias_uniform) uniform vec4 caster_bias;  // world units; factor; texel of the constant or 0; face

// World units along the light ray, at the fragment.
float caster_constant(int face) {
  if (!(caster_bias.z > 0.0)) return caster_bias.x;
  Texel at;
  at.face = face;
  at.local = vec3(0.0);
#ifdef WARP
  float extent = light.extent_and_depths[face].y;
  at.local.y = unwarped(face, (2.0 * gl_FragCoord.y / light.origin_and_size.w - 1.0) * extent);
#endif
  return caster_bias.x * texel_world_size(at) / caster_bias.z;
}

// What the map stores of a caster at `stored`, in [0, 1], whose stored depth changes by `slope` from texel to texel along
// the axis where it changes more.
float biased_caster(float stored, float slope) {
  int face = int(caster_bias.w);
  vec4 range = light.extent_and_depths[face];
  float constant = caster_constant(face);
#ifdef PERSPECTIVE
  vec2 ray = (2.0 * gl_FragCoord.xy / light.origin_and_size.w - 1.0) * range.xy;
  float along = constant / length(vec3(ray, 1.0));
  float z = depth_from_stored(ivec3(gl_FragCoord.xy, face), stored);
  float moved = range.z * range.w * along / ((range.w - range.z) * z * (z + along));
#else
  float moved = constant / (range.w - range.z) * warp_share(face, gl_FragCoord.y);
#endif
  moved += caster_bias.y * slope;
#ifdef REVERSED
  moved = -moved;
#endif
  return clamp(stored + moved, 0.0, 1.0);
}
