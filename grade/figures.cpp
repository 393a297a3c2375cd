#include "grade/figures.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "compare/bias/bias_curve.h"
#include "compare/ladder/budget.h"
#include "compare/result/figures.h"
#include "functions/functions.h"
#include "scene/files/path_status.h"
#include "scene/files/pictures/image_io.h"
#include "scene/files/read_file.h"

namespace gnomon::grade {

namespace {

using nlohmann::json;

/// Returns a count as a share of the compared pixels. Null stands where nothing is compared: nothing is off there.
double figure_of_light(const json& light, const Measure& measure) {
  const json& value =
      measure.figure == nullptr
          ? light.at("class_errors").at(std::string(measure.name))
          : light.at(std::string(measure.figure->block())).at(std::string(measure.figure->name()));
  if (value.is_null()) return 0.0;
  const bool is_count = measure.figure != nullptr && measure.figure->form() == compare::FigureForm::count;
  const double compared = std::max(1.0, light.at("pixels").at("compared").get<double>());
  return value.get<double>() / (is_count ? compared : 1.0);
}

RunResult figures_in(const json& result, const std::string& folder) {
  RunResult run{folder, std::vector<double>(measures().size(), 0.0)};
  for (const json& light : result.at("lights")) {
    run.ties += light.at("error").at("ties").get<std::uint64_t>();
    for (std::size_t i = 0; i < run.figures.size(); ++i)
      run.figures[i] = std::max(run.figures[i], figure_of_light(light, measures()[i]));
    const auto runs = light.at("times_ms").at("shade_pass").at("runs").get<std::vector<double>>();
    run.shading_ms += *std::min_element(runs.begin(), runs.end());
  }
  return run;
}

std::string file_in(const std::string& folder, const std::string& name) {
  return fmt::format("{}/{}", folder, name);
}

Expected<std::vector<std::string>> value_files(const std::string& folder) {
  auto names = names_in(folder, ErrorKind::internal);
  if (names)
    std::erase_if(*names, [](const std::string& name) {
      return !name.starts_with("values") || !name.ends_with(".exr");
    });
  return names;
}

/// Holds one light's errors as shares of its compared pixels.
struct TwoErrors {
  double false_shadow = 0.0, missed_shadow = 0.0;
};

Expected<TwoErrors> errors_with_ties(const std::string& values) {
  const auto image = read_channels(values);
  if (!image) return fail(image.error());
  const Channel *drawn = image->find("drawn.V"), *truth = image->find("truth.V"),
                *label = image->find("class.V");
  if (drawn == nullptr || truth == nullptr || label == nullptr)
    return fail(Error{ErrorKind::internal, "holds no visibility to compare", values});
  struct Count {
    std::uint64_t wrong = 0, ties = 0;
  } too_dark, too_light;
  std::uint64_t compared = 0;
  for (std::size_t i = 0; i < drawn->values.size(); ++i) {
    if (label->values[i] < 0.0f) continue;
    ++compared;
    const double difference = double(drawn->values[i]) - double(truth->values[i]),
                 size = std::abs(difference);
    Count& count = difference < 0.0 ? too_dark : too_light;
    count.wrong += size > 0.5 ? 1 : 0, count.ties += size == 0.5 ? 1 : 0;
  }
  return TwoErrors{compare::wrong_share(too_dark.wrong, too_dark.ties, compared),
                   compare::wrong_share(too_light.wrong, too_light.ties, compared)};
}

/// Adds one light's compared pixels, by what was drawn.
Expected<void> add_gaps(const std::string& values, compare::GapLists& gaps) {
  const auto image = read_channels(values);
  if (!image) return fail(image.error());
  const Channel *drawn = image->find("drawn.V"), *gap = image->find("gap.V"), *label = image->find("class.V");
  if (drawn == nullptr || gap == nullptr || label == nullptr)
    return fail(Error{ErrorKind::internal, "holds no gaps", values});
  for (std::size_t i = 0; i < drawn->values.size(); ++i)
    if (label->values[i] >= 0.0f && drawn->values[i] != 0.5f)
      (drawn->values[i] > 0.5f ? gaps.lit : gaps.shadowed).push_back(gap->values[i]);
  return {};
}

void raise_figure(RunResult& result, std::string_view name, double value) {
  for (std::size_t i = 0; i < measures().size(); ++i)
    if (measures()[i].name == name) result.figures[i] = std::max(result.figures[i], value);
}

bool is_alike(float a, float b) {
  constexpr float half_a_step = 0.5f / 255.0f;
  return std::fabs(a - b) <= half_a_step;
}

/// Adds one light's compared pixels.
Expected<void> add_values(const std::string& folder, const std::string& name, DrawnValues& sum) {
  const std::string values = file_in(folder, name);
  const auto image = read_channels(values);
  if (!image) return fail(image.error());
  const Channel *drawn = image->find("drawn.V"), *label = image->find("class.V");
  if (drawn == nullptr || label == nullptr)
    return fail(Error{ErrorKind::internal, "holds no visibility to compare", values});
  auto& compared = sum.compared.emplace_back(name, std::vector<std::uint32_t>()).second;
  for (std::uint32_t i = 0; i < drawn->values.size(); ++i)
    if (label->values[i] >= 0.0f) compared.push_back(i), sum.visibility.push_back(drawn->values[i]);
  return {};
}

bool are_all_alike(const std::vector<float>& values) {
  return std::ranges::all_of(values, [&](float v) { return is_alike(v, values.front()); });
}

/// An answer's number in units of its tolerance, which becomes half an 8-bit step; what is no number is alike to itself.
float in_steps(float number, double tolerance) {
  constexpr float endless = 1e20f, no_number = 2e20f;
  if (std::isnan(number)) return no_number;
  return std::clamp(static_cast<float>(double(number) / tolerance * 0.5 / 255.0), -endless, endless);
}

DrawnValues values_of_answers(const Run& run, const std::vector<raster::Answer>& answers) {
  const functions::Function& function = *functions::find_function(run.function);
  const std::vector<functions::Question>& questions = functions::questions_of(function);
  // Students who answer "no hit" with a very large number choose different ones.
  constexpr float no_place = 1e6f;
  DrawnValues values;
  for (std::size_t i = 0; i < questions.size(); ++i)
    if (questions[i].group == run.cases)
      for (std::size_t k = 0; k < functions::size_of(function.kind); ++k) {
        const functions::Right& right = questions[i].right;
        const float answer = right.value[k] < no_place ? std::min(answers[i][k], no_place) : answers[i][k];
        // What should have no end may have any: such are told apart by their orders of magnitude.
        values.visibility.push_back(right.value[k] < no_place
                                        ? in_steps(answer, right.tolerance)
                                        : in_steps(std::log(std::max(answer, 1e-6f)), 1e-3));
      }
  values.is_uniform = std::ranges::all_of(answers, [&](const raster::Answer& answer) {
    return std::memcmp(&answer, &answers.front(), sizeof(float) * functions::size_of(function.kind)) == 0;
  });
  return values;
}

/// Counts the pixels of one light.
Expected<std::uint64_t> count_different(const std::string& a, const std::string& b) {
  const auto first = read_channels(a);
  if (!first) return fail(first.error());
  const auto second = read_channels(b);
  if (!second) return fail(second.error());
  const Channel *drawn = first->find("drawn.V"), *other = second->find("drawn.V"),
                *label = first->find("class.V");
  if (drawn == nullptr || other == nullptr || label == nullptr || !(first->size == second->size))
    return fail(Error{ErrorKind::internal, "holds no visibility to compare", a});
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < drawn->values.size(); ++i)
    if (label->values[i] >= 0.0f && !is_alike(drawn->values[i], other->values[i])) ++count;
  return count;
}

}  // namespace

std::string values_folder(const std::string& folder) {
  return folder + ".values";
}

Expected<RunResult> read_run_result(const std::string& folder) {
  const std::string path = folder + "/result.json";
  const auto text = read_file(path);
  if (!text) return fail(text.error());
  try {
    return figures_in(json::parse(*text), folder);
  } catch (const json::exception& wrong) {
    return fail(Error{ErrorKind::internal, wrong.what(), path});
  }
}

Expected<void> add_ties(RunResult& result) {
  const std::string folder = values_folder(result.folder);
  const auto names = value_files(folder);
  if (!names) return fail(names.error());
  for (const std::string& name : *names) {
    const auto light = errors_with_ties(file_in(folder, name));
    if (!light) return fail(light.error());
    raise_figure(result, "false_shadow", light->false_shadow);
    raise_figure(result, "missed_shadow", light->missed_shadow);
  }
  return {};
}

Expected<double> nearest_bias(const RunResult& result) {
  const std::string folder = values_folder(result.folder);
  compare::GapLists gaps;
  const auto names = value_files(folder);
  if (!names) return fail(names.error());
  for (const std::string& name : *names)
    if (const auto added = add_gaps(file_in(folder, name), gaps); !added) return fail(added.error());
  std::sort(gaps.lit.begin(), gaps.lit.end());
  std::sort(gaps.shadowed.begin(), gaps.shadowed.end());
  return compare::find_best_bias(gaps).constant_world;
}

double figure_of(const RunResult& result, std::string_view measure) {
  for (std::size_t i = 0; i < measures().size(); ++i)
    if (measures()[i].name == measure) return result.figures[i];
  return 0.0;
}

Expected<std::uint64_t> count_different(const RunResult& a, const RunResult& b) {
  std::uint64_t count = 0;
  const std::string first = values_folder(a.folder), second = values_folder(b.folder);
  const auto names = value_files(first), others = value_files(second);
  if (!names) return fail(names.error());
  if (!others) return fail(others.error());
  if (*names != *others || names->empty())
    return fail(Error{ErrorKind::internal, "holds other lights than the program's own drawing", a.folder});
  for (const std::string& name : *names) {
    const auto of_light = count_different(file_in(first, name), file_in(second, name));
    if (!of_light) return of_light;
    count += *of_light;
  }
  return count;
}

std::string answers_file(const std::string& folder) {
  return folder + "/answers.json";
}

Expected<RunResult> read_called(const Run& run, const std::string& folder) {
  RunResult result;
  result.folder = folder;
  auto answers = functions::read_answers(*functions::find_function(run.function), answers_file(folder));
  if (!answers) return fail(answers.error());
  result.answers = std::move(*answers);
  return result;
}

Expected<DrawnValues> read_values(const Run& run, const RunResult& result) {
  if (!run.function.empty()) return values_of_answers(run, result.answers);
  DrawnValues sum;
  const std::string folder = values_folder(result.folder);
  const auto names = value_files(folder);
  if (!names) return fail(names.error());
  for (const std::string& name : *names)
    if (const auto added = add_values(folder, name, sum); !added) return fail(added.error());
  sum.is_uniform = are_all_alike(sum.visibility);
  return sum;
}

Expected<DrawnValues> read_drawn(const std::string& folder, const DrawnValues& right) {
  DrawnValues out;
  const auto names = names_if_there(folder, ErrorKind::internal);
  if (!names) return fail(names.error());
  if (names->empty()) return out;
  for (const auto& [name, pixels] : right.compared) {
    const auto image = read_channels(file_in(folder, name));
    if (!image) return fail(image.error());
    const Channel* drawn = image->find("drawn.V");
    if (drawn == nullptr) return fail(Error{ErrorKind::internal, "holds no visibility to compare", folder});
    for (const std::uint32_t pixel : pixels) out.visibility.push_back(drawn->values.at(pixel));
  }
  return out;
}

Expected<std::optional<RunResult>> read_each_called(const Run& run, const std::string& folder) {
  const auto names = names_if_there(folder, ErrorKind::internal);
  if (!names) return fail(names.error());
  if (names->empty()) return std::optional<RunResult>();
  auto called = read_called(run, folder);
  if (!called) return fail(called.error());
  return std::optional<RunResult>(std::move(*called));
}

Agreement compare_drawings(const DrawnValues& drawn, const DrawnValues& other, const DrawnValues& right) {
  Agreement sum;
  const std::size_t pixels =
      std::min({drawn.visibility.size(), other.visibility.size(), right.visibility.size()});
  for (std::size_t i = 0; i < pixels; ++i) {
    const float own = drawn.visibility[i], second = other.visibility[i], true_one = right.visibility[i];
    const bool is_wrong = !is_alike(own, true_one);
    ++sum.compared;
    sum.wrong += is_wrong ? 1 : 0, sum.either += is_wrong || !is_alike(second, true_one) ? 1 : 0;
    sum.unlike += is_alike(own, second) ? 0 : 1;
    sum.explained += is_wrong && is_alike(own, second) ? 1 : 0;
    sum.other_wrong += is_alike(second, true_one) ? 0 : 1;
  }
  return sum;
}

std::vector<compare::Label> labels_of(const RunResult& result) {
  std::vector<std::pair<double, compare::Label>> found;
  for (std::size_t k = 0; k < compare::class_count; ++k) {
    const auto label = static_cast<compare::Label>(k + 1);
    for (std::size_t i = 0; i < result.figures.size(); ++i)
      if (measures()[i].name == compare::label_name(label) && result.figures[i] > 0.0)
        found.emplace_back(result.figures[i], label);
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<compare::Label> labels;
  for (const auto& [share, label] : found) labels.push_back(label);
  return labels;
}

Expected<std::vector<std::string>> pictures_of(const RunResult& result) {
  auto names = names_in(result.folder, ErrorKind::internal);
  if (!names) return names;
  std::erase_if(*names, [](const std::string& name) {
    return !name.ends_with(".png") ||
           (name != "raster.png" && name != "raytrace.png" && !name.starts_with("labels"));
  });
  std::sort(names->begin(), names->end(), [](const std::string& a, const std::string& b) {
    return std::pair(a.starts_with("labels"), a) < std::pair(b.starts_with("labels"), b);
  });
  return names;
}

}  // namespace gnomon::grade
