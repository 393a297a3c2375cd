#include "studies/shimmer/film.h"

#include <algorithm>
#include <array>

#include "compare/ladder/labels.h"
#include "compare/result/outputs.h"
#include "compare/result/palette.h"
#include "scene/base/parallel.h"
#include "scene/base/stages.h"
#include "scene/exposure.h"
#include "scene/files/pictures/image_io.h"

namespace gnomon::studies {
namespace {

template <class Colour>
Rgb8Image painted(const ImageSize& size, const Colour& colour) {
  Rgb8Image out(size);
  parallel_for(size.height, [&](int y) {
    for (std::size_t i = out.index(0, y), end = i + static_cast<std::size_t>(size.width); i < end; ++i)
      out.data[i] = colour(i);
  });
  return out;
}

std::uint8_t bits_of(const RungFrame& frame, std::size_t i) {
  unsigned bits = 0;
  for (std::size_t k = 1; k <= 5; ++k) bits |= frame.rungs[k].data[i] > 0.5f ? 1u << (k - 1) : 0u;
  bits |= frame.counted.data[i] != 0 ? 32u : 0u;
  return static_cast<std::uint8_t>(bits | (frame.outside.data[i] != 0 ? 64u : 0u));
}

}  // namespace

glm::u8vec3 flip_colour(std::size_t label, compare::Ladder ladder) {
  return compare::label_colour(label == outside_map_flip
                                   ? compare::Label::outside_map
                                   : compare::step_text(static_cast<compare::Cause>(label), ladder).label);
}

Expected<Rgb8Image> unshadowed_picture(Scene& scene, raster::Renderer& renderer,
                                       const ShimmerOptions& options) {
  raster::RasterOptions plain;
  plain.size = options.compare.raster.size;
  plain.runs = 0, plain.analysis = false;
  plain.map.bias = {.constant = 1e30, .unit = raster::BiasUnit::world};  // no gap is larger
  const Camera given = std::exchange(scene.camera, first_camera(options, scene));
  const auto drawn = renderer.render(plain, {});
  scene.camera = given;
  if (!drawn) return fail(drawn.error());
  return display_image(drawn->color, scene.exposure ? *scene.exposure : auto_exposure(drawn->color));
}

glm::u8vec3 film_colour(const glm::u8vec3& unshadowed, float visibility) {
  const float share = 0.25f + 0.75f * visibility;
  return {static_cast<std::uint8_t>(share * float(unshadowed.r)),
          static_cast<std::uint8_t>(share * float(unshadowed.g)),
          static_cast<std::uint8_t>(share * float(unshadowed.b))};
}

Expected<void> FilmRecorder::add_light(const ShimmerLight& light, compare::Ladder ladder, FilmOfLight& film) {
  const RungFrame& frame = light.temporal.last();
  const Image<std::uint8_t>& flips = light.temporal.last_flips();
  const auto shadowed = [&](std::size_t rung) {
    return painted(base_.size, [&, rung](std::size_t i) {
      return frame.counted.data[i] != 0 ? film_colour(base_.data[i], frame.rungs[rung].data[i])
                                        : base_.data[i];
    });
  };
  const Rgb8Image drawn = shadowed(6);
  film.drawn.add(drawn);
  film.truth.add(shadowed(0));
  film.flipped.add(painted(base_.size, [&](std::size_t i) {
    return flips.data[i] > 0 ? flip_colour(flips.data[i] - std::size_t{1}, ladder) : drawn.data[i];
  }));
  const auto seen = encode_png(painted(base_.size, [&](std::size_t i) {
    return glm::u8vec3(to_8_bit(frame.rungs[6].data[i]), to_8_bit(frame.rungs[0].data[i]), bits_of(frame, i));
  }));
  const auto marked =
      encode_png(painted(base_.size, [&](std::size_t i) { return glm::u8vec3(flips.data[i], 0, 0); }));
  if (!seen) return fail(seen.error());
  if (!marked) return fail(marked.error());
  film.seen.push_back(*seen), film.flips.push_back(*marked);
  return {};
}

Expected<void> FilmRecorder::add(const ShimmerFrame& frame) {
  const TimedStage stage("pictures");
  for (std::size_t i = 0; i < frame.shimmer.lights.size(); ++i) {
    if (i == lights_.size())
      lights_.push_back({{}, {}, {base_.size, fps_}, {base_.size, fps_}, {base_.size, fps_}});
    if (const auto added = add_light(frame.shimmer.lights[i], frame.shimmer.ladder(), lights_[i]); !added)
      return added;
  }
  return {};
}

Rgb8Image flip_heat_map(const ShimmerLight& light) {
  const Image<std::uint16_t>& flips = light.temporal.flips();
  const double most = std::max<double>(1.0, *std::max_element(flips.data.begin(), flips.data.end()));
  return painted(flips.size, [&](std::size_t i) { return compare::magma(double(flips.data[i]) / most); });
}

}  // namespace gnomon::studies
