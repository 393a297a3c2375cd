#include "compare/picture_set.h"

#include <fmt/core.h>

#include <functional>
#include <optional>

#include "compare/output_parts.h"
#include "compare/outputs.h"
#include "scene/files/image_io.h"
#include "scene/parallel.h"

namespace gnomon::compare {
namespace {

constexpr int folder_width = 4096, page_width = 1024;  // pixels

// The smallest whole step that brings a map's picture down to a width.
int step_for_width(const raster::ShadowMap& map, int width) {
  const int across = map.view.face_count > 1 ? 3 : 1;
  int step = 1;
  while (across * ((map.view.size + step - 1) / step) > width) ++step;
  return step;
}

struct Job {
  EncodedPicture* target;
  std::function<Rgb8Image()> draw;
};

void add_map_jobs(std::vector<Job>& jobs, const Comparison& c, const LightComparison& light,
                  LightPictures& out) {
  const std::string suffix = light_suffix(c, light);
  const raster::ShadowMap& map = drawn_record(c, light).map;
  out.depth_map.file_name = "depth-map" + suffix + ".png";
  out.depth_map_small.file_name = "depth-map-small" + suffix + ".png";
  out.depth_map_step = step_for_width(map, folder_width);
  out.depth_map_small_step = step_for_width(map, page_width);
  const int small_step = out.depth_map_small_step, full_step = out.depth_map_step;
  if (!lacks_map(c))
    jobs.push_back({&out.depth_map, [&map, full_step] {
                      return full_step == 1 ? depth_map_picture(map)
                                            : depth_map_picture(reduced_map(map, full_step));
                    }});
  if (small_step != full_step && !lacks_map(c))
    jobs.push_back({&out.depth_map_small,
                    [&map, small_step] { return depth_map_picture(reduced_map(map, small_step)); }});
}

void add_light_jobs(std::vector<Job>& jobs, const Comparison& c, const Rgb8Image& drawn,
                    const LightComparison& light, LightPictures& out) {
  const std::string suffix = light_suffix(c, light);
  out.difference.file_name = "difference" + suffix + ".png";
  out.labels.file_name = "labels" + suffix + ".png";
  out.error.file_name = "error" + suffix + ".png";
  add_map_jobs(jobs, c, light, out);
  jobs.push_back({&out.difference, [&drawn, &light] { return difference_picture(drawn, light); }});
  jobs.push_back({&out.labels, [&light] { return label_picture(light); }});
  jobs.push_back({&out.error, [&light] { return error_picture(light); }});
  const auto& external = drawn_record(c, light).external;
  if (external && !external->decision.data.empty()) {
    out.decisions.file_name = "decisions" + suffix + ".png";
    jobs.push_back({&out.decisions, [&c, &light] { return decision_picture(c, light); }});
  }
  if (!light.edge_map.data.empty()) {
    out.edges.file_name = "edge-displacement" + suffix + ".png";
    out.detachment.file_name = "detachment" + suffix + ".png";
    jobs.push_back({&out.edges, [&light] { return edge_picture(light); }});
    jobs.push_back({&out.detachment, [&light] { return detachment_picture(light); }});
  }
  if (light.flip_map.data.empty()) return;
  out.flip.file_name = "flip" + suffix + ".png";
  out.ssim.file_name = "ssim" + suffix + ".png";
  jobs.push_back({&out.flip, [&light] { return flip_picture(light); }});
  jobs.push_back({&out.ssim, [&light] { return ssim_picture(light); }});
}

Expected<void> run_jobs(const std::vector<Job>& jobs) {
  std::vector<std::optional<Error>> errors(jobs.size());
  parallel_for(jobs.size(), [&](std::size_t i) {
    const Rgb8Image image = jobs[i].draw();
    Expected<std::string> png = encode_png(image);
    if (!png)
      errors[i] = png.error();
    else
      jobs[i].target->png = std::move(*png);
    jobs[i].target->size = image.size;
  });
  for (const std::optional<Error>& error : errors)
    if (error) return fail(*error);
  return {};
}

void share_depth_map(LightPictures& light) {
  if (light.depth_map_small.png.empty()) light.depth_map_small = light.depth_map;
}

}  // namespace

std::string light_suffix(const Comparison& c, const LightComparison& light) {
  return c.lights.size() > 1 ? fmt::format("-{}", light_file_part(c, light)) : "";
}

Expected<void> encode_depth_maps(const Comparison& c, const LightComparison& light, LightPictures& out) {
  std::vector<Job> jobs;
  add_map_jobs(jobs, c, light, out);
  if (const auto done = run_jobs(jobs); !done) return done;
  share_depth_map(out);
  return {};
}

raster::ShadowMap reduced_map(const raster::ShadowMap& map, int step) {
  raster::ShadowMap small;
  small.view = map.view;
  small.view.size = (map.view.size + step - 1) / step;
  small.format = map.format;
  const float empty = map.view.reversed ? 0.0f : 1.0f;
  small.depth.assign(static_cast<std::size_t>(map.view.face_count) *
                         static_cast<std::size_t>(small.view.size) *
                         static_cast<std::size_t>(small.view.size),
                     empty);
  parallel_for(map.view.face_count * small.view.size, [&](int line) {
    const int face = line / small.view.size, small_row = line % small.view.size;
    for (int row = small_row * step; row < std::min((small_row + 1) * step, map.view.size); ++row)
      for (int column = 0; column < map.view.size; ++column) {
        float& nearest = small.depth[small.texel_index(face, column / step, small_row)];
        const float depth = map.depth[map.texel_index(face, column, row)];
        nearest = map.view.reversed ? std::max(nearest, depth) : std::min(nearest, depth);
      }
  });
  return small;
}

Expected<PictureSet> encode_pictures(const Comparison& c) {
  PictureSet set;
  set.raster.file_name = "raster.png";
  set.raytraced.file_name = "raytrace.png";
  set.lights.resize(c.lights.size());
  std::vector<Job> jobs;
  const Rgb8Image drawn = raster_picture(c);
  for (std::size_t i = 0; i < c.lights.size(); ++i)
    add_light_jobs(jobs, c, drawn, c.lights[i], set.lights[i]);
  jobs.push_back({&set.raster, [&drawn] { return drawn; }});
  jobs.push_back({&set.raytraced, [&c] { return raytraced_picture(c); }});

  if (const auto done = run_jobs(jobs); !done) return fail(done.error());
  for (LightPictures& light : set.lights) share_depth_map(light);
  return set;
}

}  // namespace gnomon::compare
