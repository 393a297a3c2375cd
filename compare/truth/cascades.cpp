#include "compare/truth/cascades.h"

#include "compare/ladder/biased_test.h"
#include "compare/truth/surfaces.h"
#include "raster/technique_traits.h"
#include "scene/base/parallel.h"
#include "scene/light.h"

namespace gnomon::compare {
namespace {

using raytrace::SurfacePoint;

/// Returns the place on a cube's face for a point past its border: its outermost texels, as where a point on the border belongs to it.
TexelCoordinate place_on_cube_face(const LightView& view, int face, const Vec3& position) {
  TexelCoordinate at = project_to_face(view, face, position);
  const double last = std::nextafter(static_cast<double>(view.size), 0.0);
  at.u = std::clamp(at.u, 0.0, last), at.v = std::clamp(at.v, 0.0, last);
  at.inside = at.depth > 0.0;
  return at;
}

TexelCoordinate place_on_face(const LightView& view, int face, const Vec3& position) {
  return view.projection == LightProjection::perspective ? place_on_cube_face(view, face, position)
                                                         : project_to_face(view, face, position);
}

/// Returns what place_on_face does, but a normal offset may leave a cascade for the next one.
TexelCoordinate offset_place(const LightView& view, int face, const Vec3& position) {
  return view.projection == LightProjection::perspective ? place_on_cube_face(view, face, position)
                                                         : project_from_cascade(view, face, position);
}

float hard_test(const raster::LightRecord& record, const raster::Bias& bias, const Light& light,
                const SurfacePoint& receiver, const TexelCoordinate& own) {
  const LightView& view = record.map.view;
  BiasedLookup lookup{{}, own, receiver.position};
  if (bias.normal_offset_texels > 0.0) {
    const Vec3 to_light = light_at(light, receiver.position).to_light;
    const double sine = glm::length(glm::cross(receiver.normal, to_light));
    lookup.position += receiver.normal * (bias.normal_offset_texels * texel_world_size(view, own) * sine);
    lookup.at = offset_place(view, own.face, lookup.position);
  }
  if (!lookup.at.inside) return 1.0f;
  lookup.key = raytrace::TexelKey::pack(lookup.at.face, lookup.at.column(), lookup.at.row());
  const auto depth = stored_caster(record, lookup.key);
  if (!depth) return 1.0f;
  return gap_before(record, bias, receiver.normal, lookup, *depth) > record.bias_constant_world ? 0.0f : 1.0f;
}

class SeamCounter {
 public:
  SeamCounter(const LadderInput& in, const Image<Label>& labels) : in_(in), labels_(labels) {}

  void count_row(int y, SeamCount& out) const {
    const ImageSize size = labels_.size;
    for (int x = 0; x < size.width; ++x) {
      bool border = false, changed = false;
      for (const auto& [dx, dy] : {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)}) {
        if (x + dx < 0 || y + dy < 0 || x + dx >= size.width || y + dy >= size.height) continue;
        const std::size_t here = labels_.index(x, y), there = labels_.index(x + dx, y + dy);
        if (!meet_at_border(here, there)) continue;
        border = true;
        changed = changed || changes(here, in_.record().face.data[there]);
      }
      out.at_border += border ? 1 : 0, out.changed += changed ? 1 : 0;
    }
  }

 private:
  bool meet_at_border(std::size_t here, std::size_t there) const {
    const Image<std::uint8_t>& face = in_.record().face;
    return is_compared(labels_.data[here]) && is_compared(labels_.data[there]) &&
           face.data[here] != face.data[there] &&
           on_smooth_surface(in_.traced.receiver.data[here], in_.traced.receiver.data[there], in_.world());
  }
  bool changes(std::size_t pixel, int face) const {
    const SurfacePoint& receiver = in_.traced.receiver.data[pixel];
    const LightView& view = in_.record().map.view;
    if (!place_on_face(view, face, receiver.position).inside) return false;
    const double other = visibility_by_face(in_.record(), in_.drawn.options.map, in_.light(), receiver, face);
    return std::abs(other - double{in_.record().visibility.data[pixel]}) > 0.5;
  }

  const LadderInput& in_;
  const Image<Label>& labels_;
};

}  // namespace

double share_of_next(const LightView& view, const TexelCoordinate& own, double blend) {
  const bool cascades = view.projection == LightProjection::orthographic;
  if (!cascades || own.face + 1 >= view.face_count || !(blend > 0.0)) return 0.0;
  const double last = view.size - 1.0;
  const double inwards = std::min({own.u - 1.0, own.v - 1.0, last - own.u, last - own.v}) / (view.size - 2.0);
  return std::clamp(1.0 - inwards / blend, 0.0, 1.0);
}

double visibility_by_face(const raster::LightRecord& record, const raster::MapOptions& drawn,
                          const Light& light, const SurfacePoint& receiver, int face) {
  const LightView& view = record.map.view;
  const TexelCoordinate own = place_on_face(view, face, receiver.position);
  const double here = double{hard_test(record, drawn.bias, light, receiver, own)};
  const double share = share_of_next(view, own, drawn.cascades.blend);
  if (!(share > 0.0)) return here;
  const TexelCoordinate next = project_from_cascade(view, face + 1, receiver.position);
  if (!next.inside) return here;
  return (1.0 - share) * here + share * double{hard_test(record, drawn.bias, light, receiver, next)};
}

std::optional<SeamCount> count_seams(const LadderInput& in, const Image<Label>& labels,
                                     const PictureRows& within) {
  const raster::LightRecord& record = in.record();
  const bool hard = raster::traits_of(in.drawn.options.map.technique).test == raster::ShadowTest::single;
  if (!hard || record.foreign || in.drawn.custom_shader || record.map.view.face_count < 2 ||
      record.map.depth.empty() || record.face.data.size() != labels.data.size())
    return std::nullopt;
  const SeamCounter counter(in, labels);
  return parallel_reduce(
      static_cast<std::size_t>(within.count), 1, SeamCount{},
      [&](std::size_t first, std::size_t last, SeamCount sum) {
        for (std::size_t i = first; i < last; ++i) counter.count_row(within.first + static_cast<int>(i), sum);
        return sum;
      },
      [](const SeamCount& a, const SeamCount& b) {
        return SeamCount{a.at_border + b.at_border, a.changed + b.changed};
      });
}

}  // namespace gnomon::compare
