#include "raytrace/accel/two_level.h"

#include <algorithm>

#include "scene/base/parallel.h"

namespace gnomon::raytrace {
namespace {

/// Up to so many triangles a tree of one's own takes less memory than a placement.
constexpr std::size_t few_triangles = 8;

using Boxes = std::span<const BoxRef>;

/// An instance's triangles that can be hit, in the order of their ids.
struct InstancePart {
  std::uint32_t first_id;  ///< of all its triangles
  std::uint32_t first;     ///< of `boxes` among all primitives
  Boxes boxes;
  std::uint32_t local(std::size_t i) const { return boxes[i].id - first_id; }
};

std::vector<InstancePart> parts_of(const World& world, Boxes all) {
  std::vector<InstancePart> parts;
  std::uint32_t first_id = 0;
  std::size_t at = 0;
  for (const MeshInstance& instance : world.scene->instances) {
    const auto count = static_cast<std::uint32_t>(world.scene->meshes[instance.mesh].triangles.size());
    const std::size_t first = at;
    while (at < all.size() && all[at].id < first_id + count) ++at;
    parts.push_back({first_id, static_cast<std::uint32_t>(first), all.subspan(first, at - first)});
    first_id += count;
  }
  return parts;
}

/// Whether the same triangles of the same mesh are left: rounding may have taken a triangle's area from one
/// instance alone.
bool same_triangles(const InstancePart& a, const InstancePart& b) {
  if (a.boxes.size() != b.boxes.size()) return false;
  for (std::size_t i = 0; i < a.boxes.size(); ++i)
    if (a.local(i) != b.local(i)) return false;
  return true;
}

/// Instances that can share a tree, by their numbers.
std::vector<std::vector<std::uint32_t>> groups_of(const Scene& scene, std::span<const InstancePart> parts) {
  std::vector<std::vector<std::uint32_t>> groups;
  std::vector<std::vector<std::size_t>> of_mesh(scene.meshes.size());
  for (std::uint32_t i = 0; i < parts.size(); ++i) {
    if (parts[i].boxes.empty()) continue;
    auto& candidates = of_mesh[scene.instances[i].mesh];
    const auto found = std::find_if(candidates.begin(), candidates.end(), [&](std::size_t g) {
      return same_triangles(parts[groups[g][0]], parts[i]);
    });
    if (found != candidates.end()) {
      groups[*found].push_back(i);
      continue;
    }
    candidates.push_back(groups.size());
    groups.push_back({i});
  }
  return groups;
}

CellBox bounds_of(Boxes boxes) {
  CellBox all{boxes[0].min, boxes[0].max};
  for (const BoxRef& box : boxes)
    for (std::size_t a = 0; a < 3; ++a) {
      all.min[a] = std::min(all.min[a], box.min[a]);
      all.max[a] = std::max(all.max[a], box.max[a]);
    }
  return all;
}

MeshSpace space_of(const Mesh& mesh, const InstancePart& part) {
  Aabb box;
  for (std::size_t i = 0; i < part.boxes.size(); ++i)
    for (const std::uint32_t corner : mesh.triangles[part.local(i)]) box.grow(mesh.positions[corner]);
  return MeshSpace(box);
}

std::vector<BoxRef> boxes_in_tree(const Mesh& mesh, const InstancePart& part, const MeshSpace& space) {
  std::vector<BoxRef> boxes(part.boxes.size());
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    Aabb box;
    for (const std::uint32_t corner : mesh.triangles[part.local(i)])
      box.grow(space.tree_from_object(mesh.positions[corner]));
    for (int a = 0; a < 3; ++a) {
      const auto k = static_cast<std::size_t>(a);
      boxes[i].min[k] = float_below(box.min[a]), boxes[i].max[k] = float_above(box.max[a]);
    }
    boxes[i].id = i;
  }
  return boxes;
}

class TwoLevelBuilder {
 public:
  TwoLevelBuilder(const World& world, TwoLevel& out)
      : scene_(*world.scene), out_(out), finite_(finite_primitives(world)) {
    parts_ = parts_of(world, finite_.boxes);
    out_.leaves.center = finite_.center, out_.leaves.dropped = finite_.dropped;
    out_.leaves.ids.resize(finite_.boxes.size());
  }

  void build() {
    for (const auto& group : groups_of(scene_, parts_)) plan(group);
    out_.trees.resize(jobs_.size());
    parallel_for(jobs_.size(), [&](std::size_t j) { build_tree(j); });
    for (std::uint32_t i = shapes_begin(); i < finite_.boxes.size(); ++i) {
      const BoxRef& box = finite_.boxes[i];
      out_.leaves.ids[i] = box.id;
      out_.entries.push_back({{box.min, box.max}, no_id, no_id, i});
    }
    build_upper();
  }

 private:
  /// A tree to build, and the instances that use it.
  struct Job {
    std::vector<std::uint32_t> instances;
    std::optional<MeshSpace> space;  ///< none: the world's
  };

  std::uint32_t shapes_begin() const {
    return parts_.empty() ? 0 : parts_.back().first + static_cast<std::uint32_t>(parts_.back().boxes.size());
  }

  /// Which of the group's instances share a tree, and which get their own.
  void plan(const std::vector<std::uint32_t>& group) {
    const InstancePart& part = parts_[group[0]];
    std::vector<std::uint32_t> alone = group, shared;
    std::vector<Placement> placements;
    std::optional<MeshSpace> space;
    if (group.size() > 1 && part.boxes.size() > few_triangles) {
      space = space_of(scene_.meshes[scene_.instances[group[0]].mesh], part);
      alone.clear();
      for (const std::uint32_t i : group) {
        const auto placement = place(*space, scene_.instances[i].world_from_object);
        (placement ? shared : alone).push_back(i);
        if (placement) placements.push_back(*placement);
      }
    }
    if (shared.size() == 1) alone.push_back(shared[0]), shared.clear();
    if (!shared.empty()) {
      for (std::size_t k = 0; k < shared.size(); ++k)
        add_entry(shared[k], static_cast<std::uint32_t>(out_.placements.size() + k));
      out_.placements.insert(out_.placements.end(), placements.begin(), placements.end());
      jobs_.push_back({std::move(shared), space});
    }
    for (const std::uint32_t i : alone) {
      add_entry(i, no_id);
      jobs_.push_back({{i}, std::nullopt});
    }
  }

  /// Adds an entry of the next job.
  void add_entry(std::uint32_t instance, std::uint32_t placement) {
    out_.entries.push_back({bounds_of(parts_[instance].boxes), static_cast<std::uint32_t>(jobs_.size()),
                            placement, parts_[instance].first});
  }

  void build_tree(std::size_t j) {
    const Job& job = jobs_[j];
    const InstancePart& model = parts_[job.instances[0]];
    std::vector<BoxRef> boxes;
    if (job.space) {
      boxes = boxes_in_tree(scene_.meshes[scene_.instances[job.instances[0]].mesh], model, *job.space);
    } else {
      boxes.assign(model.boxes.begin(), model.boxes.end());
      for (std::uint32_t i = 0; i < boxes.size(); ++i) boxes[i].id = i;
    }
    Bvh tree = build_bvh(boxes);
    for (const std::uint32_t instance : job.instances) {
      const InstancePart& part = parts_[instance];
      for (std::size_t i = 0; i < boxes.size(); ++i)
        out_.leaves.ids[part.first + i] = part.boxes[tree.ids[i]].id;
    }
    tree.ids = {}, tree.below = {};
    tree.nodes.shrink_to_fit();
    out_.trees[j] = std::move(tree);
  }

  void build_upper() {
    std::vector<BoxRef> boxes;
    for (const TwoLevel::Entry& entry : out_.entries)
      boxes.push_back({entry.box.min, entry.box.max, static_cast<std::uint32_t>(boxes.size())});
    out_.upper = build_bvh(boxes);
    std::vector<TwoLevel::Entry> in_order;
    for (const std::uint32_t i : out_.upper.ids) in_order.push_back(out_.entries[i]);
    out_.entries = std::move(in_order);
    out_.upper.ids = {}, out_.upper.below = {};
    out_.upper.nodes.shrink_to_fit();
  }

  const Scene& scene_;
  TwoLevel& out_;
  FinitePrimitives finite_;
  std::vector<InstancePart> parts_;
  std::vector<Job> jobs_;
};

}  // namespace

std::uint64_t TwoLevel::nodes() const {
  std::uint64_t count = upper.nodes.size();
  for (const Bvh& tree : trees) count += tree.nodes.size();
  return count;
}

std::uint64_t TwoLevel::bytes() const {
  return nodes() * sizeof(BvhNode) + entries.size() * sizeof(Entry) + trees.size() * sizeof(Bvh) +
         placements.size() * sizeof(Placement);
}

TwoLevel build_two_level(const World& world) {
  TwoLevel two;
  TwoLevelBuilder(world, two).build();
  return two;
}

}  // namespace gnomon::raytrace
