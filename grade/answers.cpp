#include "grade/answers.h"

#include <algorithm>
#include <cmath>

#include "functions/functions.h"
#include "scene/files/pictures/image_io.h"

namespace gnomon::grade {
namespace {

using functions::AnswerKind;
using functions::Function;
using functions::Question;
using Colour = glm::u8vec3;

constexpr Colour no_number{214, 0, 190}, no_hit{38, 50, 72}, wrong_colour{214, 60, 40};

std::uint8_t byte_of(double share) {
  return static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(share, 0.0, 1.0)));
}

/// What the numbers of an answer are shown between: those of the right ones, without "no hit".
struct Range {
  functions::Value low, high;
  /// From 0 to 1; one that is always the same is shown as the first number is.
  double share(const functions::Value& value, std::size_t i) const {
    const std::size_t k = high[i] > low[i] ? i : 0;
    return (value[k] - low[k]) / std::max(high[k] - low[k], 1e-30);
  }
};

Range range_of(const Function& function, const std::vector<Question>& questions) {
  if (function.kind == AnswerKind::direction) return {{-1.0, -1.0, -1.0, -1.0}, {1.0, 1.0, 1.0, 1.0}};
  if (function.kind == AnswerKind::number) return {{0.0}, {1.0}};
  Range range{{infinity, infinity, infinity, infinity}, {-infinity, -infinity, -infinity, -infinity}};
  for (const Question& question : questions) {
    const functions::Value& value = question.right.value;
    if (question.group != functions::picture_group || value[0] == -1.0) continue;
    for (std::size_t i = 0; i < value.size(); ++i)
      range.low[i] = std::min(range.low[i], value[i]), range.high[i] = std::max(range.high[i], value[i]);
  }
  return range;
}

/// Places on rays: the nearer the lighter. The first three of several numbers: red, green and blue.
Colour colour_of(AnswerKind kind, const functions::Value& value, const Range& range) {
  for (std::size_t i = 0; i < functions::size_of(kind); ++i)
    if (!std::isfinite(value[i]) || value[i] == raster::unwritten_answer) return no_number;
  if (kind == AnswerKind::direction || kind == AnswerKind::several)
    return {byte_of(range.share(value, 0)), byte_of(range.share(value, 1)), byte_of(range.share(value, 2))};
  if (kind == AnswerKind::place_on_ray && value[0] == -1.0) return no_hit;
  const double share = range.share(value, 0);
  const std::uint8_t grey = byte_of(kind == AnswerKind::place_on_ray ? 0.95 - 0.65 * share : share);
  return {grey, grey, grey};
}

Expected<Picture> picture_of(std::string caption, const std::vector<Colour>& pixels) {
  Rgb8Image image({functions::picture_width, functions::picture_height});
  image.data = pixels;
  auto png = encode_png(image);
  if (!png) return fail(png.error());
  return Picture{std::move(caption), std::move(*png), {}};
}

}  // namespace

AnswerCount count_answers(const Run& run, const RunResult& result) {
  const Function& function = *functions::find_function(run.function);
  const std::vector<Question>& questions = functions::questions_of(function);
  AnswerCount count;
  for (std::size_t i = 0; i < questions.size(); ++i) {
    if (questions[i].group != run.cases) continue;
    ++count.cases;
    if (functions::is_right(function, questions[i], result.answers[i])) continue;
    if (count.wrong++ == 0)
      count.first_wrong = functions::answer_words(function, questions[i], result.answers[i]);
  }
  return count;
}

Expected<std::vector<Picture>> answer_pictures(const Run& run, const RunResult& result) {
  const Function& function = *functions::find_function(run.function);
  const std::vector<Question>& questions = functions::questions_of(function);
  const Range range = range_of(function, questions);
  std::vector<Colour> given, right, differ;
  for (std::size_t i = 0; i < questions.size(); ++i) {
    if (questions[i].group != functions::picture_group) continue;
    const raster::Answer& answer = result.answers[i];
    given.push_back(colour_of(function.kind, {answer[0], answer[1], answer[2], answer[3]}, range));
    right.push_back(colour_of(function.kind, questions[i].right.value, range));
    differ.push_back(functions::is_right(function, questions[i], answer) ? right.back() : wrong_colour);
  }
  std::vector<Picture> pictures;
  const std::pair<const char*, const std::vector<Colour>*> all[] = {
      {"what was answered", &given}, {"what is right", &right}, {"red: where the two differ", &differ}};
  for (const auto& [caption, pixels] : all) {
    auto picture = picture_of(caption, *pixels);
    if (!picture) return fail(picture.error());
    pictures.push_back(std::move(*picture));
  }
  return pictures;
}

}  // namespace gnomon::grade
