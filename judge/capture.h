// A capture: what another renderer drew of one light's shadow, as its file says (capture.schema.json). What
// the file names is read by capture_pictures.h and captured_map.h.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "judge/conventions.h"
#include "raster/options.h"
#include "scene/base/expected.h"
#include "scene/image.h"
#include "scene/math.h"

namespace gnomon::judge {

/// What a depth buffer of the camera holds.
enum class PixelDepth : std::uint8_t { view_z, distance, zero_to_one, reversed };
enum class RowOrder : std::uint8_t { top_down, bottom_up };
enum class FilterName : std::uint8_t { none, pcf, pcss, vsm, esm, evsm, msm };

inline constexpr std::array<std::string_view, 4> pixel_depth_names{"view_z", "distance", "zero_to_one",
                                                                   "reversed"};
inline constexpr std::array<std::string_view, 2> row_order_names{"top_down", "bottom_up"};
constexpr raster::Technique technique_of(FilterName filter) {
  using enum raster::Technique;
  constexpr std::array techniques{hard, pcf, pcss, vsm, esm, evsm, msm};
  return techniques[static_cast<std::size_t>(filter)];
}
constexpr bool has_moments(FilterName kind) {
  return kind >= FilterName::vsm;
}
inline constexpr std::array<std::string_view, 2> select_names{"view_z", "distance"};
/// How its renderer makes shadows. A ray tracer has no map.
enum class RendererKind : std::uint8_t { rasterizer, ray_tracer };
inline constexpr std::array<std::string_view, 2> renderer_kind_names{"rasterizer", "ray_tracer"};
inline constexpr std::array<std::string_view, 7> filter_names{"none", "pcf",  "pcss", "vsm",
                                                              "esm",  "evsm", "msm"};

struct CapturedDepth {
  std::string file;
  std::optional<PixelDepth> convention;
  std::optional<double> near, far;  ///< world units, of zero_to_one and reversed
};

/// How far casters were moved from the light while the map was drawn; below 0 towards it.
struct CapturedCasterBias {
  double constant = 0.0;        ///< stored numbers; of distances, world units
  double constant_world = 0.0;  ///< world units along the light ray
  double slope = 0.0;           ///< raster::Bias::caster_slope: the factor of glPolygonOffset
  double clamp = 0.0;  ///< the most that `constant` and `slope` add, below 0 the least; 0: without limit
  double normal_offset_world = 0.0;                 ///< against their normals
  BiasAngle normal_offset_angle = BiasAngle::none;  ///< no tangent
  bool moves() const {
    return constant != 0.0 || constant_world != 0.0 || slope != 0.0 || normal_offset_world != 0.0;
  }
  bool operator==(const CapturedCasterBias&) const = default;
};

struct CapturedBias {
  double constant_depth = 0.0;  ///< stored numbers; positive takes shadow away
  double slope = 0.0;           ///< as raster::Bias::slope
  double normal_offset_world = 0.0;
  /// By what the constant is multiplied before it is held within `min` and `max`, stored numbers.
  BiasAngle angle = BiasAngle::none;
  double min = -infinity, max = infinity;
  BiasAngle normal_offset_angle = BiasAngle::none;  ///< no tangent
};

/// Which pixels look a layer up, by how far they lie from the camera.
struct CapturedSelect {
  double near = 0.0, far = infinity;  ///< world units; near <= distance < far
  bool by_distance = false;           ///< from the eye; else along the view's axis
  double blend = 0.0;  ///< world units before `far` over which the next layer takes over, linearly
};

/// Where shadows fade out, linearly with the distance from the camera: whole up to `from`, none beyond `to`.
struct CapturedFade {
  double from = 0.0, to = infinity;  ///< world units, from <= to
  bool by_distance = false;          ///< from the eye; else along the view's axis
};

/// Where a layer lies in a picture that several layers share: texels from its first column and row.
struct CapturedRect {
  int x = 0, y = 0, width = 0, height = 0;
};

inline constexpr std::size_t most_layers = LightView::most_faces;

struct CapturedLayer {
  std::string depth;  ///< file
  std::optional<StoredDepth> convention;
  std::optional<RowOrder> rows;
  std::optional<Mat4> clip_from_world;
  std::optional<CapturedCasterBias> caster_bias;
  std::optional<CapturedBias> bias;  ///< in place of the capture's
  std::optional<CapturedRect> rect;
  std::optional<CapturedSelect> select;
  /// World units that are stored as 0 and as 1, where is_linear(); left out: 0 and 1, stored are world units.
  std::optional<Vec2> range;
};

struct CapturedFilter {
  FilterName kind = FilterName::none;
  double radius_texels = 1.5;  ///< in (0, 64]
  FilterRead read = FilterRead::nearest;
  // Of moments alone.
  std::vector<double> exponents{};  ///< esm: one; evsm: that of the positive warp, and of the negative one
  double light_bleeding_reduction = 0.0;                     ///< in [0, 1)
  double minimum_variance = 0.0;                             ///< >= 0
  double moment_bias = raster::FilterOptions{}.moment_bias;  ///< msm, in (0, 1]
};

/// Files are as they can be opened: joined with the capture's folder.
struct Capture {
  std::string path;  ///< of the capture; empty when options alone say it
  std::string renderer, version;
  std::optional<RendererKind> kind{};
  std::vector<std::pair<std::string, std::string>> settings;
  std::string scene;          ///< file or built-in scene
  std::string camera, light;  ///< name, or place in the list from 0; empty: the first, the only one
  ImageSize size;             ///< 0 x 0: not said
  std::string visibility, shadowed, unshadowed, position;
  std::optional<CapturedDepth> depth;
  std::vector<CapturedLayer> map;
  std::optional<CapturedBias> bias;
  std::optional<CapturedFilter> filter;
  std::optional<double> strength;  ///< of the shadow, in (0, 1]: full shadow is drawn as 1 - strength
  std::optional<CapturedFade> fade;
  std::string also;  ///< file: what else darkens the picture, to be divided out
  Vec2 jitter{0.0};  ///< pixels, of what each pixel shows from its centre, to the right and downwards
  bool casters_found = false;  ///< which meshes cast was found from a frame, and nobody said so
  std::string within;          ///< "lights[1]." before the fields of one light of several; else empty
};

/// Reads a capture's lights: one Capture for each of `lights`, each with what they share; of a capture without `lights` one.
/// Errors (bad input) name file, line, column and field. Whether the parts go together is check_capture's.
Expected<std::vector<Capture>> read_captures(const std::string& path);
/// Reads the capture of one light: that of the name, or, where none has it, in that place of `lights`, from 0. Empty: the only
/// one; an error (bad input) where there are several.
Expected<Capture> read_capture(const std::string& path, const std::string& light = {});

/// Says what is missing or contradicts: ErrorKind::bad_input with the field.
Expected<void> check_capture(const Capture& capture);

/// An error of a field of this capture.
tl::unexpected<Error> capture_error(const Capture& capture, const std::string& field, std::string reason);

}  // namespace gnomon::judge
