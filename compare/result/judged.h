// What a comparison says beyond the rest when another renderer drew the picture.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "raster/frame.h"

namespace gnomon::compare {

/// One figure of agreement between the capture and Gnomon's own view of the scene.
struct Agreement {
  std::string what;    ///< "silhouettes", "positions", "depths", "visibility"
  double share = 1.0;  ///< in [0, 1]
};

/// What was wrong with the capture's conventions, and what --fix did about it.
struct Mended {
  std::string what;                  ///< "the picture is upside down"
  std::string evidence;              ///< "silhouettes"
  double before = 0.0, after = 0.0;  ///< shares of what agrees
};

/// The nearest setting of Gnomon's own to a picture whose map is not known.
struct Identified {
  std::string technique;  ///< as --technique
  std::string options;    ///< "--technique pcf --map-size 1024 --bias 0.01"
  int map_size = 0;
  double bias_world = 0.0, bias_texels = 0.0;
  double explained = 0.0;  ///< share of the capture's error that the model's has, too; in [0, 1]
  double model_error = 0.0, picture_error = 0.0;  ///< mean |model - picture|, mean |truth - picture|
  int renders = 0;
};

/// A number that the renderer's user can type in, in the renderer's own units.
struct AdvisedSetting {
  std::string setting;  ///< "bias.constant_depth"
  double now = 0.0, instead = 0.0;
  std::string unit;  ///< "stored depth", "world units"
  /// World units in one of the unit, and in a texel of the layer; 0: the setting is no length.
  double unit_world = 0.0, texel_world = 0.0;
  /// What one of the unit is at the nearest and the farthest receiver, where it is no single length.
  std::array<raster::UnitAt, 2> units = {};
};
struct Advice : AdvisedSetting {
  /// Shares of all compared pixels, those outside the map among them. One is of what was drawn, one of what the filter and
  /// test that are in use draw on the same map.
  double wrong_now = 0.0, wrong_instead = 0.0;
  bool feasible = false;                    ///< with it every compared pixel is right
  std::optional<AdvisedSetting> with = {};  ///< what is to be set together with it
  std::vector<AdvisedSetting> layers =
      {};  ///< the same of the layers after the first, where each has its own
  /// The constant of every layer in its own texels, where that is one number.
  std::optional<double> texels_of_each = {};
  /// The whole advice as settings of the engine that drew, where it is known (engine_units.h).
  std::vector<std::pair<std::string, double>> in_engine = {};
  /// The mean error of the same drawings, in [0, 1].
  std::optional<double> mean_now = {}, mean_instead = {};
  /// What is promised is good to a fifth: the filter is known in kind alone, or pixels that change are not explained by the
  /// description. Else to 0.05 % of the pixels.
  bool about = false;
};

/// Light of something else in both pictures of a ratio (ambient light, a sky), found and undone.
struct OtherLight {
  double full_shadow =
      1.0;  ///< the share of its light that a full shadow takes from a pixel, median over those that differ
  std::uint64_t pixels = 0;  ///< that differ clearly
  double agree = 0.0;        ///< the share of them that is in full shadow as the others are
  std::string read_as;       ///< "linear numbers", "sRGB", ...
};

struct Judged {
  std::string capture;  ///< its path; empty when options said it
  std::string renderer, version;
  std::string engine;  ///< EngineUnit::engine whose settings the renderer has; empty: not known
  std::vector<std::pair<std::string, std::string>> settings;
  bool has_map = false, has_positions = false, of_ratio = false;
  bool traces = false;                      ///< its renderer traces rays: what is wrong is no map's
  std::optional<OtherLight> other_light{};  ///< of a ratio
  std::vector<Agreement> agreement;         ///< after what was mended
  std::vector<Mended> mended;
  std::optional<Identified> identified;
  bool advice_sought =
      false;  ///< other biases were tried; where none is worth advising `advice` is empty all the same
  std::vector<Advice> advice;
  /// What mends most of the error, as a sentence, where that is no bias: it stands in the advice's place.
  std::string cure{};
  std::vector<std::string> notes;
  /// With a map: the share of the compared pixels whose V5 is V6; of a map without filter all but those on
  /// the borders of texels.
  double biased_is_drawn = 0.0;
  double unit_world = 0.0;                ///< world units that 1 of the map's stored numbers counts for
  std::array<raster::UnitAt, 2> units{};  ///< as of ForeignPicture
};

struct Comparison;

/// "three.js: shadow.bias -0.0015, shadow.normalBias 0.02"; empty where the engine is not known.
std::string in_engine_text(const Judged& judged, const Advice& advice);

/// "bias 0.0021 instead of 0.0005 (stored depth): 0.31 % wrong instead of 4.2 %"
std::string advice_text(const Advice& advice);

/// The renderer's name and version.
std::string renderer_text(const Judged& judged);

/// What is said of the capture, as names and values for a terminal and the page: "drawn by", "agreement",
/// "advice", ...
std::vector<std::pair<std::string, std::string>> judged_lines(const Comparison& comparison);

}  // namespace gnomon::compare
