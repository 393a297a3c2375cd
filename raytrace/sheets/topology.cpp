// Which triangle lies across which edge, with vertices welded by exact position. Kept instances (scene/world.h) share
// what their mesh has, unless they touch something: then they are worked out in the world, with all that is flattened.
// The result is the same for any number of threads, and whether instances are kept or not.

#include <algorithm>
#include <atomic>
#include <tuple>

#include "raytrace/choose_tracer.h"
#include "raytrace/huge_array.h"
#include "raytrace/sheets/contact.h"
#include "raytrace/sheets/sheets.h"
#include "scene/base/parallel.h"
#include "scene/base/stages.h"

namespace gnomon::raytrace {
namespace {

using Parts = std::vector<const WorldPart*>;

/// Some parts of a world, their vertices and triangles numbered one part after the other.
class Soup {
 public:
  explicit Soup(const Parts& parts) : parts_(parts) {
    std::vector<std::uint32_t> vertices{0}, triangles{0};
    for (const WorldPart* part : parts) {
      vertices.push_back(vertices.back() + part->vertex_count());
      triangles.push_back(triangles.back() + part->triangle_count());
    }
    vertices_ = Ranges(std::move(vertices)), triangles_ = Ranges(std::move(triangles));
    if (parts.size() == 1 && !parts[0]->kept()) {
      positions_ = {parts[0]->positions, parts[0]->vertex_count()};
      return;
    }
    moved_.resize(vertices_.size());
    for (std::uint32_t i = 0; i < parts.size(); ++i)
      parallel_for(parts[i]->vertex_count(),
                   [&](std::uint32_t v) { moved_[vertices_.begin_of(i) + v] = parts[i]->position(v); });
    positions_ = moved_;
  }

  std::span<const Vec3> positions() const { return positions_; }
  std::uint32_t triangle_count() const { return triangles_.size(); }
  std::array<std::uint32_t, 3> triangle(std::uint32_t t) const {
    const std::uint32_t part = triangles_.of(t), first = vertices_.begin_of(part);
    const auto corners = parts_[part]->triangle(t - triangles_.begin_of(part));
    return {first + corners[0], first + corners[1], first + corners[2]};
  }
  std::uint32_t world_triangle(std::uint32_t t) const {
    const std::uint32_t part = triangles_.of(t);
    return parts_[part]->first_triangle + (t - triangles_.begin_of(part));
  }
  std::uint32_t world_vertex(std::uint32_t v) const {
    const std::uint32_t part = vertices_.of(v);
    return parts_[part]->first_vertex + (v - vertices_.begin_of(part));
  }

 private:
  const Parts& parts_;
  Ranges vertices_, triangles_;
  std::vector<Vec3> moved_;
  std::span<const Vec3> positions_;
};

/// The lowest vertex at each vertex's position (-0 equals 0).
class Weld {
 public:
  explicit Weld(std::span<const Vec3> positions) : positions_(positions), order_(positions.size()) {}

  HugeVector<std::uint32_t> run() {
    const std::size_t count = positions_.size();
    parallel_for(count, [&](std::size_t i) { order_[i] = hash_of(positions_[i]) << 32 | i; });
    sort_numbers(std::span(order_.data(), count));
    HugeVector<std::uint32_t> welded(count);
    const auto hash_at = [&](std::size_t i) { return order_[i] >> 32; };
    parallel_for(count, [&](std::size_t first) {
      if (first > 0 && hash_at(first) == hash_at(first - 1)) return;
      std::size_t end = first + 1;
      while (end < count && hash_at(end) == hash_at(first)) ++end;
      join({order_.data() + first, end - first}, welded);
    });
    return welded;
  }

 private:
  static std::uint32_t vertex(std::uint64_t entry) { return static_cast<std::uint32_t>(entry); }
  const Vec3& at(std::uint64_t entry) const { return positions_[vertex(entry)]; }

  /// Vertices of one hash, ascending: nearly always at one position, and mostly one alone.
  void join(std::span<const std::uint64_t> run, HugeVector<std::uint32_t>& welded) const {
    const auto rest = run.subspan(1);
    if (std::all_of(rest.begin(), rest.end(), [&](std::uint64_t e) { return at(e) == at(run[0]); })) {
      for (const std::uint64_t entry : run) welded[vertex(entry)] = vertex(run[0]);
      return;
    }
    std::vector<std::uint64_t> sorted(run.begin(), run.end());
    std::sort(sorted.begin(), sorted.end(), [&](std::uint64_t a, std::uint64_t b) {
      const auto ka = std::tie(at(a).x, at(a).y, at(a).z), kb = std::tie(at(b).x, at(b).y, at(b).z);
      return ka != kb ? ka < kb : a < b;
    });
    for (std::size_t i = 0; i < sorted.size(); ++i) {
      const bool same = i > 0 && at(sorted[i]) == at(sorted[i - 1]);
      welded[vertex(sorted[i])] = same ? welded[vertex(sorted[i - 1])] : vertex(sorted[i]);
    }
  }

  std::span<const Vec3> positions_;
  HugeArray<std::uint64_t> order_;  ///< hashes of positions, and in the lower half the vertices
};

/// A triangle's edge, kept with its lower vertex.
struct HalfEdge {
  std::uint32_t high;
  /// 2 * place, and 1 more where the edge leads from its lower vertex to the higher; place = 3 * triangle + edge.
  std::uint32_t tagged;
  std::uint32_t place() const { return tagged / 2; }
  std::uint32_t triangle() const { return place() / 3; }
  bool is_forwards() const { return (tagged & 1) != 0; }
  bool operator<(const HalfEdge& b) const { return std::tie(high, tagged) < std::tie(b.high, b.tagged); }
};

/// Finds what lies across the edges of a soup's triangles.
class Pairing {
 public:
  /// across: three for each triangle, all of which are written.
  Pairing(const Soup& soup, std::span<const std::uint32_t> welded, std::span<std::uint32_t> across)
      : soup_(soup), welded_(welded), across_(across) {}

  void run() {
    sort_by_lower_vertex();
    parallel_for(welded_.size(), [&](std::size_t v) {
      const std::span<HalfEdge> edges(edges_.data() + ends_[v], edges_.data() + ends_[v + 1]);
      std::sort(edges.begin(), edges.end());
      for (std::size_t first = 0; first < edges.size();) {
        std::size_t end = first + 1;
        while (end < edges.size() && edges[end].high == edges[first].high) ++end;
        pair(v, edges.subspan(first, end - first));
        first = end;
      }
    });
  }

 private:
  // A counting sort: each thread counts, then each fills from the end of the vertex's run.
  void sort_by_lower_vertex() {
    ends_ = HugeArray<std::uint32_t>(welded_.size() + 1);
    parallel_for(ends_.size(), [&](std::size_t v) { ends_[v] = 0; });
    const auto each_edge = [&](const auto& use) {
      parallel_for(soup_.triangle_count(), [&](std::uint32_t t) {
        const auto corners = soup_.triangle(t);
        for (std::uint32_t k = 0; k < 3; ++k) {
          const std::uint32_t a = welded_[corners[k]], b = welded_[corners[(k + 1) % 3]];
          use(std::min(a, b), HalfEdge{std::max(a, b), 2 * (3 * t + k) + (a < b ? 1 : 0)});
        }
      });
    };
    each_edge([&](std::uint32_t low, const HalfEdge&) {
      std::atomic_ref(ends_[low]).fetch_add(1, std::memory_order_relaxed);
    });
    for (std::size_t v = 1; v < ends_.size(); ++v) ends_[v] += ends_[v - 1];
    edges_ = HugeArray<HalfEdge>(ends_[welded_.size()]);
    each_edge([&](std::uint32_t low, const HalfEdge& edge) {
      edges_[std::atomic_ref(ends_[low]).fetch_sub(1, std::memory_order_relaxed) - 1] = edge;
    });
  }

  /// All edges between two vertices.
  void pair(std::size_t low, std::span<const HalfEdge> edges) const {
    const HalfEdge &a = edges.front(), &b = edges.back();
    if (edges.size() == 2 && low != a.high && a.is_forwards() != b.is_forwards() &&
        a.triangle() != b.triangle()) {
      across_[a.place()] = soup_.world_triangle(b.triangle());
      across_[b.place()] = soup_.world_triangle(a.triangle());
      return;
    }
    const std::uint32_t none = edges.size() == 1 ? Topology::boundary : Topology::non_manifold;
    for (const HalfEdge& edge : edges) across_[edge.place()] = none;
  }

  static_assert(std::uint64_t{6} * most_primitives < 0xffffffffu, "an edge's place and its direction");
  const Soup& soup_;
  std::span<const std::uint32_t> welded_;
  std::span<std::uint32_t> across_;
  HugeArray<std::uint32_t> ends_;  // of the vertices' runs of edges; filled, their beginnings
  HugeArray<HalfEdge> edges_;
};

}  // namespace

Topology::Topology(const World& world) : triangles_(world.triangle_ranges), parts_(world.parts.size()) {
  const TimedStage stage("topology");
  std::vector<char> together(world.parts.size(), 1);
  if (world.keeps_instances()) together = share_meshes(world);
  std::vector<const WorldPart*> soup;
  for (std::size_t i = 0; i < world.parts.size(); ++i)
    if (together[i] != 0) soup.push_back(&world.parts[i]);
  Place place = connect(soup);
  for (std::size_t i = 0; i < world.parts.size(); ++i) {
    Part& part = parts_[i];
    part.triangles = world.parts[i].mesh->triangles.data(), part.turned = world.parts[i].turned;
    part.first_triangle = world.parts[i].first_triangle;
    if (together[i] == 0) continue;
    part.at = place, part.shared_triangle = part.first_triangle;
    place.across += 3 * std::size_t{world.parts[i].triangle_count()};
    place.welded += world.parts[i].vertex_count();
  }
}

Topology::Place Topology::connect(const std::vector<const WorldPart*>& parts) {
  const Soup soup(parts);
  const Place place{across_.size(), welded_.size()};
  const HugeVector<std::uint32_t> welded = Weld(soup.positions()).run();
  across_.resize(across_.size() + 3 * std::size_t{soup.triangle_count()});
  Pairing(soup, welded, std::span(across_).subspan(place.across)).run();
  welded_.resize(welded_.size() + welded.size());
  parallel_for(welded.size(),
               [&](std::size_t v) { welded_[place.welded + v] = soup.world_vertex(welded[v]); });
  return place;
}

std::vector<char> Topology::share_meshes(const World& world) {
  const Mesh* meshes = world.scene->meshes.data();
  std::vector<Place> places(world.scene->meshes.size());
  std::vector<std::vector<std::uint32_t>> welded(places.size());
  for (const WorldPart& part : world.parts) {
    const auto m = static_cast<std::size_t>(part.mesh - meshes);
    if (!part.kept() || !welded[m].empty()) continue;
    const World alone = make_world(*world.scene, *part.mesh);
    places[m] = connect({&alone.parts[0]});
    welded[m].assign(welded_.begin() + static_cast<std::ptrdiff_t>(places[m].welded), welded_.end());
  }
  const std::vector<char> together = parts_in_contact(world, welded);
  std::vector<std::uint32_t> first(places.size(), no_id);
  for (std::size_t i = 0; i < world.parts.size(); ++i) {
    const WorldPart& part = world.parts[i];
    if (together[i] != 0) continue;
    const auto m = static_cast<std::size_t>(part.mesh - meshes);
    first[m] = std::min(first[m], part.first_triangle);
    parts_[i].at = places[m], parts_[i].shared_triangle = first[m];
    parts_[i].add_triangle = part.first_triangle, parts_[i].add_vertex = part.first_vertex;
  }
  return together;
}

}  // namespace gnomon::raytrace
