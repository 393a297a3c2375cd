// The building blocks of mesh_builder.h. Round shapes index their ring positions modulo the ring's length, so
// that the seam closes on bitwise equal positions.
#include "scene/generate/mesh_builder.h"

#include <glm/gtc/matrix_transform.hpp>

namespace gnomon {
namespace {

// Newell's method: robust for any flat polygon, however its first corners lie.
Vec3 area_normal(std::span<const Vec3> corners) {
  Vec3 sum{0.0};
  for (std::size_t i = 0; i < corners.size(); ++i)
    sum += glm::cross(corners[i], corners[(i + 1) % corners.size()]);
  return sum;
}

// The two world axes that the face is most along, so that bricks and planks stay level.
Vec2 face_uv(const Vec3& p, const Vec3& n) {
  const Vec3 a = glm::abs(n);
  if (a.y >= a.x && a.y >= a.z) return {p.x, p.z};
  if (a.x >= a.z) return {p.z, -p.y};
  return {p.x, -p.y};
}

std::vector<Vec3> lift(std::span<const Vec2> outline, double z, const Mat4& world_from_local) {
  std::vector<Vec3> ring;
  ring.reserve(outline.size());
  for (const Vec2& p : outline) ring.emplace_back(world_from_local * Vec4(p.x, p.y, z, 1.0));
  return ring;
}

Vec3 turned(double radius, double height, int step, int segments) {
  const double angle = 2.0 * pi * (step % segments) / segments;
  return {radius * std::cos(angle), height, -radius * std::sin(angle)};
}

// The profile's outward normal on the segment from a to b, as (radial, upward).
Vec2 segment_normal(const ProfilePoint& a, const ProfilePoint& b) {
  return glm::normalize(Vec2(b.height - a.height, a.radius - b.radius));
}

// The normal of segment k at its end `at`: shared with the neighbour unless there is a crease or an end.
Vec2 profile_normal(std::span<const ProfilePoint> profile, std::size_t k, std::size_t at) {
  const Vec2 own = segment_normal(profile[k], profile[k + 1]);
  if (profile[at].crease) return own;
  if (at == k && k > 0) return glm::normalize(own + segment_normal(profile[k - 1], profile[k]));
  if (at == k + 1 && k + 2 < profile.size()) {
    return glm::normalize(own + segment_normal(profile[k + 1], profile[k + 2]));
  }
  return own;
}

}  // namespace

std::uint32_t MeshBuilder::vertex(const Vec3& position, const Vec3& normal, const Vec2& uv) {
  mesh_.positions.push_back(position);
  mesh_.normals.emplace_back(normal);
  mesh_.uvs.emplace_back(uv);
  return static_cast<std::uint32_t>(mesh_.positions.size() - 1);
}

void MeshBuilder::triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  mesh_.triangles.push_back({a, b, c});
}

void MeshBuilder::polygon(std::span<const Vec3> corners) {
  const Vec3 n = glm::normalize(area_normal(corners));
  const auto first = static_cast<std::uint32_t>(mesh_.positions.size());
  for (const Vec3& p : corners) vertex(p, n, face_uv(p, n));
  for (std::uint32_t i = 2; i < corners.size(); ++i) triangle(first, first + i - 1, first + i);
}

void MeshBuilder::quad(const std::array<Vec3, 4>& corners) {
  polygon(corners);
}

void MeshBuilder::loft(std::span<const std::vector<Vec3>> rings) {
  const std::size_t n = rings.front().size();
  for (std::size_t r = 0; r + 1 < rings.size(); ++r) {
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t j = (i + 1) % n;
      quad({rings[r][i], rings[r][j], rings[r + 1][j], rings[r + 1][i]});
    }
  }
  polygon(rings.back());
  const std::vector<Vec3> bottom(rings.front().rbegin(), rings.front().rend());
  polygon(bottom);
}

void MeshBuilder::box(const Vec3& min, const Vec3& max, double bevel) {
  const auto corner = [&](int i) {
    return Vec3(i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z);
  };
  // Each vertex of a chamfered box lies on one face, drawn in along the face's two edges.
  const auto on_face = [&](int i, int axis) {
    Vec3 p = corner(i);
    for (int a = 0; a < 3; ++a) {
      if (a != axis) p[a] += (i >> a & 1) ? -bevel : bevel;
    }
    return p;
  };
  constexpr std::array<std::array<int, 4>, 6> faces{
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
  for (int f = 0; f < 6; ++f) {
    std::array<Vec3, 4> c;
    for (int k = 0; k < 4; ++k) c[k] = on_face(faces[f][k], f / 2);
    quad(c);
    if (bevel <= 0.0) continue;
    // Chamfers: each edge is met from both of its faces; the lower axis draws it.
    for (int k = 0; k < 4; ++k) {
      const int a = faces[f][k], b = faces[f][(k + 1) % 4];
      const int along = (a ^ b) == 1 ? 0 : (a ^ b) == 2 ? 1 : 2;
      const int other = 3 - along - f / 2;
      if (f / 2 < other) quad({on_face(b, f / 2), on_face(a, f / 2), on_face(a, other), on_face(b, other)});
    }
  }
  if (bevel <= 0.0) return;
  for (int i = 0; i < 8; ++i) {
    const bool odd = ((i & 1) + (i >> 1 & 1) + (i >> 2 & 1)) % 2 == 1;
    const std::array<Vec3, 3> c{on_face(i, 0), on_face(i, odd ? 1 : 2), on_face(i, odd ? 2 : 1)};
    polygon(c);
  }
}

void MeshBuilder::prism(std::span<const Vec2> outline, double back, double front, double bevel,
                        const Mat4& world_from_local) {
  std::vector<std::vector<Vec3>> rings;
  const std::vector<Vec2> cap = bevel > 0.0 ? inset(outline, bevel) : std::vector<Vec2>{};
  if (bevel > 0.0) rings.push_back(lift(cap, back, world_from_local));
  rings.push_back(lift(outline, back + bevel, world_from_local));
  rings.push_back(lift(outline, front - bevel, world_from_local));
  if (bevel > 0.0) rings.push_back(lift(cap, front, world_from_local));
  loft(rings);
}

void MeshBuilder::lathe(std::span<const ProfilePoint> profile, int segments) {
  double along = 0.0;
  for (std::size_t k = 0; k + 1 < profile.size(); ++k) {
    const ProfilePoint &a = profile[k], &b = profile[k + 1];
    const double next = along + glm::length(Vec2(b.radius - a.radius, b.height - a.height));
    const Vec2 na = profile_normal(profile, k, k), nb = profile_normal(profile, k, k + 1);
    const double widest = 2.0 * pi * std::max(a.radius, b.radius);
    const auto first = static_cast<std::uint32_t>(mesh_.positions.size());
    for (int s = 0; s <= segments; ++s) {
      const Vec3 out = turned(1.0, 0.0, s, segments);
      const double u = widest * s / segments;
      vertex(turned(a.radius, a.height, s, segments), Vec3(na.x * out.x, na.y, na.x * out.z), {u, -along});
      vertex(turned(b.radius, b.height, s, segments), Vec3(nb.x * out.x, nb.y, nb.x * out.z), {u, -next});
    }
    for (int s = 0; s < segments; ++s) {
      const std::uint32_t low = first + 2u * static_cast<std::uint32_t>(s);
      if (a.radius > 0.0) triangle(low, low + 2, low + 1);
      if (b.radius > 0.0) triangle(low + 2, low + 3, low + 1);
    }
    along = next;
  }
}

void MeshBuilder::tube(std::span<const Vec3> centers, std::span<const double> radii, int sides) {
  std::vector<std::vector<Vec3>> rings;
  Vec3 side{0.0};
  double along = 0.0;
  const auto n = static_cast<std::uint32_t>(sides);
  const auto first = static_cast<std::uint32_t>(mesh_.positions.size());
  for (std::size_t r = 0; r < centers.size(); ++r) {
    const Vec3 before = r == 0 ? centers[1] - centers[0] : centers[r] - centers[r - 1];
    const Vec3 after = r + 1 == centers.size() ? before : centers[r + 1] - centers[r];
    const Vec3 t = glm::normalize(glm::normalize(before) + glm::normalize(after));
    // Parallel transport: the frame turns as little as it can.
    Vec3 b;
    if (r == 0) orthonormal_basis(t, side, b);
    side = glm::normalize(side - t * glm::dot(side, t));
    b = glm::cross(t, side);
    std::vector<Vec3> ring;
    for (int s = 0; s <= sides; ++s) {
      const double angle = 2.0 * pi * (s % sides) / sides;
      const Vec3 out = std::cos(angle) * side + std::sin(angle) * b;
      const Vec3 p = centers[r] + radii[r] * out;
      vertex(p, out, {2.0 * pi * radii.front() * s / sides, -along});
      if (s < sides) ring.push_back(p);
    }
    along += glm::length(after);
    if (r == 0 || r + 1 == centers.size()) rings.push_back(std::move(ring));
  }
  for (std::uint32_t r = 0; r + 1 < centers.size(); ++r) {
    for (std::uint32_t s = 0; s < n; ++s) {
      const std::uint32_t low = first + r * (n + 1) + s, high = low + n + 1;
      triangle(low, low + 1, high + 1);
      triangle(low, high + 1, high);
    }
  }
  polygon(rings.back());
  const std::vector<Vec3> bottom(rings.front().rbegin(), rings.front().rend());
  polygon(bottom);
}

void MeshBuilder::append(const Mesh& mesh, const Mat4& world_from_mesh) {
  const auto first = static_cast<std::uint32_t>(mesh_.positions.size());
  const Mat3 turn = glm::transpose(glm::inverse(Mat3(world_from_mesh)));  // takes normals to normals
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    vertex(Vec3(world_from_mesh * Vec4(mesh.positions[i], 1.0)), glm::normalize(turn * Vec3(mesh.normals[i])),
           Vec2(mesh.uvs[i]));
  }
  for (const auto& t : mesh.triangles) triangle(first + t[0], first + t[1], first + t[2]);
}

std::vector<Vec2> inset(std::span<const Vec2> convex_outline, double distance) {
  const std::size_t n = convex_outline.size();
  std::vector<Vec2> out;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2& p = convex_outline[i];
    const Vec2 before = glm::normalize(p - convex_outline[(i + n - 1) % n]);
    const Vec2 after = glm::normalize(convex_outline[(i + 1) % n] - p);
    // The point at `distance` to the left of both edges.
    const Vec2 left_before{-before.y, before.x}, left_after{-after.y, after.x};
    out.push_back(p + (left_before + left_after) * (distance / (1.0 + glm::dot(left_before, left_after))));
  }
  return out;
}

std::vector<Vec2> arc(const Vec2& center, double radius, double from, double to, int count) {
  std::vector<Vec2> points;
  for (int i = 0; i <= count; ++i) {
    const double angle = from + (to - from) * i / count;
    points.push_back(center + radius * Vec2(std::cos(angle), std::sin(angle)));
  }
  return points;
}

}  // namespace gnomon
