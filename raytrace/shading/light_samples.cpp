#include "raytrace/shading/light_samples.h"

#include <array>
#include <bit>
#include <numeric>
#include <vector>

#include "raytrace/shading/light_shaft.h"

namespace gnomon::raytrace {

LightSamples::LightSamples(const Tracer& tracer, const SurfacePoint& from, const Light& light, int count,
                           std::uint64_t key)
    : tracer_(tracer),
      from_(from),
      endless_(light.type == LightType::directional),
      count_(count),
      square_(static_cast<std::uint32_t>(count), key),
      sampler_(light_sampler(light, from.position)) {}

Ray LightSamples::ray(const Vec2& square) const {
  const Vec3 aim = sampler_.aim(sampler_, square);
  return endless_ ? tracer_.spawn_ray(from_, aim) : tracer_.shadow_ray(from_, aim);
}

bool LightSamples::below_horizon(const Vec3& direction) const {
  return !(glm::dot(from_.normal, direction) > 0.0);
}

std::optional<Ray> LightSamples::operator[](int i) const {
  const Ray ray = this->ray(square_[static_cast<std::uint32_t>(i)]);
  if (below_horizon(ray.direction)) return std::nullopt;
  return ray;
}

namespace {

// Of the members of a block: the sum of their strata's variances. A whole block's interaction of rows and
// columns has four times the variance of one stratum, and no trend along either; the spread of a block that
// is cut short by the number of samples also holds its trend.
double block_variance(std::span<const std::uint8_t> samples, std::span<const std::size_t> members) {
  if (members.size() == 4) {
    const double contrast = double(samples[members[0]]) - double(samples[members[1]]) -
                            double(samples[members[2]]) + double(samples[members[3]]);
    return contrast * contrast;
  }
  if (members.size() < 2) return 0.0;
  const auto count = static_cast<double>(members.size());
  double lit = 0.0;
  for (const std::size_t i : members) lit += samples[i];
  return lit * (count - lit) / (count - 1.0);
}

double unstratified_standard_error(std::span<const std::uint8_t> samples) {
  if (samples.size() < 2) return 0.0;
  const auto count = static_cast<double>(samples.size());
  const double share = std::accumulate(samples.begin(), samples.end(), 0.0) / count;
  return std::sqrt(share * (1.0 - share) / (count - 1.0));
}

}  // namespace

double stratified_standard_error(std::span<const std::uint8_t> samples) {
  const std::size_t count = samples.size();
  if (count < 16) return unstratified_standard_error(samples);
  // Of 2^m points each cell of a grid with 2^ceil(m/2) rows holds one. Rows are numbered by the point's
  // lowest bits in reverse, columns by the others: these two bits step to the next row and to the next
  // column.
  const int bits = std::bit_width(count - 1), row_bits = (bits + 1) / 2;
  const std::size_t down = std::size_t{1} << (row_bits - 1), across = std::size_t{1} << row_bits;
  double variance = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    if ((i & (down | across)) != 0) continue;
    std::array<std::size_t, 4> members{};
    std::size_t found = 0;
    for (const std::size_t member : {i, i | down, i | across, i | down | across})
      if (member < count) members[found++] = member;
    variance += block_variance(samples, std::span(members).first(found));
  }
  return std::sqrt(variance) / static_cast<double>(count);
}

SampledVisibility light_visibility(const Tracer& tracer, const SurfacePoint& from, const Light& light,
                                   int samples, std::uint64_t key) {
  if (!tracer.receives_shadow(from)) return {};
  const LightBlockers blockers = find_light_blockers(tracer, from, light, samples);
  if (blockers.none()) return {1.0, 0.0, 0};
  const LightSamples rays(tracer, from, light, samples, key);
  SampledVisibility seen;
  int lit = 0;
  thread_local std::vector<std::uint8_t> arrived;
  arrived.assign(static_cast<std::size_t>(samples), 0);
  for (int i = 0; i < samples; ++i) {
    const std::optional<Ray> ray = rays[i];
    if (!ray) continue;
    ++seen.rays;
    if (blockers.block(tracer, *ray)) continue;
    arrived[static_cast<std::size_t>(i)] = 1;
    ++lit;
  }
  seen.share = static_cast<double>(lit) / samples;
  if (lit > 0 && lit < samples) seen.standard_error = stratified_standard_error(arrived);
  return seen;
}

}  // namespace gnomon::raytrace
