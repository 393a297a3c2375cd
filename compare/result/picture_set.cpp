#include "compare/result/picture_set.h"

#include <fmt/core.h>

#include <functional>
#include <optional>

#include "compare/measure/pictures.h"
#include "compare/measure/run_all.h"
#include "compare/result/output_parts.h"
#include "compare/result/outputs.h"
#include "scene/base/parallel.h"
#include "scene/files/pictures/image_io.h"

namespace gnomon::compare {
namespace {

constexpr int folder_width = 4096, page_width = 1024;  // pixels

// The smallest whole step that brings a map's picture down to a width.
int step_for_width(const raster::ShadowMap& map, int width) {
  const int across = map.view.face_count > 1 ? 3 : 1;
  int step = 1;
  while (across * ((map.view.size + step - 1) / step) > width) ++step;
  return step;
}

/// What a picture is drawn from: the whole comparison, or rows of it.
struct Part {
  const Comparison& comparison;
  const LightComparison& light;
  const Rgb8Image& drawn;  ///< raster_picture(), where it is wanted
};
using Draw = std::function<Rgb8Image(const Part&)>;
using Wanted = PictureStore::Wanted;

struct Job {
  EncodedPicture* target;
  std::size_t light;
  Wanted wanted;  ///< none: the picture is drawn from what is known without rows
  Draw draw;
};

Draw of_light(Rgb8Image (*draw)(const LightComparison&)) {
  return [draw](const Part& part) { return draw(part.light); };
}

class Jobs {
 public:
  Jobs(const Comparison& c, const PictureStore* store, PictureSet& out) : c_(c), store_(store) {
    add(out.raster, "raster.png", 0, {.raster = true}, [](const Part& part) { return part.drawn; });
    add(out.raytraced, "raytrace.png", 0, {.raytraced = true},
        [](const Part& part) { return raytraced_picture(part.comparison); });
    for (std::size_t i = 0; i < out.lights.size(); ++i) add_light(i, out.lights[i]);
  }
  /// Draws and encodes them.
  Expected<void> run() const;

 private:
  void add(EncodedPicture& target, std::string name, std::size_t light, const Wanted& wanted, Draw draw) {
    target.file_name = std::move(name);
    list_.push_back({&target, light, wanted, std::move(draw)});
  }
  void add_light(std::size_t i, LightPictures& out);
  void add_maps(std::size_t i, LightPictures& out);
  Expected<Rgb8Image> draw_rows(const Job& job) const;

  const Comparison& c_;
  const PictureStore* store_;
  std::vector<Job> list_;
};

void Jobs::add_maps(std::size_t i, LightPictures& out) {
  const std::string suffix = light_suffix(c_, c_.lights[i]);
  const raster::ShadowMap& map = drawn_record(c_, c_.lights[i]).map;
  out.depth_map.file_name = "depth-map" + suffix + ".png";
  out.depth_map_small.file_name = "depth-map-small" + suffix + ".png";
  out.depth_map_step = step_for_width(map, folder_width);
  out.depth_map_small_step = step_for_width(map, page_width);
  if (!c_.raster.has_map()) return;
  const auto add_step = [&](EncodedPicture& target, int step) {
    list_.push_back({&target, i, {}, [&map, step](const Part&) {
                       return step == 1 ? depth_map_picture(map) : depth_map_picture(reduced_map(map, step));
                     }});
  };
  add_step(out.depth_map, out.depth_map_step);
  if (out.depth_map_small_step != out.depth_map_step) add_step(out.depth_map_small, out.depth_map_small_step);
}

void Jobs::add_light(std::size_t i, LightPictures& out) {
  const LightComparison& light = c_.lights[i];
  const StoredLight* stored = store_ != nullptr ? &store_->lights[i] : nullptr;
  const auto& external = drawn_record(c_, light).external;
  const std::string end = light_suffix(c_, light) + ".png";
  add(out.difference, "difference" + end, i, {.raster = true, .visibility = true},
      [](const Part& part) { return difference_picture(part.drawn, part.light); });
  add(out.labels, "labels" + end, i, {.visibility = true}, of_light(label_picture));
  add(out.error, "error" + end, i, {.visibility = true}, of_light(error_picture));
  add_maps(i, out);
  if (stored ? !stored->decisions.empty() : external && !external->decision.data.empty())
    add(out.decisions, "decisions" + end, i, {.raster = true, .decisions = true},
        [](const Part& part) { return decision_picture(part.comparison, part.light); });
  if (c_.raster.has_map() && (stored ? !stored->edges.empty() : !light.edge_map.data.empty())) {
    add(out.edges, "edge-displacement" + end, i, {.visibility = true, .edges = true}, of_light(edge_picture));
    add(out.detachment, "detachment" + end, i, {.detachment = true}, of_light(detachment_picture));
  }
  if (stored ? stored->flip.empty() : light.flip_map.data.empty()) return;
  add(out.flip, "flip" + end, i, {.flip = true}, of_light(flip_picture));
  add(out.ssim, "ssim" + end, i, {.ssim = true}, of_light(ssim_picture));
}

/// A whole picture from rows on the disk.
Expected<Rgb8Image> Jobs::draw_rows(const Job& job) const {
  Rgb8Image image(store_->size());
  for (const PictureRows& rows : bands_of(store_->size(), band_step)) {
    const auto part = store_->rows_of(c_, job.light, rows, job.wanted);
    if (!part) return fail(part.error());
    const Rgb8Image shown = job.wanted.raster ? raster_picture(*part) : Rgb8Image{};
    const Rgb8Image drawn = job.draw({*part, part->lights.front(), shown});
    std::copy(drawn.data.begin(), drawn.data.end(), &image.at(0, rows.first));
  }
  return image;
}

Expected<void> Jobs::run() const {
  const Rgb8Image shown = store_ == nullptr ? raster_picture(c_) : Rgb8Image{};
  const LightComparison none;
  std::vector<Step> steps;
  for (const Job& job : list_)
    steps.emplace_back([&]() -> Expected<void> {
      const bool by_rows = store_ != nullptr && !(job.wanted == Wanted{});
      const Expected<Rgb8Image> image =
          by_rows ? draw_rows(job)
                  : job.draw({c_, job.light < c_.lights.size() ? c_.lights[job.light] : none, shown});
      if (!image) return fail(image.error());
      auto png = encode_png(*image);
      if (!png) return fail(png.error());
      job.target->png = std::move(*png);
      job.target->size = image->size;
      return {};
    });
  constexpr double bytes_per_pixel = 7.0;  // as drawn, as rows of a file, and compressed
  const double bytes =
      store_ != nullptr ? bytes_per_pixel * static_cast<double>(store_->size().pixels()) : 0.0;
  return run_all(steps, store_ != nullptr ? steps_together(bytes) : steps.size());
}

void share_depth_map(LightPictures& light) {
  if (light.depth_map_small.png.empty()) light.depth_map_small = light.depth_map;
}

}  // namespace

std::string light_suffix(const Comparison& c, const LightComparison& light) {
  return c.lights.size() > 1 ? fmt::format("-{}", light_file_part(c, light)) : "";
}

raster::ShadowMap reduced_map(const raster::ShadowMap& map, int step) {
  raster::ShadowMap small;
  small.view = map.view;
  small.view.size = (map.view.size + step - 1) / step;
  small.format = map.format;
  const float empty = map.view.reversed ? 0.0f : 1.0f;
  small.depth.assign(static_cast<std::size_t>(map.view.face_count) *
                         static_cast<std::size_t>(small.view.size) *
                         static_cast<std::size_t>(small.view.size),
                     empty);
  parallel_for(map.view.face_count * small.view.size, [&](int line) {
    const int face = line / small.view.size, small_row = line % small.view.size;
    for (int row = small_row * step; row < std::min((small_row + 1) * step, map.view.size); ++row)
      for (int column = 0; column < map.view.size; ++column) {
        float& nearest = small.depth[small.texel_index(face, column / step, small_row)];
        const float depth = map.depth[map.texel_index(face, column, row)];
        nearest = map.view.reversed ? std::max(nearest, depth) : std::min(nearest, depth);
      }
  });
  return small;
}

Expected<PictureSet> encode_pictures(const Comparison& c, const PictureStore* store) {
  PictureSet set;
  set.lights.resize(c.lights.size());
  if (const auto done = Jobs(c, store, set).run(); !done) return fail(done.error());
  for (LightPictures& light : set.lights) share_depth_map(light);
  return set;
}

}  // namespace gnomon::compare
