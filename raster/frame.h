// What the rasterizer hands on: images and per-pixel records that need no OpenGL to read.
// Pixel arrays are row-major, row 0 at the top. Map arrays are face by face, row 0 = lowest v (light_view.h).
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "raster/external_visibility.h"
#include "raster/options.h"
#include "scene/base/time_difference.h"
#include "scene/base/timing.h"
#include "scene/image.h"
#include "scene/light_map/light_view.h"

namespace gnomon::raster {

struct ContextInfo {
  std::string backend;   ///< "osmesa", "egl-software", "egl-hardware", "webgl2"; "window" in the viewer
  std::string version;   ///< GL_VERSION
  std::string renderer;  ///< GL_RENDERER
  int max_map_size = 0;  ///< texels
};

/// Whether a context of that backend has what only OpenGL 4.5 does: storage buffers, and doubles in shaders.
constexpr bool is_whole(std::string_view backend) {
  return backend != "webgl2";
}

/// The depth map as stored.
struct ShadowMap {
  LightView view;
  DepthFormat format = DepthFormat::d32f;
  std::vector<float>
      depth;  ///< stored value in [0, 1]; 1 where nothing was drawn (0 where depths are reversed); faces*size*size
  /// Where casters have a bias of their own the same without it; else empty.
  std::vector<float> unbiased;
  /// What the casters' own depths are.
  const std::vector<float>& true_depth() const { return unbiased.empty() ? depth : unbiased; }
  std::size_t texel_index(int face, int column, int row) const {
    const auto n = static_cast<std::size_t>(view.size);
    return (static_cast<std::size_t>(face) * n + static_cast<std::size_t>(row)) * n +
           static_cast<std::size_t>(column);
  }
};

/// World width of a texel of the map, as a bias in texels is measured. On a perspective map it is taken at
/// the depth of the finite scene's centre. When the scene has no such centre before the light, it is taken
/// halfway through the map (geometric mean).
double texel_world(const LightView& view, const World& world);

/// What a bias that follows the receiver's plane leaves to rounding, so that a plane does not shadow itself.
struct BiasRounding {
  double float_world = 0.0;  ///< of the shaders' floats, world units
  double stored_step = 0.0;  ///< of the depth format, stored depth
  /// Bias::adaptive: 1e-4 of the scene's diagonal (Dou et al. 2014).
  double adaptive_epsilon_world = 0.0;
  /// Where a map's texels differ in size by design (csm, lispsm) and the constant bias is not in world
  /// units: the texel that the constant was converted with; a lookup's bias is the constant times its own
  /// texel over this. Else 0.
  double constant_texel_world = 0.0;
};

/// What rounding may do to a comparison, world units: floats and one step of the stored depth, on a
/// perspective map where the finite scene is farthest from the light.
double rounding_world(const BiasRounding& rounding, const LightView& view, const World& world);
/// The constant that a slope bias of 1 needs beside it: rounding_world(), and automatic_bias_texels of a
/// texel for curved surfaces.
double automatic_bias_world(const BiasRounding& rounding, const LightView& view, const World& world);
/// The constant bias in world units; where it scales, on a texel of BiasRounding::constant_texel_world.
double constant_bias_world(const Bias& bias, const BiasRounding& rounding, const LightView& view,
                           const World& world);

/// The casters' constant bias in world units along the light ray; where a map's texels differ in size by design (csm,
/// lispsm) and it is in texels, on a texel of texel_world().
double caster_bias_world(const Bias& bias, const LightView& view, const World& world);

class MapTest;

/// World units that 1 of a stored number counts for at so far from the light.
struct UnitAt {
  double distance = 0.0, world = 1.0;
};

/// Another renderer's picture.
struct ForeignPicture {
  /// How its map is tested. None: the map is not known; the record's holds nothing, and no technique is known to have
  /// drawn the picture.
  std::shared_ptr<const MapTest> test;
  std::vector<std::string_view> said{};  ///< MapSetting::name of the filter's settings that it says
  std::string_view stores = "depths";    ///< what a texel holds
  /// A number of the filter's that the rasterizer has no setting for.
  struct Number {
    const char* key;
    const char* words;
    double value = 0.0;
  };
  std::vector<Number> numbers{};
  double unit_world = 1.0;        ///< that 1 of a stored number counts for, as the test is told
  std::array<UnitAt, 2> units{};  ///< at the nearest and the farthest receiver; alike where it is one length
};

/// One light's records, per pixel. Only where a primitive is visible; elsewhere visibility is 1, the rest 0.
/// The images and map.depth are empty unless RasterOptions::analysis.
struct LightRecord {
  std::uint32_t light = 0;  ///< index in Scene::lights
  ShadowMap map;
  BiasRounding rounding;
  double bias_constant_world = 0.0;    ///< the constant bias in world units, after unit conversion
  double caster_constant_world = 0.0;  ///< the casters' constant bias in world units, in the same way
  double texel_world = 0.0;            ///< what a bias in texels is a multiple of (texel_world())
  double rounding_world = 0.0;         ///< what a bias that follows the receiver's plane leaves to rounding
  Image<float> visibility;   ///< what was drawn, in [0, 1]: 1 lit, 0 shadowed (rung V6). Not times n.l
  Image<Vec2f> texel_uv;     ///< the receiver's own map position in texels, before any offset
  Image<std::uint8_t> face;  ///< of texel_uv
  Image<float> distance;     ///< along the light ray, world units
  /// The gap less every part of the bias but the constant: a hard test shadows iff gap >
  /// float(bias_constant_world). Where BiasRounding::constant_texel_world is not 0 it is given in multiples
  /// of the texel looked up, times that. -infinity where nothing is stored or the lookup falls outside the
  /// map, and where the bias has no bound; +infinity where the receiver's plane is not met there; never NaN.
  Image<float> gap;
  /// 1 where the lookup falls beside the map or behind the light, or finds nothing stored for a receiver that
  /// lies outside the map's depth range.
  Image<std::uint8_t> outside_map;
  /// ms, from an idle device to glFinish, without the analysis. map_pass: the whole depth map, all faces, and
  /// what the technique makes of it (blur, mipmaps ...).
  /// shade_pass: the camera's visibility buffer and this light's shading of every pixel.
  Times map_pass, shade_pass;
  std::uint64_t map_texels = 0;  ///< texels rendered for this light, blur and the like included
  /// RasterOptions::shadow_cost: run by run beside shade_pass, the same shading by a shader that looks nothing
  /// up and takes every receiver for lit. What shade_pass takes beyond it is the shadows'.
  Times unshadowed_pass;
  std::vector<TimedStrip> strips;  ///< the two strip by strip, which were shaded in turn (beyond_part)
  double first_map_ms =
      0.0;  ///< the map's memory, what is compiled for it, and its first run, in map_pass too; 0: not timed
  /// What each pixel's visibility took of the map: texels compared, or filtered reads of moments.
  Image<std::uint16_t> lookups;
  std::optional<ExternalCosts> external;  ///< Technique::hybrid
  std::optional<ForeignPicture> foreign;  ///< another renderer drew `visibility`, and the map if it is known

  /// False where another renderer drew the picture and its map was not handed on.
  bool has_known_map() const { return !foreign || foreign->test; }
};

/// A file of the user's that was compiled in place of the program's own (--shader-dir).
struct ReplacedShader {
  std::string name;    ///< "technique/hard.glsl"
  std::string sha256;  ///< of the user's file
  bool operator==(const ReplacedShader&) const = default;
};

/// Files of a shader folder that stand in for those which turn the map into visibility.
struct CustomShader {
  std::vector<std::string> files;  ///< as named in shaders/, such as "technique/hard.glsl"
  /// Its text names the bias or the biased gap: then the bias is a part of what it draws.
  bool reads_bias = false;
};

/// What drawing took on the device (RasterOptions::span_drawings), milliseconds of all drawings of each kind together.
struct ShadowSpans {
  bool counted = false;  ///< false: the device lost count, and the times are 0
  bool by_device =
      false;  ///< by the device's own clock; else by the processor's, from an idle device to an idle device
  double map_ms = 0.0, shaded_ms = 0.0, unshadowed_ms = 0.0;
};

struct RasterFrame {
  ContextInfo context;
  std::vector<ReplacedShader> replaced_shaders;  ///< those that drew this frame
  RasterOptions options;
  ColorImage color;                 ///< linear radiance, all lights
  Image<std::uint32_t> primitive;   ///< visible primitive (World numbering) or no_id
  std::vector<LightRecord> lights;  ///< in the order asked for
  std::optional<CustomShader> custom_shader;
  double upload_ms = 0.0;        ///< of the world to the device, once for all frames
  double read_back_ms = 0.0;     ///< of pictures, maps and records, for the comparison alone
  std::uint64_t map_texels = 0;  ///< texels rendered, all lights, blur and the like included
  std::uint64_t map_bytes = 0;   ///< device memory of maps at one time: the lights take turns in it

  /// Tells for all lights whether their maps are known: another renderer's picture is of one light.
  bool has_known_map() const { return lights.empty() || lights.front().has_known_map(); }
  /// There are texels to measure with: the map is known, and the technique has one.
  bool has_map() const;
};

}  // namespace gnomon::raster
