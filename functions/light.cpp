// What light does at a surface. An answer may be off by a thousandth of a direction's length or of all light. Single precision
// leaves it within a tenth of that, away from the angle of total reflection, which no case comes near.
#include <cmath>

#include "functions/make_questions.h"
#include "functions/parts.h"

namespace gnomon::functions {
namespace {

constexpr double off_by = 1e-3;

/// A direction that arrives at a surface of this normal at an angle, radians.
Vec3 arriving(Dice& dice, const Vec3& normal, double angle) {
  Vec3 right, up;
  orthonormal_basis(normal, right, up);
  const double turn = dice.between(0.0, 2.0 * pi);
  const Vec3 along = std::cos(turn) * right + std::sin(turn) * up;
  return std::sin(angle) * along - std::cos(angle) * normal;
}

/// Adds the picture: add(direction, normal) for a sphere of radius 1.3; beside it the normal looks at the eye.
template <class Add>
void add_sphere_picture(Questions& q, const Add& add) {
  add_picture(q, [&](const Vec3& eye, const Vec3& to) {
    const double b = glm::dot(eye, to), c = glm::dot(eye, eye) - 1.3 * 1.3, discriminant = b * b - c;
    const Vec3 normal = discriminant > 0.0 ? glm::normalize(eye - (b + std::sqrt(discriminant)) * to) : -to;
    add(to, normal);
  });
}

// ---- reflection ----

std::vector<Question> reflection_questions() {
  Questions q;
  Dice dice(6);
  const auto group = [&](std::string_view name, double from, double to, double stretch = 1.0) {
    q.group(name, 2 * of_each, [&](int) {
      const Vec3 normal = dice.direction();
      q.add(stretch * arriving(dice, normal, dice.between(from, to)), normal);
    });
  };
  group("slanted", 0.4, 1.2);
  group("straight", 0.0, 0.0);
  group("grazing", 1.5, 1.56);
  group("back", pi - 1.2, pi - 0.4);
  group("length", 0.4, 1.2, 2.5);
  add_sphere_picture(q, [&](const Vec3& to, const Vec3& normal) { q.add(to, normal); });
  return q.take();
}

Right reflection_right(Numbers n) {
  const Vec3 direction = vector_at(n, 0), normal = vector_at(n, 3);
  const Vec3 out = direction - 2.0 * glm::dot(direction, normal) * normal;
  return {{out.x, out.y, out.z}, off_by * std::max(1.0, glm::length(direction)), {}};
}

std::string reflection_words(Numbers n) {
  return fmt::format("the direction {} at the normal {}", words_of(vector_at(n, 0)),
                     words_of(vector_at(n, 3)));
}

// ---- refraction ----

std::vector<Question> refraction_questions() {
  Questions q;
  Dice dice(7);
  const auto add = [&](double from, double to, double n1, double n2) {
    const Vec3 normal = dice.direction();
    q.add(arriving(dice, normal, dice.between(from, to)), normal, n1, n2);
  };
  const auto group = [&](std::string_view name, double from, double to, double n1, double n2) {
    q.group(name, 2 * of_each, [&](int) { add(from, to, n1, n2); });
  };
  group("in", 0.3, 1.2, 1.0, 1.5);
  group("out", 0.3, 0.65, 1.5, 1.0);
  group("straight", 0.0, 0.0, 1.0, 1.5);
  group("same", 0.3, 1.2, 1.3, 1.3);
  q.group("total", of_each, [&](int) {
    add(0.8, 1.4, 1.5, 1.0);
    add(0.3, 0.65, 1.5, 1.0);
  });
  add_sphere_picture(q, [&](const Vec3& to, const Vec3& normal) { q.add(to, normal, 1.5, 1.0); });
  return q.take();
}

Right refraction_right(Numbers n) {
  const Vec3 direction = vector_at(n, 0), normal = vector_at(n, 3);
  const double eta = double(n[6]) / n[7], cosine = -glm::dot(direction, normal);
  const double rest = 1.0 - eta * eta * (1.0 - cosine * cosine);
  if (rest < 0.0) return {{0.0, 0.0, 0.0}, off_by, "total reflection: nothing passes"};
  const Vec3 out = eta * direction + (eta * cosine - std::sqrt(rest)) * normal;
  return {{out.x, out.y, out.z}, off_by, {}};
}

std::string refraction_words(Numbers n) {
  return fmt::format("the direction {} at the normal {}, from index {:.4g} to {:.4g}",
                     words_of(vector_at(n, 0)), words_of(vector_at(n, 3)), n[6], n[7]);
}

// ---- Fresnel ----

std::vector<Question> fresnel_questions() {
  Questions q;
  Dice dice(8);
  const auto add = [&](double from, double to, double n1, double n2) {
    q.add(std::cos(dice.between(from, to)), n1, n2);
  };
  const auto group = [&](std::string_view name, double from, double to, double n1, double n2) {
    q.group(name, 2 * of_each, [&](int) { add(from, to, n1, n2); });
  };
  group("in", 0.6, 1.2, 1.0, 1.5);
  group("out", 0.3, 0.65, 1.5, 1.0);
  group("straight", 0.0, 0.0, 1.0, 2.4);
  group("grazing", 1.4, 1.55, 1.0, 1.5);
  q.group("total", of_each, [&](int) {
    add(0.8, 1.4, 1.5, 1.0);
    add(0.5, 0.65, 1.5, 1.0);
  });
  add_sphere_picture(q, [&](const Vec3& to, const Vec3& normal) { q.add(-glm::dot(to, normal), 1.0, 1.5); });
  return q.take();
}

/// Born and Wolf, Principles of Optics, 1.5.2: the mean of both polarisations.
Right fresnel_right(Numbers n) {
  const double cosine = n[0], n1 = n[1], n2 = n[2];
  const double sine2 = n1 / n2 * std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  if (sine2 >= 1.0) return {{1.0}, off_by, "total reflection: all of it"};
  const double cosine2 = std::sqrt(1.0 - sine2 * sine2);
  const double across = (n1 * cosine - n2 * cosine2) / (n1 * cosine + n2 * cosine2);
  const double along = (n2 * cosine - n1 * cosine2) / (n2 * cosine + n1 * cosine2);
  return {{0.5 * (across * across + along * along)}, off_by, {}};
}

std::string fresnel_words(Numbers n) {
  return fmt::format("a cosine of {:.4g}, from index {:.4g} to {:.4g}", n[0], n[1], n[2]);
}

// ---- the ray to a light ----

/// Which part of the ray a case asks for.
constexpr int part_begin = 0, part_direction = 1, part_end = 2;
int part_of(Numbers n) {
  return static_cast<int>(n[11]);
}
constexpr double no_end = 1e30;  ///< of a sun's ray

/// A light at an angle (radians) from the normal, `distance` away; a sun's direction is that long.
void add_light(Questions& q, Dice& dice, double side, double offset, double distance, bool is_sun, int part) {
  const Vec3 normal = dice.direction(), point = dice.in_cube(2.0);
  const Vec3 to_light = -distance * arriving(dice, normal, dice.between(0.3, 1.1));
  q.add(point, side * normal, is_sun ? to_light : point + to_light, is_sun ? 0.0 : 1.0, offset, part);
}

std::vector<Question> shadow_questions() {
  Questions q;
  Dice dice(9);
  const auto lamps = [&](std::string_view name, int part) {
    q.group(name, 2 * of_each,
            [&](int) { add_light(q, dice, 1.0, 0.05, dice.between(2.0, 4.0), false, part); });
  };
  lamps("begin", part_begin);
  lamps("direction", part_direction);
  lamps("end", part_end);
  const auto all_parts = [&](std::string_view name, double side, double offset, double distance,
                             bool is_sun) {
    q.group(name, 3 * of_each, [&](int i) { add_light(q, dice, side, offset, distance, is_sun, i % 3); });
  };
  all_parts("back", -1.0, 0.05, 3.0, false);
  all_parts("near", 1.0, 0.1, 0.6, false);
  all_parts("far", 1.0, 0.5, 400.0, false);
  all_parts("sun", 1.0, 0.05, 2.5, true);
  add_sphere_picture(q, [&](const Vec3&, const Vec3& normal) {
    q.add(1.3 * normal, normal, Vec3(2.0, 3.0, 4.0), 1.0, 0.05, part_direction);
  });
  return q.take();
}

Right shadow_right(Numbers n) {
  const Vec3 point = vector_at(n, 0), normal = vector_at(n, 3), light = vector_at(n, 6);
  const bool is_sun = n[9] == 0.0f;
  const double side = glm::dot(normal, is_sun ? light : light - point) < 0.0 ? -1.0 : 1.0;
  const Vec3 begin = point + side * n[10] * normal, way = is_sun ? light : light - begin;
  const double end = is_sun ? no_end : glm::length(way);
  const Vec3 to = glm::normalize(way);
  if (part_of(n) == part_end) return {{end}, off_by * std::max(1.0, end), {}};
  if (part_of(n) == part_direction) return {{to.x, to.y, to.z}, off_by, {}};
  // Nearer than any small number that stands for the offset.
  return {
      {begin.x, begin.y, begin.z}, 0.2 * off_by, side < 0.0 ? "the normal points away from the light" : ""};
}

std::string shadow_words(Numbers n) {
  return fmt::format("from {} with the normal {} to the {} {}, offset {:.4g}", words_of(vector_at(n, 0)),
                     words_of(vector_at(n, 3)), n[9] == 0.0f ? "sun towards" : "lamp at",
                     words_of(vector_at(n, 6)), n[10]);
}

std::string shadow_value_words(Numbers n, const Value& value) {
  if (part_of(n) == part_end)
    return value[0] >= no_end ? "a ray without an end" : fmt::format("the ray's end at {:.4g}", value[0]);
  return fmt::format("the ray's {} {}", part_of(n) == part_begin ? "begin" : "direction",
                     words_of({value[0], value[1], value[2]}));
}

}  // namespace

const std::vector<Function>& light_functions() {
  static const std::vector<Function> rows = {
      {"reflection", "answer = vec4(reflection(case_vector(0), case_vector(3)), 0.0)", 6,
       AnswerKind::direction, reflection_questions, reflection_right, reflection_words},
      {"refraction",
       "answer = vec4(refraction(case_vector(0), case_vector(3), case_number(6), case_number(7)), 0.0)", 8,
       AnswerKind::direction, refraction_questions, refraction_right, refraction_words},
      {"fresnel", "answer = vec4(fresnel(case_number(0), case_number(1), case_number(2)))", 3,
       AnswerKind::number, fresnel_questions, fresnel_right, fresnel_words},
      {"shadow_ray",
       "vec3 begin, to; float end; "
       "shadow_ray(case_vector(0), case_vector(3), vec4(case_vector(6), case_number(9)), case_number(10), "
       "begin, to, end); "
       "int part = int(case_number(11)); "
       "answer = vec4(part == 0 ? begin : part == 1 ? to : vec3(end >= 1e20 ? 1e30 : end, 0.0, 0.0), 0.0)",
       12, AnswerKind::several, shadow_questions, shadow_right, shadow_words, shadow_value_words}};
  return rows;
}

}  // namespace gnomon::functions
