// How a tree of boxes parts its triangles: by the middle of their centres, along the axis where these reach farthest. A case's numbers
// are how many triangles there are, and nine for each.
#include <algorithm>
#include <cmath>

#include "functions/make_questions.h"
#include "functions/parts.h"

namespace gnomon::functions {
namespace {

constexpr std::size_t most_triangles = 6, split_numbers = 1 + 9 * most_triangles;

/// Which triangles go left: by the rule, or by one that is mistaken for it.
enum class Rule : std::uint8_t { middle, box_axis, box_middle, mean, median, box_centers, axis_x };

struct Triangle {
  Vec3 center{0.0};  ///< the mean of the three
  Aabb box;
};

std::vector<Triangle> triangles_of(Numbers n) {
  std::vector<Triangle> all(static_cast<std::size_t>(n[0]));
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 corner = vector_at(n, 1 + 9 * i + 3 * k);
      all[i].center += corner;
      all[i].box.grow(corner);
    }
  // Divided at last, so that equal sums are one place.
  for (Triangle& one : all) one.center /= 3.0;
  return all;
}

struct Plan {
  int left = 0;  ///< bit i: triangle i goes left
  int axis = 0;
  double middle = 0.0;
  bool in_one_place = false;
  bool is_close = false;  ///< single precision may part them otherwise
};

double middle_of(const std::vector<Triangle>& all, const Aabb& centers, const Aabb& boxes, int axis,
                 Rule rule) {
  std::vector<double> places;
  double sum = 0.0;
  for (const Triangle& one : all) places.push_back(one.center[axis]), sum += one.center[axis];
  std::sort(places.begin(), places.end());
  if (rule == Rule::median) return places[places.size() / 2];
  if (rule == Rule::mean) return sum / static_cast<double>(all.size());
  return (rule == Rule::box_middle ? boxes : centers).center()[axis];
}

Plan plan(std::vector<Triangle> all, Rule rule = Rule::middle) {
  Aabb centers, boxes;
  for (Triangle& one : all) {
    if (rule == Rule::box_centers) one.center = one.box.center();
    centers.grow(one.center), boxes.grow(one.box);
  }
  const Vec3 extent = (rule == Rule::box_axis ? boxes : centers).extent();
  Plan out;
  out.axis = rule == Rule::axis_x ? 0 : longest_axis(extent);
  out.middle = middle_of(all, centers, boxes, out.axis, rule);
  const double longest = extent[out.axis], close = 1e-3 * longest;
  out.in_one_place = longest == 0.0;
  out.is_close =
      longest > 0.0 && longest - std::max(extent[(out.axis + 1) % 3], extent[(out.axis + 2) % 3]) < close;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double below = out.middle - all[i].center[out.axis];
    out.is_close = out.is_close || std::abs(below) < close;
    out.left |= (out.in_one_place ? i < all.size() / 2 : below > 0.0) ? 1 << i : 0;
  }
  return out;
}

Right split_right(Numbers n) {
  const Plan right = plan(triangles_of(n));
  return {{static_cast<double>(right.left)},
          right.is_close ? 64.0 : 0.25,
          right.in_one_place ? "all centres are in one place"
                             : fmt::format("the centres reach farthest along {}, whose middle is {:.4g}",
                                           "xyz"[right.axis], right.middle)};
}

std::string split_words(Numbers n) {
  std::string text = "triangles with the centres";
  for (const Triangle& one : triangles_of(n)) text += " " + words_of(one.center);
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
        if (plan(all).is_close || (unlike != Rule::middle && plan(all, unlike).left == plan(all).left))
          continue;
        q.put(std::move(question));
        return;
      }
    });
  };
  group("plain", 6, Rule::middle, Vec3(0.3));
  group("axis", 6, Rule::axis_x, Vec3(0.3));
  group("two", 2, Rule::middle, Vec3(0.3));
  group("boxes", 5, Rule::box_axis, Vec3(1.5));
  group("middle", 5, Rule::box_middle, Vec3(1.5));
  group("uneven", 6, Rule::mean, Vec3(0.3));
  group("median", 6, Rule::median, Vec3(0.3));
  group("large", 5, Rule::box_centers, Vec3(2.0));
  group("far", 6, Rule::middle, Vec3(0.3), {300.0, -200.0, 100.0});
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
