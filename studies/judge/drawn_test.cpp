// The usual mistakes in the description of a shadow test (test_suspects.h), each tried against the picture.
#include <fmt/core.h>

#include <algorithm>

#include "compare/bias/bias_curve.h"
#include "scene/base/parallel.h"
#include "studies/judge/described_test.h"
#include "studies/judge/test_suspects.h"

namespace gnomon::compare {
namespace {

/// The test must then be drawn nearly everywhere, and on most of the pixels where it was not.
constexpr double least_drawn = 0.98, most_not_drawn = 1.0 / 3.0;

/// The receivers with the normals of their triangles' fronts; none where no back is seen.
std::optional<raytrace::RayTracedFrame> receivers_by_fronts(const FrameInput& in) {
  raytrace::RayTracedFrame turned;
  turned.lights = in.traced.lights, turned.receiver = in.traced.receiver;
  bool any = false;
  for (raytrace::SurfacePoint& point : turned.receiver.data) {
    if (point.primitive == no_id || !in.world.is_triangle(point.primitive)) continue;
    const Vec3 front = outward_normal(in.world, point.primitive, point.position);
    if (glm::dot(front, point.normal) < 0.0) point.normal = -point.normal, any = true;
  }
  if (!any) return std::nullopt;
  return turned;
}

/// Shares of the compared pixels.
struct Fit {
  double drawn = 0.0, wrong = 0.0;
};

/// What a test draws of a pixel: nothing is known of what lies beyond the map's border, the renderer's own choice.
enum class Drawn : std::uint8_t { lit, dark, unknown };

Drawn drawn_by(const raster::LightRecord& record, std::size_t i) {
  // What looks nothing up is lit.
  if (record.captured->test->face_of(i) == raster::CapturedTest::no_face) return Drawn::lit;
  if (record.outside_map.data[i] != 0) return Drawn::unknown;
  return double{record.gap.data[i]} > record.bias_constant_world ? Drawn::dark : Drawn::lit;
}

/// What is drawn beyond the border is taken for light, or for shadow where most of it is that.
Fit fit_of(const raster::LightRecord& record, const LightComparison& light) {
  std::size_t count = 0, drawn = 0, wrong = 0, beyond = 0, beyond_dark = 0;
  const auto take = [&](std::size_t i, bool dark) {
    const float test = dark ? 0.0f : 1.0f;
    drawn += std::abs(test - light.rungs[6].data[i]) <= 0.5f ? 1 : 0;
    wrong += std::abs(test - light.rungs[0].data[i]) > 0.5f ? 1 : 0;
  };
  for (std::size_t i = 0; i < light.labels.data.size(); ++i) {
    if (!is_compared(light.labels.data[i])) continue;
    const Drawn by = drawn_by(record, i);
    ++count;
    if (by != Drawn::unknown)
      take(i, by == Drawn::dark);
    else
      ++beyond, beyond_dark += light.rungs[6].data[i] < 0.5f ? 1 : 0;
  }
  for (std::size_t i = 0; beyond > 0 && i < light.labels.data.size(); ++i)
    if (is_compared(light.labels.data[i]) && drawn_by(record, i) == Drawn::unknown)
      take(i, 2 * beyond_dark > beyond);
  const auto all = static_cast<double>(std::max<std::size_t>(1, count));
  return {static_cast<double>(drawn) / all, static_cast<double>(wrong) / all};
}

bool fits(const Fit& fit, const Fit& now) {
  return fit.drawn >= least_drawn && 1.0 - fit.drawn < most_not_drawn * (1.0 - now.drawn);
}

/// Another constant, found as the best bias is: with the picture in the place of the truth.
std::optional<OtherTest> find_other_constant(const raster::LightRecord& described,
                                             const LightComparison& light, const Fit& now) {
  raster::LightRecord record = described;
  record.bias_constant_world =
      find_best_bias(sort_gaps(described, light.rungs[6], light.labels)).constant_world;
  const Fit fit = fit_of(record, light);
  if (!fits(fit, now)) return std::nullopt;
  return OtherTest{fmt::format("`constant_depth` is about {:.2g}",
                               record.bias_constant_world / described.captured->test->unit_world),
                   fit.drawn, true, record.bias_constant_world};
}

/// Mistakes made one by one and together; the best explanation, of equally good ones the one with the fewest.
class Search {
 public:
  Search(const FrameInput& in, const raster::RasterFrame& drawn, const LightComparison& light)
      : in_(in),
        bias_(drawn.options.map.bias),
        described_(drawn.lights.front()),
        light_(light),
        now_(fit_of(described_, light)) {
    if (described_.captured->test->normal_offset_world > 0.0) by_fronts_ = receivers_by_fronts(in);
  }

  void try_suspects(std::initializer_list<const TestSuspect*> suspects) {
    raster::LightRecord record = described_;
    bool by_fronts = false;
    for (const TestSuspect* suspect : suspects) {
      if (!suspect->change(record)) return;
      by_fronts = by_fronts || suspect->by_fronts;
    }
    // What slopes are along a normal that faces away is not defined.
    if (by_fronts && (!by_fronts_ || bias_.slope != 0.0 || bias_.receiver_plane)) return;
    const FrameInput turned{in_.capture,   in_.pictures, in_.world,
                            in_.tracer,    in_.camera,   by_fronts ? *by_fronts_ : in_.traced,
                            in_.elsewhere, in_.exposure, in_.facts};
    fill_record(turned, bias_, record);
    const Fit fit = fit_of(record, light_);
    if (!fits(fit, now_) || (best_ && best_->share >= fit.drawn - clearly)) return;
    OtherTest found{"", fit.drawn, suspects.size() == 1, record.bias_constant_world};
    for (const TestSuspect* suspect : suspects) {
      const bool renderer = !suspect->of_renderer.empty() && fit.wrong > now_.wrong;
      found.what +=
          (found.what.empty() ? "" : ", and ") + (renderer ? suspect->of_renderer : suspect->of_capture);
      found.of_constant &= suspect->of_constant && !renderer;
    }
    best_ = std::move(found);
  }
  void try_constant() {
    auto found = find_other_constant(described_, light_, now_);
    if (found && (!best_ || found->share > best_->share + clearly)) best_ = std::move(found);
  }
  const std::optional<OtherTest>& best() const { return best_; }

 private:
  static constexpr double clearly = 2e-4;  ///< share of the pixels: borders of texels differ by rounding

  const FrameInput& in_;
  const raster::Bias& bias_;
  const raster::LightRecord& described_;
  const LightComparison& light_;
  Fit now_;
  std::optional<raytrace::RayTracedFrame> by_fronts_;
  std::optional<OtherTest> best_;
};

}  // namespace

std::optional<OtherTest> find_drawn_test(const FrameInput& in, const raster::RasterFrame& drawn,
                                         const LightComparison& light) {
  Search search(in, drawn, light);
  const std::vector<TestSuspect> suspects = test_suspects(in, drawn.lights.front(), light);
  for (const TestSuspect& one : suspects) search.try_suspects({&one});
  search.try_constant();
  for (std::size_t i = 0; i < suspects.size(); ++i)
    for (std::size_t k = i + 1; k < suspects.size(); ++k)
      if (suspects[i].with_others && suspects[k].with_others)
        search.try_suspects({&suspects[i], &suspects[k]});
  return search.best();
}

}  // namespace gnomon::compare
