#include "compare/measure/pictures.h"

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

}  // namespace gnomon::compare
