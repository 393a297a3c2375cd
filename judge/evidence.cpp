#include "judge/evidence.h"

#include <algorithm>
#include <tuple>

#include "scene/base/parallel.h"

namespace gnomon::judge {
namespace {

using compare::Agreement;

constexpr std::size_t most_samples = 40000;
constexpr std::size_t least_border = 40;  ///< pixels; fewer say nothing
/// A right capture's places fall on the pixels' centres up to the rounding of floats; one that is half a
/// pixel off is twice as far.
constexpr double place_slack = 0.25;  // pixels
/// Depth may differ by what a quarter of a pixel's step to its neighbours changes, and by a float's rounding.
constexpr double depth_slack = 1e-4;

/// Less light than one step of a picture of eight bits, beside the brightest. Such is a spot's rim, or a light in the
/// surface's own plane, where the sign of n.l is rounding. A share, and a cosine.
constexpr double faint = 1.0 / 256.0;

/// Whether the picture says that something (with `ratio`: something that the light reaches) was drawn.
bool tells_drawn(const CapturedPictures& pictures) {
  return !pictures.drawn.data.empty() || pictures.ratio;
}

/// Of a ratio that holds other light: pairs of neighbours that are looked at, and by how much of the brightest two colours
/// differ at an edge. Lit by a third of the brightest light and not lit at all are two colours.
constexpr std::size_t most_neighbours = 16000;
constexpr float edge_of_brightest = 0.03f;
constexpr double clearly_lit = 1.0 / 3.0;

struct Tally {
  std::size_t agree = 0, count = 0;
  std::optional<double> share() const {
    if (count == 0) return std::nullopt;
    return static_cast<double>(agree) / static_cast<double>(count);
  }
  Tally& operator+=(const Tally& o) {
    agree += o.agree, count += o.count;
    return *this;
  }
};

struct Tallies {
  Tally places, depths, border, lit, shadowed, edges;
  std::size_t border_seen = 0;  // of the border's samples those where Gnomon sees something
  float darkest = 1.0f, lightest = 0.0f;

  void show(float visibility) {
    darkest = std::min(darkest, visibility), lightest = std::max(lightest, visibility);
  }
  Tallies& operator+=(const Tallies& o) {
    places += o.places, depths += o.depths, border += o.border, lit += o.lit, shadowed += o.shadowed;
    edges += o.edges, border_seen += o.border_seen;
    darkest = std::min(darkest, o.darkest), lightest = std::max(lightest, o.lightest);
    return *this;
  }
};

class Gatherer {
 public:
  Gatherer(const EvidenceInput& in, const Suspect& suspect, double brightest)
      : in_(in), suspect_(suspect), sight_(in.sight), brightest_(brightest) {
    sight_.shift += suspect.shift;
    if (suspect.view) sight_.view = *suspect.view;
    light_ = in.tracer.world().scene->lights[in.light];
    if (suspect.light_turned) light_.direction = -light_.direction;
    for (const Vec3f& c : in.pictures.unshadowed.data)
      least_edge_ = std::max(least_edge_, edge_of_brightest * (c.x + c.y + c.z));
  }

  void grid(std::uint32_t pixel, Tallies& out) const;
  void border(std::uint32_t pixel, Tallies& out) const;
  void neighbours(std::pair<std::uint32_t, std::uint32_t> pixels, Tallies& out) const;

 private:
  struct Shown {
    Ray ray;
    raytrace::SurfacePoint point;
    int x = 0, y = 0;        // of the scene's picture
    std::size_t shadow = 0;  // where the capture shows its visibility
  };
  Shown look(std::uint32_t pixel) const;
  void place(std::uint32_t pixel, const Shown& shown, Tally& out) const;
  void depth(std::uint32_t pixel, const Shown& shown, Tally& out) const;
  void visibility(const Shown& shown, Tallies& out) const;
  /// Whether light arrives cannot be told from a picture.
  bool is_faint(const raytrace::SurfacePoint& point, bool reached) const {
    const double cosine = std::abs(glm::dot(point.normal, light_at(light_, point.position).to_light));
    return cosine < faint || (reached && light_on(light_, point) < faint * brightest_);
  }
  bool drawn(std::size_t pixel) const {
    return in_.pictures.drawn.data.empty() || in_.pictures.drawn.data[pixel] != 0;
  }

  const EvidenceInput& in_;
  const Suspect& suspect_;
  Sight sight_;
  Light light_;
  double brightest_;
  float least_edge_ = 0.0f;
};

Gatherer::Shown Gatherer::look(std::uint32_t pixel) const {
  Shown out;
  const int width = sight_.view.size.width;
  const int cx = static_cast<int>(pixel) % width, cy = static_cast<int>(pixel) / width;
  const bool all = !suspect_.visibility_only;
  std::tie(out.x, out.y) = flipped(all && suspect_.flip_x, all && suspect_.flip_y, sight_.view.size, cx, cy);
  const auto [sx, sy] = flipped(!all && suspect_.flip_x, !all && suspect_.flip_y, sight_.view.size, cx, cy);
  out.shadow = static_cast<std::size_t>(sy) * static_cast<std::size_t>(width) + static_cast<std::size_t>(sx);
  out.ray = pixel_ray(sight_.view, out.x + 0.5 + sight_.shift.x, out.y + 0.5 + sight_.shift.y);
  if (const auto hit = in_.tracer.closest_seen(out.ray)) out.point = in_.tracer.surface_point(out.ray, *hit);
  return out;
}

void Gatherer::place(std::uint32_t pixel, const Shown& shown, Tally& out) const {
  const Vec3 there = suspect_.place_from_captured * in_.pictures.position.data[pixel];
  const Vec3 seen = project_to_pixels(sight_.view, there);
  const double along = sight_.view.distance(there), own = sight_.view.distance(shown.point.position);
  const Vec2 off = glm::abs(Vec2(seen) - Vec2(shown.x + 0.5, shown.y + 0.5) - sight_.shift);
  ++out.count;
  out.agree += seen.z > 0.0 && std::max(off.x, off.y) < place_slack && std::abs(along - own) < 0.05 * own;
}

void Gatherer::depth(std::uint32_t pixel, const Shown& shown, Tally& out) const {
  const double axis = glm::dot(shown.ray.direction, sight_.view.forward);
  const double own = glm::length(shown.point.position - shown.ray.origin);
  const bool distance = in_.pictures.depth_is_distance != suspect_.other_depth;
  const double given = in_.pictures.depth.data[pixel] * suspect_.depth_scale / (distance ? 1.0 : axis);
  const double footprint = pixel_footprint(sight_.view, own);
  const double facing = std::max(0.02, std::abs(glm::dot(shown.point.normal, shown.ray.direction)));
  ++out.count;
  out.agree += std::abs(given - own) < place_slack * footprint / facing + depth_slack * own;
}

void Gatherer::visibility(const Shown& shown, Tallies& out) const {
  const raytrace::SurfacePoint& point = shown.point;
  if (in_.pictures.reached.data[shown.shadow] == 0) return;
  if (in_.map != nullptr) {
    const TexelCoordinate at = project_to_texel(*in_.map, point.position);
    if (!at.inside || at.depth > in_.map->face(at.face).far_depth) return;
  }
  const bool reached = !light_cannot_reach(light_, point.position, point.normal);
  // A renderer that has the light's direction wrong draws what then faces away dark.
  if (!reached && !suspect_.light_turned) return;
  const raytrace::PointVisibility truth =
      reached ? in_.tracer.centre_visibility(point, light_) : raytrace::PointVisibility::shadowed;
  if (truth == raytrace::PointVisibility::uncertain) return;
  const float drawn = in_.pictures.visibility.data[shown.shadow];
  out.show(drawn);
  const bool lit = (drawn > 0.5f) != suspect_.inverted;
  Tally& tally = truth == raytrace::PointVisibility::lit ? out.lit : out.shadowed;
  ++tally.count;
  tally.agree += lit == (truth == raytrace::PointVisibility::lit) ? 1 : 0;
}

void Gatherer::grid(std::uint32_t pixel, Tallies& out) const {
  if (!drawn(pixel)) return;
  const Shown shown = look(pixel);
  const bool hit = shown.point.primitive != no_id;
  if (!in_.pictures.position.data.empty() && hit) place(pixel, shown, out.places);
  if (!in_.pictures.position.data.empty() && !hit) ++out.places.count;
  if (!in_.pictures.depth.data.empty() && hit) depth(pixel, shown, out.depths);
  if (!in_.pictures.depth.data.empty() && !hit) ++out.depths.count;
  if (hit) visibility(shown, out);
}

void Gatherer::border(std::uint32_t pixel, Tallies& out) const {
  const Shown shown = look(pixel);
  const bool hit = shown.point.primitive != no_id;
  const bool reached = hit && !light_cannot_reach(light_, shown.point.position, shown.point.normal);
  const bool masked = !in_.pictures.drawn.data.empty();
  if (!masked && hit && is_faint(shown.point, reached)) return;
  const bool captured = masked ? drawn(pixel) : in_.pictures.reached.data[pixel] != 0;
  const bool seen = masked ? hit : reached;
  ++out.border.count;
  out.border_seen += seen ? 1 : 0;
  out.border.agree += captured == seen ? 1 : 0;
}

/// Where the scene has a silhouette against its background, or a lit surface beside an unlit one, the picture without
/// shadows has an edge.
void Gatherer::neighbours(std::pair<std::uint32_t, std::uint32_t> pixels, Tallies& out) const {
  const Shown a = look(pixels.first), b = look(pixels.second);
  const bool hit_a = a.point.primitive != no_id, hit_b = b.point.primitive != no_id;
  if (hit_a == hit_b) {
    if (!hit_a) return;
    const auto [less, more] = std::minmax(light_on(light_, a.point), light_on(light_, b.point));
    if (less > 0.0 || more < clearly_lit * brightest_) return;
  }
  const Vec3f difference =
      glm::abs(in_.pictures.unshadowed.data[pixels.first] - in_.pictures.unshadowed.data[pixels.second]);
  ++out.edges.count;
  out.edges.agree += difference.x + difference.y + difference.z > least_edge_ ? 1 : 0;
}

template <class Is>
void add_border(const ImageSize& size, const Is& is, std::vector<std::uint32_t>& out) {
  const int w = size.width, h = size.height;
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(w) + static_cast<std::size_t>(x);
      const bool here = is(i);
      const bool edge = (x + 1 < w && is(i + 1) != here) || (x > 0 && is(i - 1) != here) ||
                        (y + 1 < h && is(i + static_cast<std::size_t>(w)) != here) ||
                        (y > 0 && is(i - static_cast<std::size_t>(w)) != here);
      if (edge) out.push_back(static_cast<std::uint32_t>(i));
    }
}

void thin_out(std::vector<std::uint32_t>& pixels) {
  std::sort(pixels.begin(), pixels.end());
  pixels.erase(std::unique(pixels.begin(), pixels.end()), pixels.end());
  if (pixels.size() <= most_samples) return;
  const double step = static_cast<double>(pixels.size()) / most_samples;
  for (std::size_t i = 0; i < most_samples; ++i)
    pixels[i] = pixels[static_cast<std::size_t>(static_cast<double>(i) * step)];
  pixels.resize(most_samples);
}

/// Neighbours along whole rows and whole columns, both spread evenly.
void add_neighbours(const ImageSize& size, std::vector<std::pair<std::uint32_t, std::uint32_t>>& out) {
  const auto w = static_cast<std::uint32_t>(size.width), h = static_cast<std::uint32_t>(size.height);
  const auto step = static_cast<std::uint32_t>(2 * size.pixels() / most_neighbours + 1);
  for (std::uint32_t y = step / 2; y < h; y += step)
    for (std::uint32_t x = 0; x + 1 < w; ++x) out.emplace_back(y * w + x, y * w + x + 1);
  for (std::uint32_t x = step / 2; x < w; x += step)
    for (std::uint32_t y = 0; y + 1 < h; ++y) out.emplace_back(y * w + x, (y + 1) * w + x);
}

}  // namespace

double light_on(const Light& light, const raytrace::SurfacePoint& point) {
  const LightAtPoint at = light_at(light, point.position);
  const double most = std::max({at.irradiance.x, at.irradiance.y, at.irradiance.z});
  return most * std::max(0.0, glm::dot(point.normal, at.to_light));
}

Samples choose_samples(const EvidenceInput& in, const raytrace::RayTracedFrame& frame) {
  Samples out;
  const std::size_t pixels = frame.receiver.data.size();
  // A stride that is prime to the width spreads the samples over columns, too.
  std::size_t stride = std::max<std::size_t>(1, pixels / most_samples);
  while (stride > 1 && static_cast<std::size_t>(frame.receiver.size.width) % stride == 0) ++stride;
  for (std::size_t i = 0; i < pixels; i += stride) out.grid.push_back(static_cast<std::uint32_t>(i));
  if (!tells_drawn(in.pictures)) return out;
  const bool masked = !in.pictures.drawn.data.empty();
  const Light& light = in.tracer.world().scene->lights[in.light];
  for (const std::uint32_t i : out.grid)
    if (frame.receiver.data[i].primitive != no_id)
      out.brightest = std::max(out.brightest, light_on(light, frame.receiver.data[i]));
  if (!masked && in.pictures.other_light) {
    add_neighbours(in.pictures.reached.size, out.neighbours);
    return out;
  }
  const Image<std::uint8_t>& captured = masked ? in.pictures.drawn : in.pictures.reached;
  add_border(
      captured.size, [&](std::size_t i) { return captured.data[i] != 0; }, out.border);
  add_border(
      captured.size,
      [&](std::size_t i) {
        const raytrace::SurfacePoint& p = frame.receiver.data[i];
        return p.primitive != no_id && (masked || !light_cannot_reach(light, p.position, p.normal));
      },
      out.border);
  thin_out(out.border);
  return out;
}

Evidence gather(const EvidenceInput& in, const Samples& samples, const Suspect& suspect) {
  const Gatherer gatherer(in, suspect, samples.brightest);
  constexpr std::size_t block = 512;
  const std::size_t outlines = samples.grid.size() + samples.border.size();
  const std::size_t count = outlines + samples.neighbours.size();
  std::vector<Tallies> parts((count + block - 1) / block);
  parallel_for(parts.size(), [&](std::size_t p) {
    for (std::size_t i = p * block; i < std::min(count, (p + 1) * block); ++i) {
      if (i < samples.grid.size())
        gatherer.grid(samples.grid[i], parts[p]);
      else if (i < outlines)
        gatherer.border(samples.border[i - samples.grid.size()], parts[p]);
      else
        gatherer.neighbours(samples.neighbours[i - outlines], parts[p]);
    }
  });
  Tallies sum;
  for (const Tallies& part : parts) sum += part;
  Evidence out;
  out.positions = sum.places.share(), out.depths = sum.depths.share();
  const Tally& outline = samples.neighbours.empty() ? sum.border : sum.edges;
  out.outlines = outline.count;
  if (outline.count >= least_border) out.silhouettes = outline.share();
  if (sum.border.count > 0) {
    const double seen = static_cast<double>(sum.border_seen) / static_cast<double>(sum.border.count);
    out.least_kind = std::min(seen, 1.0 - seen);
  }
  out.lit = sum.lit.count, out.shadowed = sum.shadowed.count;
  out.darkest = sum.darkest, out.lightest = sum.lightest;
  // Half for the lit ones and half for the shadowed, however few they are.
  const auto lit = sum.lit.share(), shadowed = sum.shadowed.share();
  if (lit && shadowed) out.visibility = 0.5 * (*lit + *shadowed);
  if (!lit && suspect.light_turned) out.visibility = shadowed;
  return out;
}

std::optional<Agreement> Evidence::geometry() const {
  if (positions) return Agreement{"positions", *positions};
  if (depths) return Agreement{"depths", *depths};
  if (silhouettes) return Agreement{"silhouettes", *silhouettes};
  return std::nullopt;
}

std::vector<Agreement> Evidence::all() const {
  std::vector<Agreement> out;
  if (silhouettes) out.push_back({"silhouettes", *silhouettes});
  if (positions) out.push_back({"positions", *positions});
  if (depths) out.push_back({"depths", *depths});
  if (visibility) out.push_back({"visibility", *visibility});
  return out;
}

}  // namespace gnomon::judge
