// The next cell of a grid that a ray enters, and where (Amanatides and Woo 1987). A case's numbers are the cell, the ray, the grid's
// low corner and the size of its cells.
#include <algorithm>
#include <cmath>

#include "functions/make_questions.h"
#include "functions/parts.h"

namespace gnomon::functions {
namespace {

Value value_of(const Vec3& v, double fourth) {
  return {v.x, v.y, v.z, fourth};
}

/// The t at which the ray leaves the cell along each axis; infinite along one that it does not move along.
Vec3 walls_of(Numbers n) {
  const Vec3 cell = vector_at(n, 0), origin = vector_at(n, 3), direction = vector_at(n, 6);
  const Vec3 low = vector_at(n, 9), size = vector_at(n, 12);
  Vec3 t(infinity);
  for (int i = 0; i < 3; ++i)
    if (direction[i] != 0.0)
      t[i] = (low[i] + (cell[i] + (direction[i] > 0.0 ? 1.0 : 0.0)) * size[i] - origin[i]) / direction[i];
  return t;
}

int first_of(const Vec3& t) {
  const int of_two = t.y < t.x ? 1 : 0;
  return t.z < t[of_two] ? 2 : of_two;
}

double tolerance_at(double t) {
  return 1e-3 * std::max(1.0, std::abs(t));
}

/// Two walls are met so nearly at once that single precision cannot tell which comes first.
bool is_tie(const Vec3& t) {
  const int first = first_of(t);
  return std::min(t[(first + 1) % 3], t[(first + 2) % 3]) - t[first] < 5.0 * tolerance_at(t[first]);
}

Right grid_right(Numbers n) {
  const Vec3 t = walls_of(n);
  const int axis = first_of(t);
  Vec3 cell = vector_at(n, 0);
  cell[axis] += n[6 + static_cast<std::size_t>(axis)] > 0.0f ? 1.0 : -1.0;
  // Of two cells beside an edge either is right.
  return {value_of(cell, t[axis]), is_tie(t) ? 1.0 : tolerance_at(t[axis]),
          fmt::format("the walls of x, y and z are met at {:.4g}, {:.4g} and {:.4g}", t.x, t.y, t.z)};
}

std::string grid_words(Numbers n) {
  return fmt::format("{} in the cell {} of cells {} from {} on", ray_words(n.subspan(3)),
                     words_of(vector_at(n, 0)), words_of(vector_at(n, 12)), words_of(vector_at(n, 9)));
}

std::string grid_value_words(Numbers, const Value& value) {
  return fmt::format("the cell {} at t = {:.6g}", words_of({value[0], value[1], value[2]}), value[3]);
}

struct Grid {
  Vec3 low{0.0}, size{1.0};
};

/// Adds the cell in which the ray is at `t`; false where that is near a wall, or its next walls are a tie.
bool add_cell(Questions& q, const Grid& grid, const Ray& ray, double t, bool any = false) {
  const Vec3 place = (ray.origin + t * ray.direction - grid.low) / grid.size, cell = glm::floor(place);
  const Vec3 inside = place - cell;
  Question question = q.made(cell, ray.origin, ray.direction, grid.low, grid.size);
  for (int i = 0; i < 3 && !any; ++i)
    if (inside[i] < 0.1 || inside[i] > 0.9) return false;
  if (!any && is_tie(walls_of(question.numbers))) return false;
  q.put(std::move(question));
  return true;
}

/// Directions whose signs are those of `signs`; 0 along an axis where it is 0.
Vec3 direction_with(Dice& dice, const Vec3& signs) {
  return glm::normalize(glm::abs(dice.direction()) * signs);
}

std::vector<Question> grid_questions() {
  Questions q;
  Dice dice(10);
  const auto add = [&](const Vec3& signs, const Grid& grid, double from, double stretch) {
    for (;;) {
      const Vec3 to = direction_with(dice, signs) * stretch;
      const Vec3 place =
          grid.low + grid.size * Vec3(dice.between(1.0, 7.0), dice.between(1.0, 7.0), dice.between(1.0, 7.0));
      if (add_cell(q, grid, {place - from / stretch * to, to}, from / stretch)) return;
    }
  };
  const auto group = [&](std::string_view name, const Vec3& signs, double from = 3.0, double stretch = 1.0) {
    q.group(name, 2 * of_each, [&](int) { add(signs, {}, from, stretch); });
  };
  const Vec3 mixed[] = {{1.0, -1.0, 1.0}, {-1.0, 1.0, -1.0}, {1.0, 1.0, -1.0}, {-1.0, -1.0, 1.0}};
  group("up", {1.0, 1.0, 1.0});
  group("down", {-1.0, -1.0, -1.0});
  q.group("mixed", 3 * of_each, [&](int i) { add(mixed[i % 4], {}, 3.0, 1.0); });
  q.group("begin", 2 * of_each, [&](int i) { add(mixed[i % 4], {}, 0.0, 1.0); });
  q.group("length", 2 * of_each, [&](int i) { add(mixed[i % 4], {}, 3.0, i % 2 == 0 ? 2.5 : 0.4); });
  q.group("axes", 3 * of_each, [&](int i) {
    Vec3 signs = mixed[i % 4];
    signs[i % 3] = 0.0;
    if (i % 2 == 0) signs[(i + 1) % 3] = 0.0;
    add(signs, {}, 2.0, 1.0);
  });
  q.group("size", 2 * of_each, [&](int i) {
    add(mixed[i % 4], {{}, {dice.between(0.5, 0.9), dice.between(1.2, 2.0), dice.between(0.2, 0.4)}}, 2.0,
        1.0);
  });
  q.group("low", 2 * of_each, [&](int i) { add(mixed[i % 4], {dice.in_cube(3.0), Vec3(1.0)}, 2.0, 1.0); });
  q.group("far", 2 * of_each, [&](int i) { add(mixed[i % 4], {}, 100.0, 1.0); });
  add_picture(q, [&](const Vec3& eye, const Vec3& to) {
    add_cell(q, {{-2.0, -2.0, -2.0}, {0.5, 0.6, 0.7}}, {eye, to}, 4.3, true);
  });
  return q.take();
}

}  // namespace

Function grid_step_function() {
  return {"grid_step",
          "float t; ivec3 next = grid_step(ivec3(case_vector(0)), case_vector(3), case_vector(6), "
          "case_vector(9), "
          "case_vector(12), t); answer = vec4(vec3(next), t)",
          15,
          AnswerKind::several,
          grid_questions,
          grid_right,
          grid_words,
          grid_value_words};
}

}  // namespace gnomon::functions
