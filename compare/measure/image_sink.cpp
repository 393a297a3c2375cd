#include "compare/measure/pictures.h"

#include "compare/measure/reduced.h"
#include "compare/measure/run_all.h"
#include "compare/result/output_parts.h"
#include "compare/truth/shown_materials.h"
#include "raster/bands.h"
#include "raytrace/frame.h"
#include "scene/base/stages.h"
#include "scene/exposure.h"

namespace gnomon::compare {
namespace {

Image<std::uint32_t> glass_of(const LadderInput& in) {
  return stored_glass(in.tracer, in.record(), in.drawn.options.map, in.traced.receiver);
}

class KeptImages : public ImageSink {
 public:
  KeptImages(Comparison& out, const Plan& plan) : out_(out), perceptual_(plan.measure.perceptual) {}

  Expected<void> keep_maps(std::size_t i, MetricMaps&& maps, const PictureRows&) override {
    static_cast<MetricMaps&>(out_.lights[i]) = std::move(maps);
    return {};
  }
  Expected<void> keep_light(const LadderInput& in, Climb&& climb, Image<float>&& detached,
                            const PictureRows&) override {
    LightComparison& light = out_.lights[in.index];
    static_cast<Climb&>(light) = std::move(climb);
    if (!perceptual_) return {};
    const TimedStage stage("metrics");
    light.detachment_map = std::move(detached);
    light.stored_glass = glass_of(in);
    return {};
  }
  Expected<void> keep_frames(Frames&& band, const PictureRows&) override {
    out_.raster = std::move(band.drawn), out_.raytraced = std::move(band.traced);
    return {};
  }
  Expected<double> exposure() override {
    const auto& given = out_.world->scene->exposure;
    return given ? *given : auto_exposure(out_.raytraced.color);
  }

 private:
  Comparison& out_;
  bool perceptual_;
};

/// In the time budget, what bands cost alone.
constexpr std::string_view band_stage = "rows kept";

/// Pictures are drawn from rows on the disk, channels are written at once, and the comparison keeps what the page shows.
class StoredImages : public ImageSink {
 public:
  StoredImages(Comparison& out, const Plan& plan, BandedParts& parts)
      : out_(out), plan_(plan), parts_(parts), step_{image_step(plan.picture), plan.picture.height} {
    out.raster = {}, out.raytraced = {};
    if (plan.aov.empty()) return;
    for (const LightComparison& light : out.lights)
      parts.channels.emplace_back(aov_path(out, light, plan.aov), plan.picture);
  }

  Expected<void> keep_maps(std::size_t i, MetricMaps&& maps, const PictureRows& rows) override;
  Expected<void> keep_light(const LadderInput& in, Climb&& climb, Image<float>&& detached,
                            const PictureRows& rows) override;
  Expected<void> keep_frames(Frames&& band, const PictureRows& rows) override;
  Expected<double> exposure() override;

 private:
  template <class T>
  Step store(StoredImage<T>& stored, const Image<T>& rows) const {
    return [this, &stored, &rows] { return stored.append(plan_.folder, rows); };
  }
  Expected<void> write_channels(const LadderInput& in, const Climb& climb, const PictureRows& rows);

  Comparison& out_;
  const Plan& plan_;
  BandedParts& parts_;
  Reduction step_;  ///< of what the page shows
  AutoExposure exposure_;
};

Expected<void> StoredImages::keep_maps(std::size_t i, MetricMaps&& maps, const PictureRows& rows) {
  const TimedStage stage(band_stage);
  StoredLight& stored = parts_.pictures.lights[i];
  std::vector<Step> steps{store(stored.edges, maps.edge_map), store(stored.flip, maps.flip_map),
                          store(stored.ssim, maps.ssim_map)};
  if (plan_.page)
    steps.emplace_back([&]() -> Expected<void> {
      append_reduced(out_.lights[i], maps, rows.first, step_);
      return {};
    });
  return run_all(steps);
}

Expected<void> StoredImages::keep_light(const LadderInput& in, Climb&& climb, Image<float>&& detached,
                                        const PictureRows& rows) {
  TimedStage stage(band_stage);
  const raster::LightRecord& record = in.record();
  StoredLight& stored = parts_.pictures.lights[in.index];
  std::vector<Step> steps{store(stored.truth, climb.rungs.front()), store(stored.drawn, climb.rungs.back()),
                          store(stored.labels, climb.labels)};
  if (plan_.measure.perceptual) steps.push_back(store(stored.detachment, detached));
  if (record.external) steps.push_back(store(stored.decisions, record.external->decision));
  if (plan_.page)
    steps.emplace_back([&]() -> Expected<void> {
      LightComparison& shown = out_.lights[in.index];
      append_reduced(shown, climb, rows.first, step_);
      if (plan_.measure.perceptual) append_reduced(shown.detachment_map, detached, rows.first, step_);
      append_reduced(shown.stored_glass, glass_of(in), rows.first, step_);
      return {};
    });
  if (const auto kept = run_all(steps); !kept) return kept;
  stage.end();
  return plan_.aov.empty() ? Expected<void>{} : write_channels(in, climb, rows);
}

Expected<void> StoredImages::write_channels(const LadderInput& in, const Climb& climb,
                                            const PictureRows& rows) {
  const AovRows channels{in.world(), in.drawn, in.record(), in.traced, climb.rungs, climb.labels};
  return parts_.channels[in.index].write(rows, aov_channels(channels),
                                         aov_attributes(out_, out_.lights[in.index]));
}

Expected<void> StoredImages::keep_frames(Frames&& band, const PictureRows& rows) {
  const TimedStage stage(band_stage);
  raster::add_costs(band.drawn, out_.raster);
  raytrace::add_costs(band.traced, out_.raytraced);
  std::vector<Step> steps{store(parts_.pictures.raster, band.drawn.color),
                          store(parts_.pictures.raytraced, band.traced.color), [&]() -> Expected<void> {
                            exposure_.count(band.traced.color.data);
                            return {};
                          }};
  if (plan_.page)
    steps.emplace_back([&]() -> Expected<void> {
      append_reduced(out_.raster, band.drawn, rows.first, step_);
      append_reduced(out_, band.traced, rows.first, step_);
      return {};
    });
  if (const auto kept = run_all(steps); !kept) return kept;
  if (rows.first == 0) out_.raytraced.options = band.traced.options;
  if (rows.end() < plan_.picture.height) return {};
  for (std::size_t i = 0; i < out_.lights.size(); ++i) {
    out_.raster.lights[i].map = std::move(band.drawn.lights[i].map);
    if (has_size(light_of(out_, out_.lights[i])))  // says that the light has a size
      out_.raytraced.lights[i].visibility = Image<float>({1, 1});
  }
  return {};
}

Expected<double> StoredImages::exposure() {
  if (const auto& given = out_.world->scene->exposure) return *given;
  if (!exposure_.choose()) return exposure_.factor();
  for (const PictureRows& rows : bands_of(plan_.picture, band_step)) {
    const auto color = parts_.pictures.raytraced.read(rows);
    if (!color) return fail(color.error());
    exposure_.collect(color->data);
  }
  return exposure_.factor();
}

}  // namespace

std::unique_ptr<ImageSink> make_sink(Comparison& out, const Plan& plan, BandedParts* parts) {
  if (parts == nullptr) return std::make_unique<KeptImages>(out, plan);
  return std::make_unique<StoredImages>(out, plan, *parts);
}

}  // namespace gnomon::compare
