#include "compare/measure/light_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "compare/bias/bias_curve.h"
#include "compare/metrics/pixel_list.h"
#include "compare/result/option_names.h"
#include "scene/base/parallel.h"

namespace gnomon::compare {

bool has_one_texel_size(const LightView& view) {
  return view.projection == LightProjection::orthographic && view.face_count == 1 && view.face(0).warp == 0.0;
}

std::vector<double> texel_widths(const LadderInput& in, const Image<Label>& labels) {
  const LightView& view = in.record().map.view;
  std::vector<std::uint32_t> pixels =
      pixels_where(labels.data.size(), [&](std::size_t i) { return is_compared(labels.data[i]); });
  if (pixels.empty()) return {};
  if (has_one_texel_size(view)) pixels.erase(pixels.begin() + 1, pixels.end());
  std::vector<double> sizes(pixels.size());
  parallel_for(pixels.size(), [&](std::size_t i) {
    const Vec3& x = in.traced.receiver.data[pixels[i]].position;
    sizes[i] = texel_world_size(view, project_to_face(view, in.record().face.data[pixels[i]], x));
  });
  return sizes;
}

std::array<double, 3> low_middle_high(std::vector<double>& values) {
  if (values.empty()) return {};
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return {*low, *middle, *high};
}

Image<float> visibility_picture(const Image<float>& visibility, const Image<Label>& labels,
                                const PictureRows& rows) {
  Image<float> picture({labels.size.width, rows.count}, 1.0f);
  const std::size_t first = labels.index(0, rows.first);
  for (std::size_t i = 0; i < picture.data.size(); ++i)
    if (const Label label = labels.data[first + i]; is_compared(label) || label == Label::uncertain)
      picture.data[i] = visibility.data[first + i];
  return picture;
}

void ComparedMean::add(const Image<float>& map, const Image<Label>& labels, int first_row) {
  const std::size_t first = labels.index(0, first_row);
  for (std::size_t i = 0; i < map.data.size(); ++i) {
    if (!is_compared(labels.data[first + i]) || std::isnan(map.data[i])) continue;
    sum_ += double{map.data[i]};
    ++count_;
  }
}

double ComparedMean::mean() const {
  return count_ > 0 ? sum_ / static_cast<double>(count_) : std::numeric_limits<double>::quiet_NaN();
}

void StandardErrors::add(const raytrace::LightTruth& truth, const Image<Label>& labels) {
  for (std::size_t i = 0; i < labels.data.size(); ++i) {
    const float share = truth.visibility.data[i];
    if (!is_compared(labels.data[i]) || share <= 0.0f || share >= 1.0f) continue;
    const double error = double{truth.standard_error.data[i]};
    sum_ += error;
    max_ = std::max(max_, error);
    ++count_;
  }
}

void StandardErrors::write_to(PenumbraStats& out) const {
  out.standard_error_max = max_;
  if (count_ > 0) out.standard_error_mean = sum_ / static_cast<double>(count_);
}

std::string_view why_no_curve(const raster::RasterFrame& drawn, const raster::LightRecord& record) {
  if (record.foreign && !drawn.custom_shader)
    return !record.has_known_map()
               ? std::string_view("The picture came without its map: there are no gaps to follow.")
               : std::string_view();
  if (biases_follow_from_gaps(drawn)) return {};
  if (drawn.custom_shader)
    return "A shader of --shader-dir drew this: what it would draw with another bias does not follow from "
           "one "
           "drawing.";
  if (!compares_depths(drawn.options.map.technique))
    return "This technique compares no stored depths: a bias does not change what it draws.";
  return "This technique filters: what it would draw with another bias does not follow from one drawing; a "
         "sweep over --bias draws each.";
}

}  // namespace gnomon::compare
