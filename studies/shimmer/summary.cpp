#include <fmt/core.h>

#include <algorithm>

#include "compare/ladder/budget.h"
#include "compare/result/number_text.h"
#include "compare/result/option_names.h"
#include "compare/result/text_layout.h"
#include "scene/base/expected.h"
#include "studies/shimmer/outputs.h"

namespace gnomon::studies {
namespace {

using compare::Cause;
using compare::grouped;

std::string movement(const ShimmerOptions& o) {
  const bool camera = o.path.camera != compare::CameraPath::still,
             light = o.path.light != compare::LightPath::still;
  std::string text =
      camera ? fmt::format("camera {}", compare::camera_path_name(o.path.camera)) : std::string();
  if (light) text += fmt::format("{}light {}", camera ? ", " : "", compare::light_path_name(o.path.light));
  if (o.path.objects) text += fmt::format("{}objects by {}", text.empty() ? "" : ", ", o.path.keys.name);
  return text.empty() ? "nothing moves" : text;
}

double per_receiver(double sum, const TemporalSums& total) {
  return total.receivers > 0 ? sum / static_cast<double>(total.receivers) : 0.0;
}

std::string budget_rows(const TemporalSums& total, compare::Ladder ladder) {
  std::string text = "  step          signed     absolute   flips\n";
  for (std::size_t k = 0; k < compare::cause_count; ++k)
    text +=
        fmt::format("  {:<12} {:>+11.3e} {:>11.3e} {:>9}\n",
                    compare::spoken(compare::cause_name(static_cast<Cause>(k), ladder)),
                    per_receiver(compare::beyond_rounding(total.signed_sum[k], total.absolute_sum[k]), total),
                    per_receiver(total.absolute_sum[k], total), grouped(total.by_label[k]));
  text +=
      fmt::format("  {:<12} {:>+11.3e} {:>11.3e} {:>9}\n", "sum",
                  per_receiver(compare::beyond_rounding(total.error_sum, total.error_absolute_sum), total),
                  per_receiver(total.error_absolute_sum, total), grouped(total.flips));
  if (total.by_label[outside_map_flip] > 0)
    text += fmt::format("  of these flips {} outside the map\n", grouped(total.by_label[outside_map_flip]));
  if (total.seam_flips > 0)
    text += fmt::format("  of these flips {} where the receiver changed its cascade\n",
                        grouped(total.seam_flips));
  return text;
}

/// The step that makes most flips, as what is seen.
std::string_view what_flickers(std::size_t most, compare::Ladder ladder) {
  if (ladder == compare::Ladder::rays)
    return static_cast<Cause>(most) == Cause::rays_lag ? "Shadows trail behind"
                                                       : "Noise boils in soft shadows";
  if (most == outside_map_flip) return "Shadows come and go at the map's border";
  switch (static_cast<Cause>(most)) {
    case Cause::sampling:
      return "Edges crawl";
    case Cause::slope:
    case Cause::precision:
      return "Acne flickers";
    case Cause::bias:
      return "Shadows flicker where they touch their casters";
    default:
      return "Soft shadows flicker";
  }
}

/// Edges of a sun's shadows crawl where its window follows the camera and is not held to whole texels.
bool snap_would_help(const Shimmer& shimmer, const ShimmerLight& light, std::size_t most) {
  const raster::MapOptions& map = shimmer.options.compare.raster.map;
  return static_cast<Cause>(most) == Cause::sampling && !map.snap && raster::reads_setting(map, "snap") &&
         shimmer.options.path.camera != compare::CameraPath::still &&
         shimmer.world->scene->lights[light.light].type == LightType::directional;
}

}  // namespace

std::string shimmer_sentence(const Shimmer& shimmer, const ShimmerLight& light) {
  const TemporalSums& total = light.temporal.total();
  if (total.receivers == 0)
    return "No receiver of this light is to be compared in two frames that follow each other.";
  if (total.flips == 0)
    return fmt::format("The shadow holds still: none of {} receivers flips in {} frames.",
                       grouped(light.receivers), shimmer.options.time.frames);
  const auto most = static_cast<std::size_t>(std::max_element(total.by_label.begin(), total.by_label.end()) -
                                             total.by_label.begin());
  return fmt::format("{}: a point flips {} times a second ({} flips of {} points in {} frames){}",
                     what_flickers(most, shimmer.ladder()),
                     compare::plain_number(flips_per_receiver_second(shimmer.options, light)),
                     grouped(total.flips), grouped(light.receivers), shimmer.options.time.frames,
                     snap_would_help(shimmer, light, most) ? "; --snap keeps the map's texels still." : ".");
}

std::string shimmer_table(const Shimmer& shimmer) {
  const ShimmerOptions& o = shimmer.options;
  const raster::MapOptions& map = o.compare.raster.map;
  std::string text;
  for (const ShimmerLight& light : shimmer.lights) {
    const std::string size = raster::reads_setting(map, "map-size") ? fmt::format(" {}", map.size) : "";
    const std::string head = fmt::format(
        "{}: {}{}, {} frames at {:g} a second, {}", one_line(shimmer.world->scene->lights[light.light].name),
        technique_name(map.technique), size, o.time.frames, o.time.fps, movement(o));
    for (const std::string& line : compare::wrapped(head, 80)) text += line + '\n';
    for (const std::string& line : compare::wrapped(shimmer_sentence(shimmer, light), 78))
      text += "  " + line + '\n';
    text += budget_rows(light.temporal.total(), shimmer.ladder());
    if (light.texel_world_unsnapped)
      text += fmt::format("  texels of {} world units; without --snap {}\n",
                          compare::plain_number(light.texel_world),
                          compare::plain_number(*light.texel_world_unsnapped));
    const EdgeSpeed speed = edge_speed(o, light);
    text += std::isnan(speed.drawn_world_per_second)
                ? std::string("  edges: none\n\n")
                : fmt::format("  edges sweep {:.3f} texels a frame, the true ones {:.3f}\n\n",
                              speed.drawn_texels_per_frame, speed.true_texels_per_frame);
  }
  return text;
}

}  // namespace gnomon::studies
