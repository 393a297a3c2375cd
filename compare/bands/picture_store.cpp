#include "compare/bands/picture_store.h"

#include <algorithm>
#include <functional>

#include "compare/bands/run_all.h"
#include "compare/output_parts.h"
#include "compare/outputs.h"
#include "scene/files/image_io.h"

namespace gnomon::compare {
namespace {

/// Rows of one image into their place; the first error is kept.
class Reader {
 public:
  explicit Reader(const PictureRows& rows) : rows_(rows) {}
  template <class T>
  void operator()(bool wanted, const StoredImage<T>& from, Image<T>& to) {
    if (!wanted || !result_) return;
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
using Wanted = PictureStore::Wanted;

/// A whole picture from rows of it; `light`: the one whose images are read.
Expected<void> encode(const Comparison& whole, const PictureStore& store, std::size_t light,
                      const Wanted& wanted, const Draw& draw, EncodedPicture& out) {
  Rgb8Image image(store.size());
  for (const PictureRows& rows : bands_of(store.size(), band_step)) {
    const auto part = store.rows_of(whole, light, rows, wanted);
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

struct StoredPicture {
  EncodedPicture* target;
  const char* name;
  Wanted wanted;
  Draw draw;
};

/// A picture of what is known of the light alone.
Draw of_light(Rgb8Image (*draw)(const LightComparison&)) {
  return [draw](const Comparison&, const LightComparison& light) { return draw(light); };
}

std::vector<StoredPicture> pictures_of(const StoredLight& stored, LightPictures& out) {
  std::vector<StoredPicture> pictures;
  const auto add = [&](EncodedPicture& target, const char* name, const Wanted& wanted, Draw draw) {
    pictures.push_back({&target, name, wanted, std::move(draw)});
  };
  add(out.difference, "difference", {.raster = true, .visibility = true},
      [](const Comparison& c, const LightComparison& l) { return difference_picture(c, l); });
  add(out.labels, "labels", {.visibility = true}, of_light(label_picture));
  add(out.error, "error", {.visibility = true}, of_light(error_picture));
  if (!stored.decisions.empty())
    add(out.decisions, "decisions", {.raster = true, .decisions = true}, decision_picture);
  if (stored.edges.empty()) return pictures;
  add(out.edges, "edge-displacement", {.visibility = true, .edges = true}, of_light(edge_picture));
  add(out.detachment, "detachment", {.detachment = true}, of_light(detachment_picture));
  add(out.flip, "flip", {.flip = true}, of_light(flip_picture));
  add(out.ssim, "ssim", {.ssim = true}, of_light(ssim_picture));
  return pictures;
}

void add_steps(std::vector<Step>& steps, const Comparison& c, const PictureStore& store, std::size_t i,
               LightPictures& out) {
  for (StoredPicture& picture : pictures_of(store.lights[i], out)) {
    picture.target->file_name = picture.name + light_suffix(c, c.lights[i]) + ".png";
    steps.emplace_back([&c, &store, i, picture = std::move(picture)] {
      return encode(c, store, i, picture.wanted, picture.draw, *picture.target);
    });
  }
  steps.emplace_back([&c, i, &out] { return encode_depth_maps(c, c.lights[i], out); });
}

}  // namespace

Expected<Comparison> PictureStore::rows_of(const Comparison& whole, std::size_t light,
                                           const PictureRows& rows, const Wanted& wanted) const {
  Comparison out;
  out.world = whole.world;
  out.exposure = whole.exposure;
  Reader read(rows);
  read(wanted.raster, raster, out.raster.color);
  read(wanted.raytraced, raytraced, out.raytraced.color);
  if (lights.empty()) {
    out.lights.emplace_back();
    if (!read.result()) return fail(read.result().error());
    return out;
  }
  const StoredLight& stored = lights[light];
  LightComparison& compared = out.lights.emplace_back();
  compared.texel_world = whole.lights[light].texel_world;
  read(wanted.visibility, stored.truth, compared.rungs.front());
  read(wanted.visibility, stored.drawn, compared.rungs.back());
  read(wanted.visibility, stored.labels, compared.labels);
  read(wanted.edges, stored.edges, compared.edge_map);
  read(wanted.detachment, stored.detachment, compared.detachment_map);
  read(wanted.flip, stored.flip, compared.flip_map);
  read(wanted.ssim, stored.ssim, compared.ssim_map);
  out.raster.lights.emplace_back().external.emplace();
  read(wanted.decisions, stored.decisions, out.raster.lights.front().external->decision);
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
            c, store, 0, {.raster = true},
            [](const Comparison& part, const LightComparison&) { return raster_picture(part); }, set.raster);
      },
      [&] {
        return encode(
            c, store, 0, {.raytraced = true},
            [](const Comparison& part, const LightComparison&) { return raytraced_picture(part); },
            set.raytraced);
      }};
  for (std::size_t i = 0; i < c.lights.size(); ++i) add_steps(steps, c, store, i, set.lights[i]);
  constexpr double bytes_per_pixel = 7.0;  // as drawn, as rows of a file, and compressed
  const double bytes = bytes_per_pixel * static_cast<double>(store.size().pixels());
  if (const auto done = run_all(steps, steps_together(bytes)); !done) return fail(done.error());
  return set;
}

}  // namespace gnomon::compare
