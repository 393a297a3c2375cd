// Usual mistakes in the description of a shadow test, each tried against the picture: the map's rows, the bias's sign,
// the matrix, and the offset's sign on back faces.
#include <fmt/core.h>

#include <algorithm>

#include "compare/bias/bias_curve.h"
#include "scene/base/parallel.h"
#include "studies/judge/described_test.h"

namespace gnomon::compare {
namespace {

/// The test must then be drawn nearly everywhere, and on most of the pixels where it was not.
constexpr double least_drawn = 0.98, most_not_drawn = 1.0 / 3.0;

struct TestSuspect {
  const char* of_capture;                       ///< what is wrong where the test so changed is the better one
  const char* of_renderer;                      ///< null: the capture is wrong in any case
  bool (*change)(raster::LightRecord& record);  ///< false: does not apply
  bool by_fronts = false;  ///< offsets go along the front's normal, also where the back is seen
};

bool turn_rows(raster::LightRecord& record) {
  raster::ShadowMap& map = record.map;
  const int n = map.view.size;
  for (int face = 0; face < map.view.face_count; ++face)
    for (int row = 0; row < n / 2; ++row) {
      const auto low = map.depth.begin() + static_cast<std::ptrdiff_t>(map.texel_index(face, 0, row));
      const auto high =
          map.depth.begin() + static_cast<std::ptrdiff_t>(map.texel_index(face, 0, n - 1 - row));
      std::swap_ranges(low, low + n, high);
    }
  return true;
}

bool turn_sign(raster::LightRecord& record) {
  record.bias_constant_world = -record.bias_constant_world;
  return record.bias_constant_world != 0.0;
}

bool is_parallel(const raster::LightRecord& record) {
  return record.map.view.projection == LightProjection::orthographic;
}

template <class Change>
bool change_faces(raster::LightRecord& record, const Change& change) {
  if (!is_parallel(record)) return false;
  for (int i = 0; i < record.map.view.face_count; ++i)
    change(record.map.view.faces[static_cast<std::size_t>(i)]);
  return true;
}

/// x / 2 + 1 / 2 in the place of x.
bool take_off_texture_matrix(raster::LightRecord& record) {
  return change_faces(record, [](LightFace& face) {
    face.half_extent = 0.5 * face.half_extent;
    face.center += face.half_extent;
  });
}

/// The depths' range so many times as long, up to the same far plane.
bool stretch_depths(raster::LightRecord& record, double times) {
  if (record.map.view.reversed) return false;
  record.captured->test->unit_world *= times, record.bias_constant_world *= times;
  return change_faces(record, [=](LightFace& face) {
    face.near_depth = face.far_depth - times * (face.far_depth - face.near_depth);
  });
}

/// Changes the lookup to that of a renderer that takes one side of the window for the other's.
bool take_side_for(raster::LightRecord& record, int axis) {
  const LightFace& face = record.map.view.face(0);
  if (std::abs(face.half_extent.x - face.half_extent.y) < 0.01 * face.half_extent.x) return false;
  return change_faces(record, [axis](LightFace& f) { f.half_extent[axis] = f.half_extent[1 - axis]; });
}

bool has_offset(raster::LightRecord& record) {
  return record.captured->test->normal_offset_world > 0.0;
}

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

constexpr TestSuspect test_suspects[] = {
    {"`rows` of the map is the other one", "the renderer reads its map upside down (v runs the other way)",
     turn_rows},
    {"`constant_depth` has the other sign (positive takes shadow away)",
     "the renderer applies its bias with the other sign", turn_sign},
    {"`clip_from_world` holds the scale and shift to texture coordinates", nullptr, take_off_texture_matrix},
    {"the matrix makes depths of -1 to 1 (`minus_one_to_one`)", nullptr,
     [](raster::LightRecord& record) { return stretch_depths(record, 2.0); }},
    {"the matrix makes depths of 0 to 1 (`zero_to_one`)", nullptr,
     [](raster::LightRecord& record) { return stretch_depths(record, 0.5); }},
    {"the matrix has the window's height for its width",
     "the renderer takes the window's height for its width",
     [](raster::LightRecord& record) { return take_side_for(record, 0); }},
    {"the matrix has the window's width for its height",
     "the renderer takes the window's width for its height",
     [](raster::LightRecord& record) { return take_side_for(record, 1); }},
    {"the offset goes along the front's normal, on back faces into the surface",
     "the renderer's normal offset has the wrong sign on back faces", has_offset, true}};

/// Shares of the compared pixels.
struct Fit {
  double drawn = 0.0, wrong = 0.0;
};

Fit fit_of(const raster::LightRecord& record, const LightComparison& light) {
  std::size_t count = 0, drawn = 0, wrong = 0;
  for (std::size_t i = 0; i < light.labels.data.size(); ++i) {
    if (!is_compared(light.labels.data[i])) continue;
    const float picture = light.rungs[6].data[i];
    const bool dark = double{record.gap.data[i]} > record.bias_constant_world;
    const float test = record.outside_map.data[i] != 0 ? picture : dark ? 0.0f : 1.0f;
    ++count;
    drawn += std::abs(test - picture) <= 0.5f ? 1 : 0;
    wrong += std::abs(test - light.rungs[0].data[i]) > 0.5f ? 1 : 0;
  }
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
                   fit.drawn, true};
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
                            in_.elsewhere, in_.exposure};
    fill_record(turned, bias_, record);
    const Fit fit = fit_of(record, light_);
    if (!fits(fit, now_) || (best_ && best_->share >= fit.drawn - clearly)) return;
    OtherTest found{"", fit.drawn, suspects.size() == 1};
    for (const TestSuspect* suspect : suspects) {
      const bool renderer = suspect->of_renderer != nullptr && fit.wrong > now_.wrong;
      found.what += (found.what.empty() ? "" : ", and ") +
                    std::string(renderer ? suspect->of_renderer : suspect->of_capture);
      found.of_constant &= suspect->change == turn_sign && !renderer;
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
  for (const TestSuspect& one : test_suspects) search.try_suspects({&one});
  search.try_constant();
  for (const TestSuspect& one : test_suspects)
    for (const TestSuspect* other = &one + 1; other != std::end(test_suspects); ++other)
      search.try_suspects({&one, other});
  return search.best();
}

}  // namespace gnomon::compare
