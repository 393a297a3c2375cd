// How the rows of functions.h make their questions. Private to functions.
#pragma once

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "functions/functions.h"
#include "scene/math.h"

namespace gnomon::functions {

/// The same numbers on every machine (Numerical Recipes' 64-bit generator, "ranqd"-style: a multiplier of Knuth's).
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : state_(seed * 2862933555777941757u + 3037000493u) {}
  double between(double low, double high) {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * static_cast<double>(state_ >> 11) * 0x1p-53;
  }
  Vec3 in_cube(double half) { return {between(-half, half), between(-half, half), between(-half, half)}; }
  /// A direction of length 1, not near an axis' plane by less than a tenth or so.
  Vec3 direction() {
    for (;;) {
      const Vec3 v = in_cube(1.0);
      const double least = std::min({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
      if (least > 0.1 && glm::length(v) < 1.0) return glm::normalize(v);
    }
  }

 private:
  std::uint64_t state_;
};

inline constexpr int of_each = 6;  ///< cases of a kind in a group

/// Puts questions together: a group's name, then its cases.
class Questions {
 public:
  void group(std::string_view name) { group_ = name; }
  /// A group whose cases make(0), make(1), ... add.
  template <class Make>
  void group(std::string_view name, int times, const Make& make) {
    group(name);
    for (int i = 0; i < times; ++i) make(i);
  }
  template <class... Parts>
  void add(const Parts&... parts) {
    put(made(parts...));
  }
  /// A case of the group, to be completed and put().
  template <class... Parts>
  Question made(const Parts&... parts) const {
    Question question{group_, {}};
    append(question, parts...);
    return question;
  }
  template <class... Parts>
  static void append(Question& question, const Parts&... parts) {
    (append_one(question.numbers, parts), ...);
  }
  void put(Question question) { all_.push_back(std::move(question)); }
  std::vector<Question> take() { return std::move(all_); }

 private:
  static void append_one(std::vector<float>& out, double number) {
    out.push_back(static_cast<float>(number));
  }
  static void append_one(std::vector<float>& out, const Vec3& v) {
    for (int i = 0; i < 3; ++i) append_one(out, v[i]);
  }
  std::string_view group_;
  std::vector<Question> all_;
};

inline int longest_axis(const Vec3& v) {
  const int of_two = v.y > v.x ? 1 : 0;
  return v.z > v[of_two] ? 2 : of_two;
}

inline Vec3 vector_at(Numbers numbers, std::size_t i) {
  return {numbers[i], numbers[i + 1], numbers[i + 2]};
}

inline std::string words_of(const Vec3& v) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", v.x, v.y, v.z);
}
/// "the ray from (0, 0, 5) towards (0, 0, -1)": the first six numbers.
inline std::string ray_words(Numbers numbers) {
  return fmt::format("the ray from {} towards {}", words_of(vector_at(numbers, 0)),
                     words_of(vector_at(numbers, 3)));
}

/// Adds the picture: add(origin, direction) for each pixel's ray, of length 1, from z = 5 towards -z; what lies within
/// 1.4 of the origin fills its middle.
template <class Add>
void add_picture(Questions& questions, const Add& add) {
  questions.group(picture_group);
  const Vec3 eye{0.3, 0.2, 5.0};
  for (int y = 0; y < picture_height; ++y)
    for (int x = 0; x < picture_width; ++x) {
      const double scale = 2.0 * 0.33 / picture_height;
      const Vec3 to{(x + 0.5 - 0.5 * picture_width) * scale, (0.5 * picture_height - y - 0.5) * scale, -1.0};
      add(eye, glm::normalize(to - Vec3(0.06, 0.04, 0.0)));
    }
}

/// Where no part of a ray is on the surface.
inline Right no_hit(std::string because) {
  return {{-1.0}, 1e-3, std::move(because)};
}

}  // namespace gnomon::functions
