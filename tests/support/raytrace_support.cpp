#include "tests/support/raytrace_support.h"
#include "verify/quad.h"

#include <cstdlib>
#include <fstream>
#include <sstream>

namespace gnomon::test {

std::uint64_t seed_of_environment() {
  static const std::uint64_t seed = [] {
    const char* asked = std::getenv("GNOMON_TEST_SEED");
    return asked == nullptr ? 0 : std::strtoull(asked, nullptr, 10);
  }();
  return seed;
}

Mesh uv_sphere(const Vec3& center, double radius, int rings, int sectors, double jitter, std::uint64_t seed) {
  Random random(seed);
  return verify::round_mesh(center, radius, rings, sectors, jitter, random);
}

Mesh triangle_soup(int count, double extent, double size, std::uint64_t seed) {
  Random random(seed);
  return verify::soup(count, extent, size, random);
}

std::optional<Mesh> read_obj(const std::string& path) {
  std::ifstream in(path);
  if (!in) return std::nullopt;
  Mesh mesh;
  std::string line;
  while (std::getline(in, line)) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "v") {
      Vec3 p;
      words >> p.x >> p.y >> p.z;
      mesh.positions.push_back(p);
    } else if (word == "f") {
      std::vector<std::uint32_t> ids;
      while (words >> word) ids.push_back(static_cast<std::uint32_t>(std::stoul(word) - 1));
      for (std::size_t i = 2; i < ids.size(); ++i) mesh.triangles.push_back({ids[0], ids[i - 1], ids[i]});
    }
  }
  return mesh;
}

Mesh moved(Mesh mesh, double scale, const Vec3& offset) {
  for (Vec3& p : mesh.positions) p = scale * p + offset;
  return mesh;
}

Mesh normalised(Mesh mesh) {
  Aabb bounds;
  for (const Vec3& p : mesh.positions) bounds.grow(p);
  for (Vec3& p : mesh.positions) p = (p - bounds.center()) / bounds.diagonal();
  return mesh;
}

namespace {

using verify::Quad;

struct Quad3 {
  Quad x, y, z;
  explicit Quad3(const Vec3& v) : x(v.x), y(v.y), z(v.z) {}
  Quad3(Quad a, Quad b, Quad c) : x(a), y(b), z(c) {}
};
Quad3 operator-(const Quad3& a, const Quad3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
Quad dot(const Quad3& a, const Quad3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
Quad3 cross(const Quad3& a, const Quad3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Quad root(Quad v) {  // Newton on the double's root: three times the digits twice over
  Quad r = std::sqrt(static_cast<double>(v));
  for (int i = 0; i < 3 && r > 0; ++i) r = (r + v / r) / 2;
  return r;
}
Quad magnitude(Quad v) {
  return v < 0 ? -v : v;
}

// How far from an edge (in barycentric units), from a tangent or between two hits (relative) the oracle still
// vouches for double precision: the scenes below have coordinates up to 10 and triangles from 0.01 on, which
// leaves 1e-16 * 1e3.
constexpr double margin = 1e-11;

struct Candidate {
  Quad t = 0;
  bool hit = false, doubtful = false;
};

Candidate oracle_triangle(const World& world, std::uint32_t id, const Ray& ray) {
  const auto [a, b, c] = world.corners(id);
  const Quad3 e1 = Quad3(b) - Quad3(a), e2 = Quad3(c) - Quad3(a), d(ray.direction),
              s = Quad3(ray.origin) - Quad3(a);
  const Quad3 p = cross(d, e2);
  const Quad det = dot(e1, p);
  if (det == 0) return {};
  const Quad u = dot(s, p) / det, v = dot(d, cross(s, e1)) / det, t = dot(e2, cross(s, e1)) / det;
  const Quad inside = std::min({u, v, 1 - u - v});
  const Quad grazing = magnitude(det) / root(dot(cross(e1, e2), cross(e1, e2)) * dot(d, d));
  const bool doubtful = magnitude(inside) * grazing < Quad(margin) || magnitude(t) < Quad(margin);
  return {t, inside >= 0 && t > 0, doubtful};
}

Candidate oracle_sphere(const Sphere& sphere, const Ray& ray) {
  const Quad3 o = Quad3(ray.origin) - Quad3(sphere.center), d(ray.direction);
  const Quad a = dot(d, d), b = dot(o, d), c = dot(o, o) - Quad(sphere.radius) * Quad(sphere.radius);
  const Quad discriminant = b * b - a * c;
  const bool doubtful =
      magnitude(discriminant) < Quad(margin) * a * dot(o, o) || magnitude(c) < Quad(margin) * dot(o, o);
  if (discriminant < 0) return {0, false, doubtful};
  const Quad near = (-b - root(discriminant)) / a, far = (-b + root(discriminant)) / a;
  return {near > 0 ? near : far, far > 0, doubtful};
}

}  // namespace

OracleHit oracle_closest(const World& world, const Ray& ray) {
  OracleHit best;
  Quad best_t = 0;
  bool doubtful = false;
  for (std::uint32_t id = 0; id < world.primitive_count(); ++id) {
    const Candidate c = world.is_triangle(id)
                            ? oracle_triangle(world, id, ray)
                            : oracle_sphere(std::get<Sphere>(world.shape(id).geometry), ray);
    doubtful = doubtful || c.doubtful;
    if (!c.hit) continue;
    const bool tie =
        best.primitive != no_id && magnitude(c.t - best_t) < Quad(margin) * (1 + magnitude(best_t));
    doubtful = doubtful || tie;
    if (best.primitive == no_id || c.t < best_t) best_t = c.t, best.primitive = id;
  }
  best.t = static_cast<double>(best_t);
  best.doubtful = doubtful;
  return best;
}

}  // namespace gnomon::test
