// Materials, with permutations TEXTURES (some material has one), ALPHA_MASK (some surface has holes) and UNLIT (some
// material shows its colour without light).
// Twin of raster/world/world_buffers.h.

const uint no_texture = 0xffffffffu;

struct MaterialData {
  vec4 diffuse_and_alpha;      // diffuse and specular are those of the share that neither mirrors nor transmits
  vec4 specular_and_shininess;
  vec4 emission_and_matte;   // w: the grey that stands for what mirrors or transmits
  vec4 uv_matrix;            // columns of R * scale
  vec4 uv_offset_and_cutoff; // z: alpha below this is no hit; negative for opaque materials
  vec4 emission_uv_matrix;
  vec4 emission_uv_offset_and_unlit; // z: not 0 for a colour that no light changes
  uint diffuse_texture, emission_texture;
  uint shadow_flags;         // casts_none, receives_none
  uint unused;
};

layout(binding = materials_unit) uniform usamplerBuffer material_texels;

bool casts_shadow(uint material) {
  return (texelFetch(material_texels, int(material) * material_texel_count + 7).z & uint(casts_none)) == 0u;
}

vec4 material_texel(int at) { return uintBitsToFloat(texelFetch(material_texels, at)); }

MaterialData material_at(uint index) {
  int at = int(index) * material_texel_count;
  uvec4 last = texelFetch(material_texels, at + 7);
  return MaterialData(material_texel(at), material_texel(at + 1), material_texel(at + 2), material_texel(at + 3),
                      material_texel(at + 4), material_texel(at + 5), material_texel(at + 6), last.x, last.y, last.z,
                      last.w);
}

#ifdef TEXTURES
#include "texture.glsl"
#endif

// Diffuse colour and alpha of a surface point.
vec4 surface_albedo(MaterialData material, vec2 uv) {
  vec4 albedo = material.diffuse_and_alpha;
#ifdef TEXTURES
  if (material.diffuse_texture != no_texture) {
    mat2 linear = mat2(material.uv_matrix.xy, material.uv_matrix.zw);
    albedo *= sample_texture(material.diffuse_texture, material.uv_offset_and_cutoff.xy + linear * uv);
  }
#endif
  return albedo;
}

vec3 surface_emission(MaterialData material, vec2 uv) {
  vec3 emission = material.emission_and_matte.rgb;
#ifdef TEXTURES
  if (material.emission_texture != no_texture) {
    mat2 linear = mat2(material.emission_uv_matrix.xy, material.emission_uv_matrix.zw);
    emission *= sample_texture(material.emission_texture, material.emission_uv_offset_and_unlit.xy + linear * uv).rgb;
  }
#endif
  return emission;
}

#ifdef ALPHA_MASK
bool is_hole(MaterialData material, vec2 uv, float vertex_alpha) {
  return material.uv_offset_and_cutoff.z >= 0.0 &&
         surface_albedo(material, uv).a * vertex_alpha < material.uv_offset_and_cutoff.z;
}
bool is_hole(MaterialData material, vec2 uv) { return is_hole(material, uv, 1.0); }
#endif
