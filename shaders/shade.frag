// One light's share of the picture, from the visibility buffer and the light's depth map. Permutations: FIRST_LIGHT
// adds what needs no light (ambient, emission, background); NO_LIGHT does only that; RECORDS writes, besides, what was tested.
// UNSHADOWED looks nothing up, so that what shadows cost can be told from what the picture costs.
// TECHNIQUE names the file of technique/ whose technique_visibility() says how much of the light the receiver gets.
#include "shared_constants.h"
#ifndef NO_LIGHT
#include "light.glsl"
#include "gap.glsl"
#include "technique/$TECHNIQUE.glsl"
#else
const float infinite = uintBitsToFloat(0x7f800000u);
#endif
#include "receiver.glsl"
#include "blinn_phong.glsl"

layout(binding = visibility_unit) uniform usampler2D visible_primitive;

layout(location = radiance_output) out vec4 radiance;
#ifdef RECORDS
layout(location = record_output) out vec4 record;  // texel u, v, distance, gap
layout(location = flags_output) out uint flags;
layout(location = visibility_output) out vec2 visibility_record;  // and the map's texels that it took
#endif

const uint no_id = 0xffffffffu;

void main() {
  uint primitive = texelFetch(visible_primitive, ivec2(window_position(gl_FragCoord)), 0).r;
  radiance = vec4(0.0, 0.0, 0.0, 1.0);
#ifdef RECORDS
  record = vec4(0.0);
  flags = 0u;
  visibility_record = vec2(1.0, 0.0);
#endif
  if (primitive == no_id) {
#ifdef FIRST_LIGHT
    radiance.rgb = camera.background.rgb;
#endif
    return;
  }
  Receiver r = receiver_at(primitive, window_position(gl_FragCoord));
  MaterialData material = material_at(r.material);
  vec3 albedo = surface_albedo(material, r.uv).rgb;
#ifdef VERTEX_COLORS
  albedo *= r.color.rgb;
#endif
#ifdef UNLIT
  if (material.emission_uv_offset_and_unlit.z != 0.0) {
#ifdef FIRST_LIGHT
    radiance.rgb += albedo;
#endif
    albedo = vec3(0.0);
  }
#endif
  vec3 diffuse = albedo + material.emission_and_matte.w;
#ifdef FIRST_LIGHT
  radiance.rgb += camera.ambient.rgb * diffuse;
#ifdef EMISSION
  radiance.rgb += surface_emission(material, r.uv);
#endif
#endif
#ifndef NO_LIGHT
  LightAtPoint at = light_at(r.position);
#if (defined(EXTERNAL) || defined(UNSHADOWED)) && !defined(RECORDS)
  ShadowTest test;  // nothing of it is read
#else
  ShadowTest test = shadow_test(r.position, r.normal, at.to_light);
#endif
  float visibility = technique_visibility(test, r.position, r.normal, at.to_light);
#ifdef NON_RECEIVERS
  bool lit_always = (material.shadow_flags & uint(receives_none)) != 0u;  // as if the map ended before it
  if (lit_always) visibility = 1.0;
#else
  const bool lit_always = false;
#endif
  if (visibility > 0.0 && dot(r.normal, at.to_light) > 0.0)
    radiance.rgb += visibility * blinn_phong(diffuse, material.specular_and_shininess, at.irradiance, r.shading,
                                             at.to_light, r.to_eye);
#ifdef RECORDS
  record = vec4(lit_always ? vec2(-1.0) : test.own.uv, test.own.distance, test.gap);
  flags = uint((test.outside || lit_always ? flag_outside_map : 0) | (test.own.face << flag_face_shift));
  visibility_record = vec2(visibility, lookups);
#endif
#endif
}
