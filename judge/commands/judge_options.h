// Every part of a capture as an option of `judge`.
#pragma once

#include "judge/capture.h"

namespace CLI {
class App;
}

namespace gnomon::app {

/// Parts given on the command line; they take the place of the file's.
struct CaptureOptions {
  judge::Capture given;
  std::vector<std::string> map_files, map_matrices, settings;
  std::optional<judge::StoredDepth> map_convention;
  std::optional<judge::RowOrder> map_rows;
  std::optional<double> bias_constant, bias_slope, bias_normal_offset;  ///< as judge::CapturedBias
  /// These mean what judge::CapturedCasterBias says, and hold for all layers.
  std::optional<double> caster_constant, caster_constant_world, caster_slope, caster_clamp;
  std::optional<judge::FilterName> filter_kind;
  std::optional<double> filter_radius;  ///< texels
  bool any = false;
};

void add_capture_options(CLI::App& app, CaptureOptions& options);

/// An error of a capture that options alone make: of the option that gives the field, instead of a file's field.
/// Errors of anything else are left as they are.
Error named_by_option(Error error, const CaptureOptions& options);
/// Names the option of an error that lies in the options themselves: something is missing, or contradicts.
Error usage_error(Error error, const CaptureOptions& options);

/// The capture with the options' parts in place of its own: a part alone, such as one of the bias' numbers, leaves the
/// others as they are; a picture of another kind (visibility for a ratio, positions for depths) replaces that. Error (usage) where matrices and layers do not go
/// together.
Expected<judge::Capture> with_options(judge::Capture capture, const CaptureOptions& options);

}  // namespace gnomon::app
