#include "compare/bands/picture_store.h"

#include <algorithm>
#include <functional>

#include "compare/bands/run_all.h"
#include "compare/output_parts.h"
#include "compare/outputs.h"
#include "scene/files/image_io.h"

namespace gnomon::compare {
namespace {

/// Rows of one image into their place; false on an error, which is kept.
class Reader {
 public:
  explicit Reader(const PictureRows& rows) : rows_(rows) {}
  template <class T>
  void operator()(const StoredImage<T>& from, Image<T>& to) {
    if (!result_) return;
    auto image = from.read(rows_);
    if (image)
      to = std::move(*image);
    else
      result_ = fail(image.error());
  }
  const Expected<void>& result() const { return result_; }

 private:
  PictureRows rows_;
  Expected<void> result_;
};

using Draw = std::function<Rgb8Image(const Comparison&, const LightComparison&)>;

/// A whole picture from rows of it; `light`: the one whose images are read.
Expected<void> encode(const Comparison& whole, const PictureStore& store, std::size_t light, const Draw& draw,
                      EncodedPicture& out) {
  Rgb8Image image(store.size());
  for (const PictureRows& rows : bands_of(store.size(), band_step)) {
    const auto part = store.rows_of(whole, light, rows);
    if (!part) return fail(part.error());
    const Rgb8Image drawn = draw(*part, part->lights.front());
    std::copy(drawn.data.begin(), drawn.data.end(), &image.at(0, rows.first));
  }
  auto png = encode_png(image);
  if (!png) return fail(png.error());
  out.png = std::move(*png);
  out.size = image.size;
  return {};
}

struct Job {
  EncodedPicture* target;
  const char* name;
  Draw draw;
};

std::vector<Job> jobs_of(const StoredLight& stored, LightPictures& out) {
  std::vector<Job> jobs{
      {&out.difference, "difference",
       [](const Comparison& c, const LightComparison& l) { return difference_picture(c, l); }},
      {&out.labels, "labels",
       [](const Comparison& c, const LightComparison& l) { return label_picture(c, l); }},
      {&out.error, "error", [](const Comparison&, const LightComparison& l) { return error_picture(l); }}};
  if (!stored.decisions.empty())
    jobs.push_back({&out.decisions, "decisions",
                    [](const Comparison& c, const LightComparison& l) { return decision_picture(c, l); }});
  if (stored.edges.empty()) return jobs;
  jobs.push_back({&out.edges, "edge-displacement",
                  [](const Comparison&, const LightComparison& l) { return edge_picture(l); }});
  jobs.push_back({&out.detachment, "detachment",
                  [](const Comparison&, const LightComparison& l) { return detachment_picture(l); }});
  jobs.push_back(
      {&out.flip, "flip", [](const Comparison&, const LightComparison& l) { return flip_picture(l); }});
  jobs.push_back(
      {&out.ssim, "ssim", [](const Comparison&, const LightComparison& l) { return ssim_picture(l); }});
  return jobs;
}

void add_steps(std::vector<Step>& steps, const Comparison& c, const PictureStore& store, std::size_t i,
               LightPictures& out) {
  for (Job& job : jobs_of(store.lights[i], out)) {
    job.target->file_name = job.name + light_suffix(c, c.lights[i]) + ".png";
    steps.emplace_back([&c, &store, i, job = std::move(job)] {
      return encode(c, store, i, job.draw, *job.target);
    });
  }
  steps.emplace_back([&c, i, &out] { return encode_depth_maps(c, c.lights[i], out); });
}

}  // namespace

Expected<Comparison> PictureStore::rows_of(const Comparison& whole, std::size_t light,
                                           const PictureRows& rows) const {
  Comparison out;
  out.world = whole.world;
  out.exposure = whole.exposure;
  Reader read(rows);
  read(raster, out.raster.color);
  read(raytraced, out.raytraced.color);
  if (lights.empty()) {
    out.lights.emplace_back();
    if (!read.result()) return fail(read.result().error());
    return out;
  }
  const StoredLight& stored = lights[light];
  LightComparison& compared = out.lights.emplace_back();
  compared.texel_world = whole.lights[light].texel_world;
  read(stored.truth, compared.rungs.front());
  read(stored.drawn, compared.rungs.back());
  read(stored.labels, compared.labels);
  read(stored.edges, compared.edge_map);
  read(stored.detachment, compared.detachment_map);
  read(stored.flip, compared.flip_map);
  read(stored.ssim, compared.ssim_map);
  out.raster.lights.emplace_back().external.emplace();
  read(stored.decisions, out.raster.lights.front().external->decision);
  if (!read.result()) return fail(read.result().error());
  return out;
}

Expected<PictureSet> encode_pictures(const Comparison& c, const PictureStore& store) {
  PictureSet set;
  set.raster.file_name = "raster.png";
  set.raytraced.file_name = "raytrace.png";
  set.lights.resize(c.lights.size());
  std::vector<Step> steps{
      [&] {
        return encode(
            c, store, 0, [](const Comparison& part, const LightComparison&) { return raster_picture(part); },
            set.raster);
      },
      [&] {
        return encode(
            c, store, 0,
            [](const Comparison& part, const LightComparison&) { return raytraced_picture(part); },
            set.raytraced);
      }};
  for (std::size_t i = 0; i < c.lights.size(); ++i) add_steps(steps, c, store, i, set.lights[i]);
  constexpr double bytes_per_pixel = 9.0;  // as drawn, as rows of a file, and compressed
  const double bytes = bytes_per_pixel * static_cast<double>(store.size().pixels());
  if (const auto done = run_all(steps, steps_together(bytes)); !done) return fail(done.error());
  return set;
}

}  // namespace gnomon::compare
