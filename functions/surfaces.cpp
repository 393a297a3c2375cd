// Rays against surfaces. A place on a ray may be off by a thousandth of the way (or of 1). Single precision leaves it within a
// tenth of that in every case here by any of the usual formulas, and the usual mistakes are farther off.
#include "functions/parts.h"

#include <cmath>

#include "functions/make_questions.h"

namespace gnomon::functions {
namespace {

Right hit_at(double t, std::string because = {}) {
  return {{t}, 1e-3 * std::max(1.0, std::abs(t)), std::move(because)};
}

/// From outside towards a point, from `distance` away.
Ray ray_to(const Vec3& point, const Vec3& from_where, double distance) {
  return {point + distance * from_where, -from_where};
}

// ---- a sphere ----

void add_sphere(Questions& q, const Ray& ray, const Vec3& center, double radius) {
  q.add(ray.origin, ray.direction, center, radius);
}

/// A ray that passes the center in `share` radii, from `distance` radii away.
Ray ray_past(Dice& dice, const Vec3& center, double radius, double share, double distance) {
  const Vec3 back = dice.direction();
  Vec3 side, other;
  orthonormal_basis(back, side, other);
  return ray_to(center + share * radius * side, back, distance * radius);
}

std::vector<Question> sphere_questions() {
  Questions q;
  Dice dice(1);
  const auto past = [&](double share, double distance, double stretch = 1.0, double radius = 0.0) {
    const Vec3 center = dice.in_cube(2.0);
    const double r = radius > 0.0 ? radius : dice.between(0.5, 2.0);
    Ray ray = ray_past(dice, center, r, share, distance);
    ray.direction *= stretch;
    add_sphere(q, ray, center, r);
  };
  const auto pairs = [&](std::string_view name, const auto& one, const auto& other) {
    q.group(name, of_each, [&](int) { one(), other(); });
  };
  pairs(
      "front", [&] { past(dice.between(0.0, 0.8), 4.0); }, [&] { past(dice.between(1.3, 3.0), 4.0); });
  pairs(
      "length", [&] { past(0.45, 4.0, 2.5); }, [&] { past(0.3, 4.0, 0.25); });
  pairs(
      "inside", [&] { past(0.4, 0.5); }, [&] { past(0.4, -0.5); });
  pairs(
      "behind", [&] { past(0.4, -4.0); }, [&] { past(0.4, 4.0); });
  pairs(
      "grazing", [&] { past(0.97, 4.0); }, [&] { past(1.03, 4.0); });
  pairs(
      "tiny", [&] { past(0.45, 50.0, 1.0, 0.01); },
      [&] {
        past(1.5, 50.0, 1.0, 0.01);
        past(0.4, -0.5, 1.0, 0.01);  // begins inside: 0.004 is a place before it
        past(0.4, 1.6, 1.0, 0.01);   // begins close before it, and meets it at 0.007
      });
  pairs(
      "far", [&] { past(0.45, 40.0, 1.0, 10.0); }, [&] { past(1.5, 40.0, 1.0, 10.0); });
  add_picture(q, [&](const Vec3& eye, const Vec3& to) { add_sphere(q, {eye, to}, {0.0, 0.0, 0.0}, 1.1); });
  return q.take();
}

std::string sphere_words(Numbers n) {
  return fmt::format("{} and the sphere of radius {:.4g} around {}", ray_words(n), n[9],
                     words_of(vector_at(n, 6)));
}

// ---- a plane ----

std::vector<Question> plane_questions() {
  Questions q;
  Dice dice(4);
  const auto add = [&](const Ray& ray, const Vec3& point, const Vec3& normal) {
    q.add(ray.origin, ray.direction, point, normal);
  };
  const auto group = [&](std::string_view name, double side, double stretch, double normal_length) {
    q.group(name, of_each, [&](int) {
      const Vec3 normal = dice.direction(), point = dice.in_cube(2.0);
      const Vec3 from = glm::normalize(side * normal + 0.5 * dice.direction());
      Ray ray = ray_to(point, from, dice.between(1.0, 4.0));
      ray.direction *= stretch;
      add(ray, point, normal_length * normal);
      ray.direction *= -1.0;
      add(ray, point, normal_length * normal);
    });
  };
  group("front", 1.0, 1.0, 1.0);
  group("back", -1.0, 1.0, 1.0);
  group("length", 1.0, 2.5, 1.0);
  group("normal", 1.0, 1.0, 3.0);
  q.group("parallel", of_each, [&](int) {
    const double y = std::round(dice.between(-3.0, 3.0));
    // Above, below and in the plane: without a test of the slant t is -infinity, infinity and no number.
    for (const double height : {1.0, -1.0, 0.0})
      add({{-1.0, y + height, 2.0}, {0.6, 0.0, -0.8}}, {1.0, y, 0.0}, {0.0, 1.0, 0.0});
    // As flat as a third of a degree: a hit, and no parallel ray.
    add({{-1.0, y + 1.0, 2.0}, glm::normalize(Vec3(0.6, -0.006, -0.8))}, {1.0, y, 0.0}, {0.0, 1.0, 0.0});
  });
  add_picture(q, [&](const Vec3& eye, const Vec3& to) { add({eye, to}, {0.0, -0.8, 0.0}, {0.1, 1.0, 0.2}); });
  return q.take();
}

Right plane_right(Numbers n) {
  const Vec3 direction = vector_at(n, 3), normal = vector_at(n, 9);
  const double slant = glm::dot(direction, normal),
               apart = glm::dot(vector_at(n, 6) - vector_at(n, 0), normal);
  if (slant == 0.0) return no_hit("the ray is parallel to the plane");
  return apart / slant < 0.0 ? no_hit("the plane is behind the ray") : hit_at(apart / slant);
}

std::string plane_words(Numbers n) {
  return fmt::format("{} and the plane through {} of normal {}", ray_words(n), words_of(vector_at(n, 6)),
                     words_of(vector_at(n, 9)));
}

// ---- a triangle ----

struct Corners {
  Vec3 a, b, c;
  Vec3 at(double u, double v) const { return a + u * (b - a) + v * (c - a); }
  Vec3 normal() const { return glm::normalize(glm::cross(b - a, c - a)); }
};

void add_triangle(Questions& q, const Ray& ray, const Corners& t) {
  q.add(ray.origin, ray.direction, t.a, t.b, t.c);
}

/// Of sides from one to two times `size`, angles well away from 0.
Corners some_triangle(Dice& dice, double size) {
  const Vec3 normal = dice.direction();
  Vec3 right, up;
  orthonormal_basis(normal, right, up);
  const Vec3 a = dice.in_cube(1.0);
  return {a, a + size * dice.between(1.2, 1.9) * right,
          a + size * (dice.between(0.2, 0.9) * right + dice.between(1.1, 1.7) * up)};
}

/// A ray of length 1 that meets the plane at u and v, from the side that the normal points to (or the other), not flat.
Ray ray_at(Dice& dice, const Corners& t, double u, double v, double distance, double side = 1.0) {
  const Vec3 from = glm::normalize(side * t.normal() + 0.5 * dice.direction());
  return ray_to(t.at(u, v), from, distance);
}

/// u and v of places next to each edge's middle, inside by `inset` (outside where it is negative).
constexpr double edge_places[3][4] = {{0.0, 0.4, 1.0, 0.0}, {0.4, 0.0, 0.0, 1.0}, {0.5, 0.5, -1.0, -1.0}};
/// The same of each vertex: outside of both edges that meet there.
constexpr double vertex_places[3][4] = {{0.0, 0.0, 1.0, 1.0}, {1.0, 0.0, -2.0, 1.0}, {0.0, 1.0, 1.0, -2.0}};

void add_beside(Questions& q, Dice& dice, const double (&places)[3][4], double inset) {
  for (const double(&place)[4] : places)
    for (int i = 0; i < of_each / 2; ++i)
      for (const double by : {inset, -inset}) {
        const Corners t = some_triangle(dice, 1.0);
        const double side = i % 2 == 0 ? 1.0 : -1.0;
        add_triangle(q, ray_at(dice, t, place[0] + by * place[2], place[1] + by * place[3], 3.0, side), t);
      }
}

/// In the plane of a triangle that lies along two axes, beside it and in it, where u, v and t are divided by 0.
void add_parallel(Questions& q, Dice& dice) {
  q.group("parallel");
  for (int i = 0; i < of_each; ++i) {
    const double z = std::round(dice.between(-3.0, 3.0));
    const Corners t{{-1.0, -1.0, z}, {2.0, -1.0, z}, {0.0, 2.0, z}};
    const double off = i % 3 == 0 ? 0.0 : 0.5;
    add_triangle(q, {{-4.0, 0.25, z + off}, {1.0, 0.0, 0.0}}, t);
    // As flat as one degree: a hit, and no parallel ray.
    add_triangle(q, {{-4.0, 0.0, z + 0.0698}, glm::normalize(Vec3(4.3, 0.1, -0.0698))}, t);
  }
}

std::vector<Question> triangle_questions() {
  Questions q;
  Dice dice(2);
  const auto pairs = [&](std::string_view name, double size, double distance, double stretch = 1.0) {
    q.group(name);
    for (int i = 0; i < of_each; ++i) {
      const double u = dice.between(0.15, 0.4), v = dice.between(0.15, 0.4);
      const double outside[3][2] = {{-u, v}, {u, -v}, {u + 0.5, v + 0.5}};
      const Corners t = some_triangle(dice, size);
      Ray in = ray_at(dice, t, u, v, distance),
          out = ray_at(dice, t, outside[i % 3][0], outside[i % 3][1], distance);
      in.direction *= stretch, out.direction *= stretch;
      add_triangle(q, in, t);
      add_triangle(q, out, t);
    }
  };
  pairs("middle", 1.0, 3.0);
  pairs("length", 1.0, 3.0, 2.5);
  q.group("edges");
  add_beside(q, dice, edge_places, 0.02);
  q.group("vertices");
  add_beside(q, dice, vertex_places, 0.01);
  for (const std::string_view name : {"behind", "back"}) {
    q.group(name);
    for (int i = 0; i < of_each; ++i) {
      const Corners t = some_triangle(dice, 1.0);
      Ray ray = ray_at(dice, t, 0.3, 0.3, 3.0, name == "back" ? -1.0 : 1.0);
      // Along the normal what is as far before the ray as the triangle is behind it lies over the triangle, too.
      if (name == "behind" && i % 2 == 0) ray = ray_to(t.at(0.3, 0.3), t.normal(), 3.0);
      add_triangle(q, ray, t);
      if (name == "behind") ray.direction *= -1.0;
      if (name == "back") ray = ray_at(dice, t, -0.3, 0.3, 3.0, -1.0);
      add_triangle(q, ray, t);
      if (name == "back") continue;
      // Beside the triangle and behind the ray: two signs that are wrong must not make it right.
      const double u = i % 2 == 0 ? 0.3 : -0.3;
      Ray beside = ray_at(dice, t, u, -0.3, 3.0);
      beside.direction *= -1.0;
      add_triangle(q, beside, t);
    }
  }
  add_parallel(q, dice);
  pairs("tiny", 0.005, 1.0);
  pairs("far", 10.0, 500.0);
  add_picture(q, [&](const Vec3& eye, const Vec3& to) {
    add_triangle(q, {eye, to}, {{-1.3, -0.9, 0.4}, {1.4, -0.6, -0.5}, {-0.1, 1.2, 0.2}});
  });
  return q.take();
}

Right triangle_right(Numbers n) {
  const Vec3 direction = vector_at(n, 3), a = vector_at(n, 6);
  const Vec3 to_b = vector_at(n, 9) - a, to_c = vector_at(n, 12) - a, from_a = vector_at(n, 0) - a;
  const Vec3 normal = glm::cross(to_b, to_c);
  const double determinant = -glm::dot(direction, normal);
  if (determinant == 0.0) return no_hit("the ray is parallel to the triangle's plane");
  const double t = glm::dot(from_a, normal) / determinant;
  const Vec3 crossed = glm::cross(from_a, direction);
  const double u = glm::dot(to_c, crossed) / determinant, v = -glm::dot(to_b, crossed) / determinant;
  const std::string place = fmt::format("u = {:.3g}, v = {:.3g}", u, v);
  if (u < 0.0 || v < 0.0 || u + v > 1.0) return no_hit("the ray passes the triangle, " + place);
  return t < 0.0 ? no_hit("the triangle is behind the ray") : hit_at(t, place);
}

std::string triangle_words(Numbers n) {
  return fmt::format("{} and the triangle {} {} {}", ray_words(n), words_of(vector_at(n, 6)),
                     words_of(vector_at(n, 9)), words_of(vector_at(n, 12)));
}

// ---- a box ----

void add_box(Questions& q, const Ray& ray, const Aabb& box) {
  q.add(ray.origin, ray.direction, box.min, box.max);
}

Aabb some_box(Dice& dice, double size) {
  const Vec3 low = dice.in_cube(1.0);
  return {low, low + size * Vec3(dice.between(0.8, 1.6), dice.between(0.8, 1.6), dice.between(0.8, 1.6))};
}

/// A ray that meets or misses by far: towards the box' middle, or towards a place beside it.
Ray ray_to_box(Dice& dice, const Aabb& box, bool meets, double distance) {
  const Vec3 back = dice.direction();
  Vec3 side, other;
  orthonormal_basis(back, side, other);
  const Vec3 to = box.center() + (meets ? 0.2 : 1.0) * box.diagonal() * side;
  return ray_to(to, back, distance * box.diagonal());
}

/// Along one axis: within the two other slabs, and beside one of them.
void add_axes(Questions& q, Dice& dice, std::string_view name, double where) {
  q.group(name);
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {1.0, -1.0}) {
      const Aabb box{{-1.0, -2.0, 0.5}, {1.0, 1.0, 2.0}};
      Vec3 origin = box.center(), direction(0.0);
      origin[axis] -= sign * 4.0, direction[axis] = sign;
      const int other = (axis + 1) % 3;
      origin[other] += where * 0.5 * box.extent()[other];
      add_box(q, {origin, direction}, box);
      origin[other] = box.max[other] + dice.between(0.2, 1.0);
      add_box(q, {origin, direction}, box);
      origin[other] = box.min[other] - dice.between(0.2, 1.0);
      add_box(q, {origin, direction}, box);
      if (where == 1.0) continue;
      // As flat as a third of a degree: it begins beside the slab, and is in it before it comes to the box.
      origin[other] = box.max[other] + 0.012, direction[other] = -0.006;
      add_box(q, {origin, glm::normalize(direction)}, box);
    }
}

std::vector<Question> box_questions() {
  Questions q;
  Dice dice(3);
  const auto pairs = [&](std::string_view name, double size, double distance, double stretch = 1.0) {
    q.group(name, 2 * of_each, [&](int i) {
      const Aabb box = some_box(dice, size);
      Ray ray = ray_to_box(dice, box, i % 2 == 0, distance);
      ray.direction *= stretch;
      add_box(q, ray, box);
    });
  };
  pairs("front", 1.0, 3.0);
  pairs("length", 1.0, 3.0, 2.5);
  q.group("inside", of_each, [&](int) {
    const Aabb box = some_box(dice, 1.0);
    add_box(q, ray_to(box.center() + dice.in_cube(0.1), dice.direction(), 0.1), box);
    add_box(q, ray_to_box(dice, box, true, 3.0), box);
  });
  q.group("behind", of_each, [&](int) {
    const Aabb box = some_box(dice, 1.0);
    add_box(q, ray_to_box(dice, box, true, -3.0), box);
    add_box(q, ray_to_box(dice, box, true, 3.0), box);
  });
  add_axes(q, dice, "axes", 0.5);
  add_axes(q, dice, "faces", 1.0);
  // Through a corner and past it: the way inside is short, and which slab is left first matters.
  for (int i = 0; i < of_each; ++i) {
    const Aabb box = some_box(dice, 1.0);
    for (const double inset : {0.03, -0.03}) {
      const Vec3 edge(box.max.x - inset, box.max.y - inset, box.center().z);
      add_box(q, ray_to(edge, glm::normalize(Vec3(1.0, -1.0, 0.1 * (i - 2.5))), 3.0), box);
    }
  }
  pairs("tiny", 0.01, 50.0);
  pairs("far", 10.0, 40.0);
  add_picture(q, [&](const Vec3& eye, const Vec3& to) {
    add_box(q, {eye, to}, {{-1.0, -0.6, -0.9}, {0.9, 0.7, 0.6}});
  });
  return q.take();
}

std::string box_words(Numbers n) {
  return fmt::format("{} and the box from {} to {}", ray_words(n), words_of(vector_at(n, 6)),
                     words_of(vector_at(n, 9)));
}

}  // namespace

Right sphere_right(Numbers n) {
  const Vec3 origin = vector_at(n, 0) - vector_at(n, 6), direction = vector_at(n, 3);
  const double radius = n[9], a = glm::dot(direction, direction), b = glm::dot(origin, direction);
  const double c = glm::dot(origin, origin) - radius * radius, discriminant = b * b - a * c;
  if (discriminant < 0.0) return no_hit("the ray passes the sphere");
  const double root = std::sqrt(discriminant);
  if (-b + root < 0.0) return no_hit("the sphere is behind the ray");
  if (-b - root < 0.0) return hit_at((-b + root) / a, "the ray begins inside");
  return hit_at((-b - root) / a);
}

Right box_right(Numbers n) {
  const Vec3 origin = vector_at(n, 0), direction = vector_at(n, 3), low = vector_at(n, 6),
             high = vector_at(n, 9);
  Interval inside{-infinity, infinity};
  for (int i = 0; i < 3; ++i) {
    const bool between = low[i] <= origin[i] && origin[i] <= high[i];
    if (direction[i] == 0.0 && !between)
      return no_hit(fmt::format("the ray runs beside the slab of {}", "xyz"[i]));
    if (direction[i] == 0.0) continue;
    const double first = (low[i] - origin[i]) / direction[i], second = (high[i] - origin[i]) / direction[i];
    inside.min = std::max(inside.min, std::min(first, second));
    inside.max = std::min(inside.max, std::max(first, second));
  }
  if (inside.empty()) return no_hit("the ray passes the box");
  if (inside.max < 0.0) return no_hit("the box is behind the ray");
  return inside.min < 0.0 ? hit_at(0.0, "the ray begins inside") : hit_at(inside.min);
}

const std::vector<Function>& surface_functions() {
  static const std::vector<Function> rows = {
      {"ray_sphere",
       "answer = vec4(ray_sphere(case_vector(0), case_vector(3), case_vector(6), case_number(9)))", 10,
       AnswerKind::place_on_ray, sphere_questions, sphere_right, sphere_words},
      {"ray_plane",
       "answer = vec4(ray_plane(case_vector(0), case_vector(3), case_vector(6), case_vector(9)))", 12,
       AnswerKind::place_on_ray, plane_questions, plane_right, plane_words},
      {"ray_triangle",
       "answer = vec4(ray_triangle(case_vector(0), case_vector(3), case_vector(6), case_vector(9), "
       "case_vector(12)))",
       15, AnswerKind::place_on_ray, triangle_questions, triangle_right, triangle_words},
      {"ray_box", "answer = vec4(ray_box(case_vector(0), case_vector(3), case_vector(6), case_vector(9)))",
       12, AnswerKind::place_on_ray, box_questions, box_right, box_words}};
  return rows;
}

}  // namespace gnomon::functions
