// The ray through a pixel. A direction may be off by a thousandth: single precision leaves it within a tenth of that.
#include <cmath>

#include "functions/make_questions.h"
#include "functions/parts.h"

namespace gnomon::functions {
namespace {

std::vector<Question> eye_questions() {
  Questions q;
  Dice dice(5);
  const auto add = [&](double x, double y, double width, double height, double degrees) {
    const Vec3 forward = dice.direction(), right = glm::normalize(glm::cross(forward, Vec3(0.0, 1.0, 0.0)));
    q.add(x, y, width, height, degrees, right, glm::cross(right, forward), forward);
  };
  q.group("square", 2 * of_each, [&](int i) { add(i, 2 * i, 24.0, 24.0, 60.0); });
  q.group("wide", 2 * of_each, [&](int i) { add(i * 5, i, 64.0, 12.0, 40.0); });
  q.group("tall", 2 * of_each, [&](int i) { add(i, i * 4, 12.0, 48.0, 75.0); });
  q.group("corners");
  for (const double angle : {30.0, 90.0, 120.0})
    for (const double y : {0.0, 3.0})
      for (const double x : {0.0, 7.0}) add(x, y, 8.0, 4.0, angle);
  q.group("one", of_each, [&](int i) { add(0.0, 0.0, 1.0, 1.0, 20.0 + 15.0 * i); });
  q.group(picture_group);
  for (int y = 0; y < picture_height; ++y)
    for (int x = 0; x < picture_width; ++x)
      q.add(x, y, picture_width, picture_height, 60.0, Vec3(1.0, 0.0, 0.0), Vec3(0.0, 1.0, 0.0),
            Vec3(0.0, 0.0, -1.0));
  return q.take();
}

Right eye_right(Numbers n) {
  const double width = n[2], height = n[3], half = std::tan(0.5 * n[4] * pi / 180.0);
  const double x = (2.0 * (n[0] + 0.5) / width - 1.0) * half * width / height;
  const double y = (1.0 - 2.0 * (n[1] + 0.5) / height) * half;
  const Vec3 to = glm::normalize(vector_at(n, 11) + x * vector_at(n, 5) + y * vector_at(n, 8));
  return {{to.x, to.y, to.z}, 1e-3, {}};
}

std::string eye_words(Numbers n) {
  return fmt::format("pixel ({:g}, {:g}) of {:g} x {:g}, {:g} degrees high, looking along {}", n[0], n[1],
                     n[2], n[3], n[4], words_of(vector_at(n, 11)));
}

}  // namespace

const std::vector<Function>& eye_functions() {
  static const std::vector<Function> rows = {
      {"eye_ray",
       "answer = vec4(eye_ray(vec2(case_number(0), case_number(1)), vec2(case_number(2), case_number(3)), "
       "case_number(4), case_vector(5), case_vector(8), case_vector(11)), 0.0)",
       14, AnswerKind::direction, eye_questions, eye_right, eye_words}};
  return rows;
}

}  // namespace gnomon::functions
