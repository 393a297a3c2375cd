#include "raster/world/triangle_runs.h"

#include <algorithm>

namespace gnomon::raster {
namespace {

/// The first triangle after `first`, before `end`, of another material; else `end`.
std::uint32_t end_of_material(const WorldPart& part, std::uint32_t first, std::uint32_t end) {
  const auto& of_triangles = part.mesh->triangle_materials;
  if (of_triangles.empty()) return end;
  const auto begin = of_triangles.begin();
  const auto other =
      std::find_if(begin + first, begin + end, [&](std::uint32_t m) { return m != of_triangles[first]; });
  return static_cast<std::uint32_t>(other - begin);
}

void append(const TriangleRun& run, std::size_t first_to_join, std::vector<TriangleRun>& runs) {
  if (runs.size() > first_to_join && run.follows(runs.back()))
    runs.back().count += run.count;
  else
    runs.push_back(run);
}

}  // namespace

TriangleRuns::TriangleRuns(const World& world, const StoredMeshes& meshes, const SceneFeatures& features)
    : world_(&world) {
  for (const TriangleBlock& block : world.blocks) {
    const std::size_t first_of_block = runs_.size();
    first_run_.push_back(static_cast<std::uint32_t>(first_of_block));
    const WorldPart& part = world.parts[block.part];
    const std::uint32_t end = block.first + block.count;
    for (std::uint32_t i = block.first, next = 0; i < end; i = next) {
      next = end_of_material(part, i, end);
      const Material& material = world.scene->materials[part.material_of(i)];
      append({.first = part.first_triangle + i,
              .count = next - i,
              .at = meshes.of_part[block.part].triangles + i,
              .part = part.kept() ? block.part : no_id,
              .masked = features.alpha_mask && material.alpha_mode == AlphaMode::mask,
              .single_sided = features.single_sided && !shows_back(material),
              .casts = material.casts_shadow,
              .inside_out = part.is_inside_out()},
             first_of_block, runs_);
    }
  }
  first_run_.push_back(static_cast<std::uint32_t>(runs_.size()));
}

std::vector<TriangleRun> TriangleRuns::within(const ClipSides& sides, bool casters_alone) const {
  std::vector<TriangleRun> seen;
  for (std::size_t b = 0; b < world_->blocks.size(); ++b) {
    if (sides.surely_outside(world_->blocks[b].bounds)) continue;
    for (std::uint32_t r = first_run_[b]; r < first_run_[b + 1]; ++r)
      if (runs_[r].casts || !casters_alone) append(runs_[r], 0, seen);
  }
  return seen;
}

namespace {

/// Bounds what a sum may be off by, as a share of its terms' sizes: places, coefficients and sums are rounded to floats,
/// less than ten times 2^-24 for each.
constexpr double slack = 0x1p-20;

}  // namespace

ClipSides::ClipSides(const Mat4& clip_from_relative, const Vec3& reference) : reference_(reference) {
  const Mat4 rows = glm::transpose(clip_from_relative);
  const Vec4 &x = rows[0], &y = rows[1], &w = rows[3];
  side_ = {w + x, w - x, w + y, w - y, w};
  const Vec4 beside_x = glm::abs(w) + glm::abs(x), beside_y = glm::abs(w) + glm::abs(y);
  size_ = {beside_x, beside_x, beside_y, beside_y, glm::abs(w)};
}

bool ClipSides::surely_outside(const Aabb& world_box) const {
  const Vec3 low = world_box.min - reference_, high = world_box.max - reference_;
  const Vec3 far = glm::max(glm::abs(low), glm::abs(high));
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 n(side_[i]);
    const double most = glm::dot(glm::max(n * low, n * high), Vec3(1.0)) + side_[i].w;
    if (most < -slack * (glm::dot(Vec3(size_[i]), far) + size_[i].w)) return true;
  }
  return false;
}

}  // namespace gnomon::raster
