// What light does at a surface. An answer may be off by a thousandth of a direction's length or of all light: single precision
// leaves it within a tenth of that, away from the angle of total reflection, which no case comes near.
#include <cmath>

#include "studies/functions/make_questions.h"
#include "studies/functions/parts.h"

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
    q.group(name);
    for (int i = 0; i < 2 * of_each; ++i) {
      const Vec3 normal = dice.direction();
      q.add(stretch * arriving(dice, normal, dice.between(from, to)), normal);
    }
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
  const auto group = [&](std::string_view name, double from, double to, double n1, double n2) {
    q.group(name);
    for (int i = 0; i < 2 * of_each; ++i) {
      const Vec3 normal = dice.direction();
      q.add(arriving(dice, normal, dice.between(from, to)), normal, n1, n2);
    }
  };
  group("in", 0.3, 1.2, 1.0, 1.5);
  group("out", 0.3, 0.65, 1.5, 1.0);
  group("straight", 0.0, 0.0, 1.0, 1.5);
  group("same", 0.3, 1.2, 1.3, 1.3);
  q.group("total");
  for (int i = 0; i < of_each; ++i) {
    const Vec3 normal = dice.direction();
    q.add(arriving(dice, normal, dice.between(0.8, 1.4)), normal, 1.5, 1.0);
    q.add(arriving(dice, normal, dice.between(0.3, 0.65)), normal, 1.5, 1.0);
  }
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
  const auto group = [&](std::string_view name, double from, double to, double n1, double n2) {
    q.group(name);
    for (int i = 0; i < 2 * of_each; ++i) q.add(std::cos(dice.between(from, to)), n1, n2);
  };
  group("in", 0.6, 1.2, 1.0, 1.5);
  group("out", 0.3, 0.65, 1.5, 1.0);
  group("straight", 0.0, 0.0, 1.0, 2.4);
  group("grazing", 1.4, 1.55, 1.0, 1.5);
  q.group("total");
  for (int i = 0; i < of_each; ++i) {
    q.add(std::cos(dice.between(0.8, 1.4)), 1.5, 1.0);
    q.add(std::cos(dice.between(0.5, 0.65)), 1.5, 1.0);
  }
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

}  // namespace

const std::vector<Function>& light_functions() {
  static const std::vector<Function> rows = {
      {"reflection", "answer = vec4(reflection(case_vector(0), case_vector(3)), 0.0)", 6,
       AnswerKind::direction, reflection_questions, reflection_right, reflection_words},
      {"refraction",
       "answer = vec4(refraction(case_vector(0), case_vector(3), case_number(6), case_number(7)), 0.0)", 8,
       AnswerKind::direction, refraction_questions, refraction_right, refraction_words},
      {"fresnel", "answer = vec4(fresnel(case_number(0), case_number(1), case_number(2)))", 3,
       AnswerKind::number, fresnel_questions, fresnel_right, fresnel_words}};
  return rows;
}

}  // namespace gnomon::functions
