// The primitives of each texel's column, by descending the hierarchy with the column's planes. Boxes are
// tested in floats with the rounding given away, primitives in double by raytrace/column.h.
#include <tbb/parallel_for.h>

#include <bit>

#include "raytrace/column.h"
#include "raytrace/kernels.h"
#include "raytrace/sheets.h"

namespace gnomon::raytrace {
namespace {

/// A box is kept unless it lies wholly outside one plane: normal . p >= offset for its farthest corner.
struct BoxColumn {
  struct Side {
    std::array<float, 3> normal;
    std::array<std::size_t, 3> far_plane;  // rows of BvhNode::bounds
    float offset;
  };
  std::array<Side, 5> sides;
  std::size_t count = 4;

  BoxColumn(const LightView& view, TexelKey key, const Bvh& bvh, double reach) {
    const auto planes = column_planes(view, key.face(), key.column(), key.row());
    for (std::size_t k = 0; k < 4; ++k) sides[k] = side(planes[k], view.origin, bvh, reach);
    if (view.projection == LightProjection::perspective)
      sides[count++] =
          side({view.faces[static_cast<std::size_t>(key.face())].forward, 0.0}, view.origin, bvh, reach);
  }

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

  int meet(const BvhNode& node) const {
    int mask = 15;
    for (std::size_t k = 0; k < count && mask != 0; ++k) {
      const Side& s = sides[k];
      const Float4 sum = Float4::load(node.bounds[s.far_plane[0]]) * Float4::all(s.normal[0]) +
                         Float4::load(node.bounds[s.far_plane[1]]) * Float4::all(s.normal[1]) +
                         Float4::load(node.bounds[s.far_plane[2]]) * Float4::all(s.normal[2]);
      mask &= less_equal_mask(Float4::all(s.offset), sum);
    }
    return mask;
  }
};

bool sphere_surely_misses(const Sphere& sphere, const LightView& view, TexelKey key) {
  const Vec3 offset = sphere.center - view.origin;
  const double size = glm::dot(Vec3(1.0), glm::abs(sphere.center) + glm::abs(view.origin)) + sphere.radius;
  const double reach = std::max(view.half_extent.x, view.half_extent.y);
  const double slack =
      error_gamma(32) * (size + (view.projection == LightProjection::orthographic ? reach : size));
  for (const HalfSpace& plane : column_planes(view, key.face(), key.column(), key.row()))
    if (glm::dot(plane.normal, offset) - plane.offset < -(sphere.radius + slack)) return true;
  const Vec3& forward = view.faces[static_cast<std::size_t>(key.face())].forward;
  return view.projection == LightProjection::perspective &&
         glm::dot(forward, offset) < -(sphere.radius + slack);
}

/// The list of one column, appended to `out`.
class Collector {
 public:
  Collector(const Structures& s, const LightView& view) : s_(s), view_(view) {
    const Aabb& b = s.world->finite_bounds;
    reach_ = b.empty()
                 ? 0.0
                 : max_component(glm::max(glm::abs(b.min - s.bvh.center), glm::abs(b.max - s.bvh.center)));
  }

  void collect(TexelKey key, std::vector<std::uint32_t>& out) const {
    const std::size_t first = out.size();
    const Column column(view_, key.face(), key.column(), key.row());
    if (s_.bvh.nodes.empty())
      for (std::uint32_t i = 0; i < s_.bvh.ids.size(); ++i) offer(column, key, i, out);
    else
      descend(column, key, out);
    out.insert(out.end(), s_.planes.begin(), s_.planes.end());
    std::sort(out.begin() + static_cast<std::ptrdiff_t>(first), out.end());
  }

 private:
  void descend(const Column& column, TexelKey key, std::vector<std::uint32_t>& out) const {
    const BoxColumn boxes(view_, key, s_.bvh, reach_);
    std::array<BvhChild, Bvh::stack_size> stack;
    std::size_t size = 0;
    stack[size++] = BvhChild::node(0);
    while (size > 0) {
      const BvhChild child = stack[--size];
      if (child.is_leaf()) {
        for (std::uint32_t i = child.first(); i < child.first() + child.count(); ++i)
          offer(column, key, i, out);
        continue;
      }
      const BvhNode& node = s_.bvh.nodes[child.index()];
      for (auto mask = static_cast<unsigned>(boxes.meet(node)); mask != 0; mask &= mask - 1)
        stack[size++] = node.child[std::countr_zero(mask)];
    }
  }

  void offer(const Column& column, TexelKey key, std::uint32_t index, std::vector<std::uint32_t>& out) const {
    const std::uint32_t id = s_.bvh.ids[index];
    if (s_.world->is_triangle(id)) {
      const auto& v = s_.bvh.primitives[index].v;
      const std::array<LightVertex, 3> t{column.vertex({v[0], v[1], v[2]}), column.vertex({v[3], v[4], v[5]}),
                                         column.vertex({v[6], v[7], v[8]})};
      if (!column.surely_misses(t)) out.push_back(id);
    } else if (!sphere_surely_misses(std::get<Sphere>(s_.world->shape(id).geometry), view_, key)) {
      out.push_back(id);
    }
  }

  const Structures& s_;
  const LightView& view_;
  double reach_;
};

}  // namespace

std::size_t TexelLists::find(TexelKey key) const {
  const auto at = std::lower_bound(keys.begin(), keys.end(), key);
  return at != keys.end() && *at == key ? static_cast<std::size_t>(at - keys.begin()) : keys.size();
}

TexelLists build_texel_lists(const Tracer& tracer, const LightView& view, std::vector<TexelKey> keys) {
  constexpr std::size_t block = 256;  // keys per task
  TexelLists lists;
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  lists.keys = std::move(keys);
  const std::size_t count = lists.keys.size(), blocks = (count + block - 1) / block;
  const Collector collector(tracer.structures(), view);
  std::vector<std::vector<std::uint32_t>> found(blocks);
  lists.offsets.assign(count + 1, 0);
  tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t b) {
    for (std::size_t i = b * block; i < std::min(count, (b + 1) * block); ++i) {
      collector.collect(lists.keys[i], found[b]);
      lists.offsets[i + 1] = found[b].size();
    }
  });
  std::vector<std::uint64_t> first(blocks + 1, 0);
  for (std::size_t b = 0; b < blocks; ++b) first[b + 1] = first[b] + found[b].size();
  lists.primitives.resize(first[blocks]);
  tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t b) {
    std::copy(found[b].begin(), found[b].end(),
              lists.primitives.begin() + static_cast<std::ptrdiff_t>(first[b]));
    for (std::size_t i = b * block; i < std::min(count, (b + 1) * block); ++i)
      lists.offsets[i + 1] += first[b];
  });
  return lists;
}

}  // namespace gnomon::raytrace
