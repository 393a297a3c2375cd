// How a tree of boxes parts its triangles: at the middle one, along the axis where their box is longest, as raytrace/accel/median_bvh.cpp
// does. A case's numbers are how many triangles there are, and nine for each.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "functions/make_questions.h"
#include "functions/parts.h"

namespace gnomon::functions {
namespace {

constexpr std::size_t most_triangles = 6, split_numbers = 1 + 9 * most_triangles;

/// Which triangles go left: by the rule, or by one that is mistaken for it.
enum class Rule : std::uint8_t { median, center_axis, space, mean, corners, axis_x };

struct Triangle {
  Vec3 corners{0.0};  ///< the sum of the three
  Aabb box;
  Vec3 center() const { return box.center(); }
};

std::vector<Triangle> triangles_of(Numbers n) {
  std::vector<Triangle> all(static_cast<std::size_t>(n[0]));
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 corner = vector_at(n, 1 + 9 * i + 3 * k);
      all[i].corners += corner;
      all[i].box.grow(corner);
    }
  return all;
}

struct Plan {
  int left = 0;  ///< bit i: triangle i goes left
  int axis = 0;
  bool in_one_place = false;
  bool is_close = false;  ///< single precision may part them otherwise
};

int axis_of(const std::vector<Triangle>& all, Rule rule, bool& is_close) {
  Aabb box;
  for (const Triangle& one : all)
    if (rule == Rule::center_axis)
      box.grow(one.center());
    else
      box.grow(one.box);
  const Vec3 extent = box.extent();
  const int axis = rule == Rule::axis_x ? 0 : longest_axis(extent);
  is_close = extent[axis] - std::max(extent[(axis + 1) % 3], extent[(axis + 2) % 3]) < 1e-3 * extent[axis];
  return axis;
}

/// The half of the triangles that comes first. Of equal places the lower number does.
int first_half(const std::vector<double>& places) {
  std::vector<std::size_t> order(places.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return places[a] < places[b]; });
  int left = 0;
  for (std::size_t i = 0; i < order.size() / 2; ++i) left |= 1 << order[i];
  return left;
}

int below(const std::vector<double>& places, double middle) {
  int left = 0;
  for (std::size_t i = 0; i < places.size(); ++i) left |= places[i] < middle ? 1 << i : 0;
  return left;
}

Plan plan(const std::vector<Triangle>& all, Rule rule = Rule::median) {
  Plan out;
  out.axis = axis_of(all, rule, out.is_close);
  std::vector<double> places;
  double low = infinity, high = -infinity, sum = 0.0;
  for (const Triangle& one : all) {
    places.push_back((rule == Rule::corners ? one.corners / 3.0 : one.center())[out.axis]);
    low = std::min(low, one.box.min[out.axis]), high = std::max(high, one.box.max[out.axis]);
    sum += places.back();
  }
  if (rule == Rule::space || rule == Rule::mean) {
    out.left =
        below(places, rule == Rule::space ? 0.5 * (low + high) : sum / static_cast<double>(all.size()));
    return out;
  }
  out.left = first_half(places);
  std::sort(places.begin(), places.end());
  out.in_one_place = places.front() == places.back();
  const double gap = places[places.size() / 2] - places[places.size() / 2 - 1];
  out.is_close = out.is_close || (!out.in_one_place && gap < 1e-3 * (high - low));
  return out;
}

Right split_right(Numbers n) {
  const Plan right = plan(triangles_of(n));
  return {{static_cast<double>(right.left)},
          right.is_close ? 64.0 : 0.25,
          fmt::format("the box is longest along {}{}", "xyz"[right.axis],
                      right.in_one_place ? ", and all centres are in one place" : "")};
}

std::string split_words(Numbers n) {
  std::string text = "triangles with the boxes";
  for (const Triangle& one : triangles_of(n))
    text += fmt::format(" {} to {};", words_of(one.box.min), words_of(one.box.max));
  text.pop_back();
  return text;
}

std::string split_value_words(Numbers n, const Value& value) {
  std::string list;
  for (int i = 0; i < static_cast<int>(n[0]); ++i)
    if (value[0] >= 0.0 && value[0] < 64.0 && (static_cast<int>(value[0]) >> i & 1) != 0)
      list += fmt::format(" {}", i);
  return list.empty() ? fmt::format("none goes left ({:g})", value[0])
                      : fmt::format("left go{} ({:g})", list, value[0]);
}

/// A triangle around its centre, whose sides are about `size` long.
void append_triangle(Questions& q, Question& question, Dice& dice, const Vec3& center, const Vec3& size) {
  const Vec3 one = size * dice.in_cube(1.0), other = size * dice.in_cube(1.0);
  q.append(question, center + one, center + other, center - one - other);
}

std::vector<Question> split_questions() {
  Questions q;
  Dice dice(12);
  const auto group = [&](std::string_view name, int triangles, Rule unlike, const Vec3& size,
                         const Vec3& at = {}) {
    q.group(name, 2 * of_each, [&](int i) {
      for (;;) {
        Question question = q.made(triangles);
        Vec3 reach(0.6);
        reach[i % 3] = 1.4, reach[(i / 3 + i + 1) % 3] *= 0.5;
        for (int k = 0; k < triangles; ++k)
          append_triangle(q, question, dice, at + reach * dice.in_cube(2.0), size);
        question.numbers.resize(split_numbers);
        const std::vector<Triangle> all = triangles_of(question.numbers);
        if (plan(all).is_close || (unlike != Rule::median && plan(all, unlike).left == plan(all).left))
          continue;
        q.put(std::move(question));
        return;
      }
    });
  };
  group("plain", 6, Rule::median, Vec3(0.3));
  group("axis", 6, Rule::axis_x, Vec3(0.3));
  group("two", 2, Rule::median, Vec3(0.3));
  group("odd", 5, Rule::median, Vec3(0.3));
  group("boxes", 5, Rule::center_axis, Vec3(1.5));
  group("middle", 6, Rule::space, Vec3(0.3));
  group("uneven", 6, Rule::mean, Vec3(0.3));
  group("large", 6, Rule::corners, Vec3(2.0));
  group("far", 6, Rule::median, Vec3(0.3), {300.0, -200.0, 100.0});
  q.group("same", 2 * of_each, [&](int i) {
    Question question = q.made(2 + i % 5);
    for (int k = 0; k < 2 + i % 5; ++k)
      q.append(question, Vec3(-3.0 - k, i, 0.0), Vec3(3.0 + k, i - 3.0, 1.0), Vec3(0.0, i + 3.0, 2.0));
    question.numbers.resize(split_numbers);
    q.put(std::move(question));
  });
  const Question five = [&] {
    Question question = q.made(6.0);
    for (int k = 0; k < 5; ++k) append_triangle(q, question, dice, dice.in_cube(1.2), Vec3(0.3));
    return question;
  }();
  q.group(picture_group);
  for (int y = 0; y < picture_height; ++y)
    for (int x = 0; x < picture_width; ++x) {
      Question question{picture_group, five.numbers};
      const Vec3 center((x - 0.5 * picture_width) / 25.0, (0.5 * picture_height - y) / 25.0, 0.0);
      q.append(question, center - Vec3(0.2, 0.1, 0.0), center + Vec3(0.2, -0.1, 0.0),
               center + Vec3(0.0, 0.2, 0.0));
      q.put(std::move(question));
    }
  return q.take();
}

}  // namespace

Function bvh_split_function() {
  return {"bvh_split",     "answer = vec4(float(bvh_split(int(case_number(0)))), 0.0, 0.0, 0.0)",
          split_numbers,   AnswerKind::several,
          split_questions, split_right,
          split_words,     split_value_words};
}

}  // namespace gnomon::functions
