// The primitives of each texel's column, by descending the hierarchy with the column's planes. Boxes are
// tested in floats with the rounding given away, primitives in double by raytrace/sheets/column.h.

#include <bit>

#include "raytrace/kernels.h"
#include "raytrace/sheets.h"
#include "raytrace/sheets/column.h"
#include "scene/parallel.h"

namespace gnomon::raytrace {
namespace {

/// A box is kept unless it lies wholly outside one plane: normal . p >= offset for its farthest corner.
class BoxColumn {
 public:
  BoxColumn(const LightView& view, TexelKey key, const Bvh& bvh, double reach) {
    const auto planes = column_planes(view, key.face(), key.column(), key.row());
    for (std::size_t k = 0; k < 4; ++k) sides_[k] = side(planes[k], view.origin, bvh, reach);
    if (view.projection != LightProjection::perspective) return;
    const Vec3& forward = view.faces[static_cast<std::size_t>(key.face())].forward;
    sides_[count_++] = side({forward, 0.0}, view.origin, bvh, reach);
  }

  int intersect(const BvhNode& node) const {
    int mask = 15;
    for (std::size_t k = 0; k < count_ && mask != 0; ++k) {
      const Side& s = sides_[k];
      const Float4 sum = Float4::load(node.bounds[s.far_plane[0]]) * Float4::all(s.normal[0]) +
                         Float4::load(node.bounds[s.far_plane[1]]) * Float4::all(s.normal[1]) +
                         Float4::load(node.bounds[s.far_plane[2]]) * Float4::all(s.normal[2]);
      mask &= less_equal_mask(Float4::all(s.offset), sum);
    }
    return mask;
  }

 private:
  struct Side {
    std::array<float, 3> normal;
    std::array<std::size_t, 3> far_plane;  // rows of BvhNode::bounds
    float offset;
  };

  // reach: the largest coordinate of a box, from the centre. Eight float roundings in the sum and the normal.
  static Side side(const HalfSpace& plane, const Vec3& origin, const Bvh& bvh, double reach) {
    const Vec3 shift = origin - bvh.center;
    const double slack = 8.0 * FLT_EPSILON * 3.0 * reach +
                         error_gamma(16) * (glm::dot(Vec3(1.0), glm::abs(shift)) + std::abs(plane.offset));
    Side out;
    out.offset = float_below(plane.offset + glm::dot(plane.normal, shift) - slack);
    for (std::size_t a = 0; a < 3; ++a) {
      out.normal[a] = static_cast<float>(plane.normal[static_cast<int>(a)]);
      out.far_plane[a] = out.normal[a] < 0.0f ? a : 3 + a;
    }
    return out;
  }

  std::array<Side, 5> sides_;
  std::size_t count_ = 4;
};

/// The sphere around a solid's box.
Sphere around(const ShapeGeometry& geometry) {
  if (const auto* sphere = std::get_if<Sphere>(&geometry)) return *sphere;
  return {solid_center(geometry), 0.5 * local_box(geometry).diagonal()};
}

bool sphere_surely_misses(const Sphere& sphere, const LightView& view, TexelKey key) {
  const Vec3 offset = sphere.center - view.origin;
  const double size = glm::dot(Vec3(1.0), glm::abs(sphere.center) + glm::abs(view.origin)) + sphere.radius;
  const LightFace& face = view.face(key.face());
  const double reach =
      std::max({face.half_extent.x, face.half_extent.y, std::abs(face.center.x), std::abs(face.center.y)});
  const double slack =
      error_gamma(32) * (size + (view.projection == LightProjection::orthographic ? reach : size));
  for (const HalfSpace& plane : column_planes(view, key.face(), key.column(), key.row()))
    if (glm::dot(plane.normal, offset) - plane.offset < -(sphere.radius + slack)) return true;
  return view.projection == LightProjection::perspective &&
         glm::dot(face.forward, offset) < -(sphere.radius + slack);
}

/// Collects the lists of a run of keys; one per task, for it keeps its buffers.
class Collector {
 public:
  Collector(const Structures& s, const Bvh& bvh, const LightView& view) : s_(s), bvh_(bvh), view_(view) {
    const Aabb& b = s.world->finite_bounds;
    reach_ =
        b.empty() ? 0.0 : max_component(glm::max(glm::abs(b.min - bvh.center), glm::abs(b.max - bvh.center)));
  }

  /// The lists one after the other in `out`; ends[i] is where the i-th ends.
  void collect(std::span<const TexelKey> keys, std::span<std::uint64_t> ends,
               std::vector<std::uint32_t>& out) {
    for (std::size_t i = 0; i < keys.size(); ++i) {
      list(keys[i], out);
      ends[i] = out.size();
    }
  }

 private:
  // Into found_ the leaf primitives whose boxes the column may intersect.
  void gather(TexelKey key) {
    found_.clear();
    if (bvh_.nodes.empty())
      for (std::uint32_t i = 0; i < bvh_.ids.size(); ++i) found_.push_back(i);
    else
      descend(bvh_, NodesThere{}, BoxColumn(view_, key, bvh_, reach_));
  }

  bool surely_misses(const TexelColumn& column, TexelKey key, std::uint32_t leaf, std::uint32_t id) const {
    if (!s_.world->is_triangle(id))
      return sphere_surely_misses(around(s_.world->shape(id).geometry), view_, key);
    const LeafPrimitive triangle = bvh_.primitive_at(leaf);
    return column.surely_misses({column.vertex(triangle.corner(0)), column.vertex(triangle.corner(1)),
                                 column.vertex(triangle.corner(2))});
  }

  template <class Space>
  void descend(const Bvh& tree, const Space& space, const BoxColumn& boxes) {
    std::array<BvhChild, Bvh::stack_size> stack;
    BvhNode scratch;
    std::size_t size = 0;
    stack[size++] = BvhChild::node(0);
    while (size > 0) {
      const BvhChild child = stack[--size];
      if (child.is_instance()) {
        const BvhInstance& instance = bvh_.instances[child.instance()];
        descend(bvh_.trees[instance.tree], NodesPlaced{instance}, boxes);
        continue;
      }
      if (child.is_leaf()) {
        const LeafRange run = space.leaves({child.first(), child.count()});
        for (std::uint32_t i = run.first; i < run.first + run.count; ++i) found_.push_back(i);
        continue;
      }
      const BvhNode& node = space.at(tree.nodes[child.index()], scratch);
      for (auto mask = static_cast<unsigned>(boxes.intersect(node)); mask != 0; mask &= mask - 1)
        stack[size++] = node.child[std::countr_zero(mask)];
    }
  }

  // The primitives that may intersect the column, ascending.
  void list(TexelKey key, std::vector<std::uint32_t>& out) {
    gather(key);
    const TexelColumn column(view_, key.face(), key.column(), key.row());
    const std::size_t first = out.size();
    for (const std::uint32_t leaf : found_) {
      const std::uint32_t id = bvh_.id_at(leaf);
      if (!surely_misses(column, key, leaf, id)) out.push_back(id);
    }
    out.insert(out.end(), s_.planes.begin(), s_.planes.end());
    std::sort(out.begin() + static_cast<std::ptrdiff_t>(first), out.end());
  }

  const Structures& s_;
  const Bvh& bvh_;
  const LightView& view_;
  double reach_;
  std::vector<std::uint32_t> found_;  // places in leaf order
};

}  // namespace

std::size_t TexelLists::find(TexelKey key) const {
  const auto at = std::lower_bound(keys.begin(), keys.end(), key);
  return at != keys.end() && *at == key ? static_cast<std::size_t>(at - keys.begin()) : keys.size();
}

TexelLists build_texel_lists(const Tracer& tracer, const LightView& view, std::vector<TexelKey> keys) {
  constexpr std::size_t block = 256;  // keys per task
  const Structures& s = tracer.structures();
  std::optional<Bvh> made;  // the other structures answer rays, not columns
  if (s.structure != nullptr) made = build_bvh(*s.world);
  const Bvh& bvh = made ? *made : s.bvh;
  TexelLists lists;
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  lists.keys = std::move(keys);
  const std::size_t count = lists.keys.size(), blocks = (count + block - 1) / block;
  std::vector<std::vector<std::uint32_t>> found(blocks);
  lists.offsets.assign(count + 1, 0);
  parallel_for(blocks, [&](std::size_t b) {
    const std::size_t begin = b * block, size = std::min(count, begin + block) - begin;
    Collector(s, bvh, view)
        .collect(std::span(lists.keys).subspan(begin, size),
                 std::span(lists.offsets).subspan(begin + 1, size), found[b]);
  });
  std::vector<std::uint64_t> first(blocks + 1, 0);
  for (std::size_t b = 0; b < blocks; ++b) first[b + 1] = first[b] + found[b].size();
  lists.primitives.resize(first[blocks]);
  parallel_for(blocks, [&](std::size_t b) {
    std::copy(found[b].begin(), found[b].end(),
              lists.primitives.begin() + static_cast<std::ptrdiff_t>(first[b]));
    for (std::size_t i = b * block; i < std::min(count, (b + 1) * block); ++i)
      lists.offsets[i + 1] += first[b];
  });
  return lists;
}

}  // namespace gnomon::raytrace
