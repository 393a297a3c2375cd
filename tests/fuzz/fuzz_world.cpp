// Bytes become a small scene and rays on a coarse lattice, where rays meet vertices, edges, planes of cells
// and each other's surfaces all the time; every acceleration structure must answer as brute force does.
#include <array>

#include "fuzz_target.h"
#include "raytrace/tracer.h"

namespace {

using namespace gnomon;            // NOLINT(google-build-using-namespace)
using namespace gnomon::raytrace;  // NOLINT(google-build-using-namespace)

class Reader {
 public:
  Reader(const std::uint8_t* data, std::size_t size) : at_(data), end_(data + size) {}
  bool empty() const { return at_ == end_; }
  std::uint8_t byte() { return empty() ? std::uint8_t{0} : *at_++; }
  // Eighths from -4 to 4 by three bytes' low bits; a high bit makes one component tiny, huge or negative
  // zero.
  Vec3 point() { return {coordinate(), coordinate(), coordinate()}; }

 private:
  double coordinate() {
    constexpr std::array<double, 4> odd{-0.0, 1e-30, 1e6, 0.1};
    const std::uint8_t b = byte();
    return (b & 0xc0) == 0xc0 ? odd[b & 3] : ((b & 63) - 32) / 8.0;
  }
  const std::uint8_t *at_, *end_;
};

Scene decode(Reader& in) {
  Scene scene;
  scene.materials.emplace_back();
  Mesh mesh;
  const unsigned first = in.byte(), triangles = first % 32u, copies = first / 32u % 4u,
                 spheres = in.byte() % 4u;
  for (unsigned i = 0; i < triangles; ++i) {
    const auto corner = static_cast<std::uint32_t>(mesh.positions.size());
    for (int k = 0; k < 3; ++k) mesh.positions.push_back(in.point());
    mesh.triangles.push_back({corner, corner + 1, corner + 2});
  }
  if (triangles > 0) {
    scene.meshes.push_back(std::move(mesh));
    scene.instances.emplace_back();
    for (unsigned i = 0; i < copies; ++i) {  // by any affine map, also such as cannot be inverted
      MeshInstance copy;
      for (int column = 0; column < 4; ++column)
        copy.world_from_object[column] = Vec4(in.point(), column == 3 ? 1.0 : 0.0);
      scene.instances.push_back(copy);
    }
  }
  for (unsigned i = 0; i < spheres; ++i) {
    const Vec3 center = in.point();
    scene.shapes.push_back({"sphere", Sphere{center, (1 + in.byte() % 16) / 8.0}, 0});
  }
  return scene;
}

bool same(const std::optional<Hit>& a, const std::optional<Hit>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return a->t == b->t && a->primitive == b->primitive && a->barycentric == b->barycentric;
}

constexpr std::array rivals{Accel::bvh,           Accel::bvh_median, Accel::kdtree,
                            Accel::kdtree_cyclic, Accel::octree,     Accel::grid,
                            Accel::grid_textbook, Accel::bsp,        Accel::two_level};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Reader in(data, size);
  const Scene scene = decode(in);
  const World world = make_world(scene);
  const Tracer brute(world, Accel::brute);
  std::vector<Ray> rays;
  while (!in.empty() && rays.size() < 64) {
    const Vec3 origin = in.point(), target = in.point();
    rays.push_back({origin, target - origin});
  }
  for (std::size_t i = 0; i < rivals.size(); ++i) {
    const Tracer tracer(world, rivals[i]);
    for (const Ray& ray : rays)
      if (!same(tracer.closest_hit(ray), brute.closest_hit(ray)) ||
          tracer.occluded(ray) != brute.occluded(ray))
        fuzz::broken("structure " + std::to_string(i) + " differs from brute force");
  }
  return 0;
}

std::vector<std::string> gnomon::fuzz::seeds() {
  std::vector<std::string> all;
  std::uint32_t state = 1;
  for (int i = 0; i < 8; ++i) {
    std::string bytes{static_cast<char>(4 * i + 3 + 32 * (i % 4)), static_cast<char>(i)};
    for (int k = 0; k < 600; ++k) {
      state = state * 1664525u + 1013904223u;
      bytes += static_cast<char>((state >> 24) & 0x3f);
    }
    all.push_back(bytes);
  }
  return all;
}
