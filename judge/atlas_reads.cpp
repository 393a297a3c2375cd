#include "judge/atlas_reads.h"

#include <fmt/core.h>

#include <algorithm>

#include "compare/ladder/biased_test.h"
#include "compare/ladder/budget.h"
#include "compare/metrics/pixel_list.h"
#include "compare/result/number_text.h"
#include "judge/identify.h"
#include "scene/light.h"

namespace gnomon::judge {
namespace {

using compare::Label;

constexpr std::size_t few_reads = 10;  ///< of which nothing is said in a note
constexpr double nearer_by =
    0.1;  ///< of the light by which the neighbours' texels come nearer to what is drawn

class AtlasReader {
 public:
  AtlasReader(const FrameInput& in, const raster::RasterFrame& drawn)
      : in_(in),
        map_(drawn.options.map),
        record_(drawn.lights.front()),
        light_(in.world.scene->lights[record_.light]) {}

  /// The mean of the comparisons within the filter's reach, with the neighbours' texels beyond the layer's border and with the
  /// layer's own nearest in their place; none where the filter stays within the layer.
  struct Means {
    double neighbours = 0.0, own = 0.0;
  };
  std::optional<Means> means(std::size_t pixel) const {
    const raytrace::SurfacePoint& receiver = in_.traced.receiver.data[pixel];
    const auto lookup = compare::biased_lookup(record_, map_.bias,
                                               light_at(light_, receiver.position).to_light, receiver, pixel);
    if (!lookup) return std::nullopt;
    const Part part = captured_test(record_).part(record_.map.view, lookup->at.face);
    const double radius = map_.filter.radius_texels, u = lookup->at.u, v = lookup->at.v;
    if (u - radius >= part.column && u + radius <= part.column + part.width && v - radius >= part.row &&
        v + radius <= part.row + part.height)
      return std::nullopt;
    const auto covered = [radius](double middle, int texel) {
      return std::min(middle + radius, texel + 1.0) - std::max(middle - radius, double(texel));
    };
    Means out;
    for (int row = floor_of(v - radius); row <= floor_of(v + radius); ++row)
      for (int column = floor_of(u - radius); column <= floor_of(u + radius); ++column) {
        const double weight = std::max(0.0, covered(u, column)) * std::max(0.0, covered(v, row));
        const int own_column = std::clamp(column, part.column, part.column + part.width - 1);
        const int own_row = std::clamp(row, part.row, part.row + part.height - 1);
        const auto key = raytrace::TexelKey::pack(lookup->at.face, own_column, own_row);
        const double own = lit(*lookup, receiver.normal, key, compare::stored_caster(record_, key));
        const bool beyond = column != own_column || row != own_row;
        out.own += weight * own;
        out.neighbours +=
            weight *
            (beyond ? lit(*lookup, receiver.normal, key, neighbour(part, *lookup, column, row)) : own);
      }
    const double all = 4.0 * radius * radius;
    return Means{out.neighbours / all, out.own / all};
  }

 private:
  using Part = CapturedTest::Part;
  static int floor_of(double place) { return static_cast<int>(std::floor(place)); }
  double lit(const compare::BiasedLookup& lookup, const Vec3& normal, raytrace::TexelKey key,
             const std::optional<double>& depth) const {
    compare::BiasedLookup there = lookup;
    there.key = key;
    return depth && compare::gap_before(record_, map_.bias, normal, there, *depth) >
                        record_.bias_constant_world
               ? 0.0
               : 1.0;
  }
  /// The depth that a number of another layer stands for where it is read as one of this.
  std::optional<double> neighbour(const Part& part, const compare::BiasedLookup& lookup, int column,
                                  int row) const {
    const LightView& view = record_.map.view;
    const int face = lookup.at.face;
    const LayerTexels& texels = in_.facts.atlas[static_cast<std::size_t>(face)];
    const std::size_t at = texels.at(column - part.column, row - part.row);
    if (at == LayerTexels::none) return std::nullopt;
    const CapturedLayer& layer = in_.capture.map.front();
    double stored = double{texels.numbers[at]};
    if (is_linear(*layer.convention))
      stored =
          stored_of_linear(view, *layer.convention, face, column, row, linear_world(layer.range, stored));
    if (!holds_caster(view, stored)) return std::nullopt;
    return depth_from_stored(view, face, row + 0.5, stored);
  }

  const FrameInput& in_;
  const raster::MapOptions& map_;
  const raster::LightRecord& record_;
  const Light& light_;
};

}  // namespace

AtlasReads label_atlas_reads(const FrameInput& in, const raster::RasterFrame& drawn,
                             compare::LightComparison& light) {
  const bool filters = drawn.options.map.technique == raster::Technique::pcf;
  if (in.facts.atlas.empty() || !filters || !(drawn.options.map.filter.radius_texels > 0.0)) return {};
  const AtlasReader reader(in, drawn);
  const auto found = compare::pixels_where(light.labels.data.size(), [&](std::size_t i) {
    const Label label = light.labels.data[i];
    if (!compare::has_cause(label) || label == Label::outside_map || label == Label::light_size) return false;
    const auto means = reader.means(i);
    const double truth = double{light.rungs[0].data[i]}, is_drawn = double{light.rungs[6].data[i]};
    const double error = std::abs(is_drawn - truth);
    return means && std::abs(means->own - truth) <= (error > 0.5 ? 0.5 : 0.5 * error) &&
           std::abs(means->neighbours - is_drawn) < std::abs(means->own - is_drawn) - nearer_by;
  });
  if (found.empty()) return {};
  for (const std::uint32_t i : found) light.labels.data[i] = Label::outside_map;
  count_labels_again(light);
  if (found.size() < few_reads) return {};
  const std::string border =
      compare::with_noun(fmt::format("{:.0f}", std::ceil(drawn.options.map.filter.radius_texels)), "texel");
  const auto wrong = std::count_if(found.begin(), found.end(), [&](std::uint32_t i) {
    return compare::is_wrong(compare::rungs_at(light.rungs, i));
  });
  AtlasReads out;
  out.notes = {
      fmt::format("in {} pixels with an error the filter reads beyond its layer's part of the atlas, where a "
                  "neighbour's depths "
                  "are: clamp its reads to the part, or leave a border of {}",
                  compare::grouped(found.size()), border)};
  if (2 * static_cast<std::uint64_t>(wrong) > light.error.wrong)
    out.cure = fmt::format(
        "Clamp the filter's reads to the layer's part of the atlas, or leave a border of {}.", border);
  return out;
}

}  // namespace gnomon::judge
