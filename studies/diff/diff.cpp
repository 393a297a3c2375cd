#include "studies/diff/diff.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "compare/ladder/labels.h"
#include "compare/result/output_parts.h"
#include "compare/result/outputs.h"
#include "compare/result/palette.h"
#include "compare/result/result_parts.h"
#include "scene/files/path_status.h"
#include "scene/files/read_file.h"
#include "studies/diff/same_view.h"
#include "studies/diff/spread.h"
#include "studies/diff/wrong_pixels.h"

namespace gnomon::studies {
namespace {

using compare::Label;
using Json = nlohmann::ordered_json;

struct ResultFile {
  std::string path, folder;
  Json json;
};

Expected<ResultFile> read_result(const std::string& given) {
  ResultFile file;
  const auto kind = file_kind(given);
  if (!kind) return fail(kind.error());
  file.path = *kind == FileKind::folder ? given + "/result.json" : given;
  file.folder = folder_of(file.path);
  const auto text = read_file(file.path);
  if (!text) return fail(text.error());
  file.json = Json::parse(*text, nullptr, false);
  const Json schema = file.json.is_object() ? file.json.value("schema", Json()) : Json();
  if (schema != "gnomon/result/1")
    return fail(
        Error{ErrorKind::bad_input, "not a result of gnomon compare or judge (gnomon/result/1)", file.path});
  return file;
}

Trend trend_of(double worse_by, double spread) {
  if (worse_by == 0.0) return Trend::same;
  if (std::abs(worse_by) <= spread) return Trend::untold;
  return worse_by > 0.0 ? Trend::worse : Trend::better;
}

/// How many texels of the map now one of the map before is as wide as; 1 where a width is not known.
double texels_now(const Drawn& before, const Drawn& after) {
  const auto width = [](const Drawn& side) {
    const Json median = side.light.at("map").value("texel_world", Json::object()).value("median", Json());
    return median.is_number() ? median.get<double>() : 0.0;
  };
  return width(before) > 0.0 && width(after) > 0.0 ? width(before) / width(after) : 1.0;
}

std::vector<FigureChange> figure_changes(const Drawn& before, const Drawn& after) {
  std::vector<FigureChange> changes;
  for (const compare::Figure& figure : compare::figures()) {
    if (figure.measure.name.empty()) continue;
    FigureChange change{&figure, figure.of(before.figures), figure.of(after.figures)};
    if (std::isnan(change.before) || std::isnan(change.after)) continue;
    if (const double scale = texels_now(before, after); figure.unit == "texels" && scale != 1.0)
      change.before *= scale, change.in_texels_now = true;
    change.spread = spread(figure, before, after);
    change.trend = trend_of(change.worse_by(), change.spread);
    changes.push_back(change);
  }
  return changes;
}

std::optional<std::array<double, 3>> interval_of(const Json& shadows, const std::string& key) {
  std::array<double, 3> out{};
  std::size_t i = 0;
  for (const char* part : {"", "_low", "_high"}) {
    const Json value = shadows.value(key + part, Json());
    if (!value.is_number()) return std::nullopt;
    out[i++] = value.get<double>();
  }
  return out;
}

Trend trend_of_times(const TimeChange& t, bool same_machine) {
  if (!same_machine) return Trend::untold;
  if (t.after[1] > t.before[2]) return Trend::worse;
  return t.after[2] < t.before[1] ? Trend::better : Trend::untold;
}

std::vector<TimeChange> time_changes(const Drawn& before, const Drawn& after) {
  std::vector<TimeChange> changes;
  const Json none = Json::object();
  const auto shadows = [&](const Drawn& side) {
    return side.light.value("times_ms", none).value("shadows", Json());
  };
  const Json a = shadows(before), b = shadows(after);
  if (!a.is_object() || !b.is_object()) return changes;
  const auto machine = [&](const Drawn& side) { return side.result.at("machine").at("cpu"); };
  for (const auto& [key, words] : {std::pair{"nothing_moves_map", "shadows' time, nothing moves"},
                                   {"light_moves_map", "shadows' time, light or camera moves"},
                                   {"casters_move_map", "shadows' time, casters move"}}) {
    const auto first = interval_of(a, key), second = interval_of(b, key);
    if (!first || !second) continue;
    TimeChange change{key, words, *first, *second};
    change.trend = trend_of_times(change, machine(before) == machine(after));
    changes.push_back(std::move(change));
  }
  return changes;
}

/// The change's picture shows the light's labels in grey below it.
struct Drawing {
  const Image<Label>&before, &after;
  PixelChange& out;

  glm::u8vec3 backdrop(std::size_t i) const {
    return compare::is_compared(after.data[i]) ? compare::label_colour(Label::right)
                                               : compare::right_in_shadow_colour;
  }
  void draw(std::size_t i, std::uint64_t& count, glm::u8vec3 colour) const {
    ++count;
    out.change.data[i] = colour;
  }
  void pixel(std::size_t i, std::vector<LabelChange>& labels) const {
    const Label was = before.data[i], is = after.data[i];
    out.change.data[i] = out.new_labels.data[i] = backdrop(i);
    const bool was_wrong = compare::has_cause(was), is_wrong = compare::has_cause(is);
    if (!was_wrong && !is_wrong) return;
    if (!compare::is_compared(was) || !compare::is_compared(is)) {
      ++out.uncounted;
      return;
    }
    LabelChange& change = labels[std::size_t(is_wrong ? is : was) - 1];
    if (was_wrong && is_wrong) return ++change.still, draw(i, out.still, still_wrong_colour);
    if (was_wrong) return ++change.fixed, draw(i, out.fixed, fixed_colour);
    ++change.newly_wrong;
    draw(i, out.newly_wrong, newly_wrong_colour);
    out.new_labels.data[i] = compare::label_colour(is);
  }
};

Expected<PixelChange> pixel_changes(const std::array<PixelFiles, 2>& pictures, const Json& size,
                                    std::vector<LabelChange>& labels) {
  std::array<Image<Label>, 2> read;
  for (std::size_t i = 0; i < 2; ++i) {
    auto image = read_wrong_pixels(pictures[i]);
    if (!image) return fail(image.error());
    if (image->size.width != size.at("width") || image->size.height != size.at("height"))
      return fail(
          Error{ErrorKind::bad_input, "has another size than its result.json says", pictures[i].labels});
    read[i] = std::move(*image);
  }
  PixelChange out{.change = Rgb8Image(read[0].size), .new_labels = Rgb8Image(read[0].size)};
  const Drawing drawing{read[0], read[1], out};
  for (std::size_t i = 0; i < read[0].data.size(); ++i) drawing.pixel(i, labels);
  return out;
}

PixelFiles pixel_files(const ResultFile& file, std::size_t light) {
  std::vector<std::string> names;
  for (const Json& one : file.json.at("lights"))
    names.push_back(one.at("light").at("name").get<std::string>());
  const std::string end =
      (names.size() > 1 ? "-" + compare::light_file_part(names, light, light) : "") + ".png";
  return {file.folder + "/labels" + end, file.folder + "/error" + end};
}

std::vector<LabelChange> label_counts(const Json& before, const Json& after) {
  std::vector<LabelChange> labels;
  for (std::size_t k = 1; k <= compare::class_count; ++k) {
    LabelChange change{static_cast<Label>(k)};
    const std::string key(compare::label_text(change.label).key);
    change.before = before.at("classes").value(key, std::uint64_t{0});
    change.after = after.at("classes").value(key, std::uint64_t{0});
    labels.push_back(change);
  }
  return labels;
}

/// A result.json that was kept by itself has no pictures.
Expected<void> add_pixels(LightDiff& light, const std::array<ResultFile, 2>& files, std::size_t index) {
  std::array<PixelFiles, 2> pictures;
  for (std::size_t i = 0; i < 2; ++i) {
    pictures[i] = pixel_files(files[i], index);
    for (const std::string& path : {pictures[i].labels, pictures[i].error}) {
      const auto there = is_there(path);
      if (!there) return fail(there.error());
      if (!*there) light.no_pixels = path + " is not there";
    }
  }
  if (light.no_pixels.empty()) {
    auto changes = pixel_changes(pictures, files[0].json.at("size"), light.labels);
    if (!changes) return fail(changes.error());
    light.pixels = std::move(*changes);
  }
  std::erase_if(light.labels, [](const LabelChange& label) {
    return label.before + label.after + label.fixed + label.newly_wrong + label.still == 0;
  });
  return {};
}

/// Which of the figures a measure stands for.
bool counts_for(const compare::Figure& measure, const compare::Figure& figure) {
  if (&measure != &compare::wrong_and_mean()) return &measure == &figure;
  return &figure == compare::find_measure("wrong") || &figure == compare::find_measure("mean");
}

/// What is so much worse that it fails: by more than the limit, and by more than chance where that is known.
/// Another OpenGL may have made it worse for good: then the limit alone decides.
std::string too_much(const LightDiff& light, const compare::Threshold& limit, bool by_another_gl) {
  for (const FigureChange& change : light.figures)
    if (counts_for(*limit.measure, *change.figure) && change.worse_by() > limit.limit &&
        (change.trend == Trend::worse || (change.spread == unknown_spread && by_another_gl)))
      return fmt::format("{}: {} {} now, {} before", light.name, compare::measure_words(*change.figure),
                         compare::figure_text(*change.figure, change.after),
                         compare::figure_text(*change.figure, change.before));
  return {};
}

/// Pixels of which nothing is known could hide wrong ones.
std::string more_unknown(const Drawn& before, const Drawn& after, const compare::Threshold& limit) {
  const auto unknown = [&](const Drawn& side) {
    return double(compare::unknown_pixels(side.figures, *limit.measure));
  };
  const double all = double(after.figures.pixels.compared + after.figures.pixels.uncertain);
  if (limit.measure->unit != "share" || unknown(after) - unknown(before) <= limit.limit * all) return {};
  return fmt::format("{} pixels are uncertain now, {} before", unknown(after), unknown(before));
}

Expected<LightDiff> light_diff(const std::array<ResultFile, 2>& files, std::size_t index,
                               const DiffOptions& options) {
  const auto drawn = [&](const ResultFile& file) {
    const Json& light = file.json.at("lights").at(index);
    return Drawn{file.json, light, compare::read_pooled_figures(light)};
  };
  const Drawn before = drawn(files[0]), after = drawn(files[1]);
  for (std::size_t i = 0; i < 2; ++i) {
    const compare::PixelCounts& here = (i == 0 ? before : after).figures.pixels;
    const compare::PixelCounts& there = (i == 0 ? after : before).figures.pixels;
    if (here.compared == 0 && there.compared > 0)
      return fail(Error{ErrorKind::bad_input, "no pixel could be compared in it", files[i].path});
  }
  LightDiff light;
  light.name = after.light.at("light").at("name").get<std::string>();
  light.chances = chances(before, after);
  light.figures = figure_changes(before, after);
  light.times = time_changes(before, after);
  light.labels = label_counts(before.light, after.light);
  if (const auto added = add_pixels(light, files, index); !added) return fail(added.error());
  bool measured = false;
  for (const FigureChange& change : light.figures)
    if (counts_for(*options.measure, *change.figure))
      light.trend = together(light.trend, change.trend), measured = true;
  if (!measured)
    return fail(ErrorKind::bad_input,
                fmt::format("{} is not in both results", compare::measure_words(*options.measure)));
  if (!options.fail_worse) return light;
  if (std::ranges::none_of(light.figures, [&](const FigureChange& change) {
        return counts_for(*options.fail_worse->measure, *change.figure);
      }))
    return fail(ErrorKind::bad_input,
                fmt::format("the {} is not in both results, so that --fail-worse cannot be kept",
                            compare::measure_words(*options.fail_worse->measure)));
  light.too_much = too_much(light, *options.fail_worse, has_other_gl(before, after));
  if (light.too_much.empty()) light.too_much = more_unknown(before, after, *options.fail_worse);
  return light;
}

Expected<Diff> diff_files(const std::array<ResultFile, 2>& files, const DiffOptions& options) {
  Diff diff;
  diff.fail_worse = options.fail_worse;
  for (std::size_t i = 0; i < 2; ++i) {
    diff.paths[i] = files[i].path;
    diff.commands[i] = files[i].json.at("command").get<std::string>();
    diff.versions[i] = files[i].json.at("version").get<std::string>();
  }
  const Json &before = files[0].json, &after = files[1].json;
  if (const std::string why = why_not_comparable(before, after, options); !why.empty())
    return fail(ErrorKind::bad_input,
                fmt::format("{} and {} cannot be compared: {}", files[0].path, files[1].path, why));
  diff.scene = after.at("scene").at("name").get<std::string>();
  diff.notes = notes_on(before, after);
  diff.changed = changed_settings(before, after);
  for (std::size_t i = 0; i < after.at("lights").size(); ++i) {
    auto light = light_diff(files, i, options);
    if (!light) return fail(light.error());
    diff.trend = together(diff.trend, light->trend);
    diff.lights.push_back(std::move(*light));
  }
  return diff;
}

}  // namespace

double FigureChange::worse_by() const {
  return figure->better == compare::Better::more ? before - after : after - before;
}

bool Diff::too_much() const {
  return std::ranges::any_of(lights, [](const LightDiff& light) { return !light.too_much.empty(); });
}

std::string_view trend_name(Trend trend) {
  constexpr std::array<std::string_view, 5> names{"same", "not told from chance", "better", "worse", "mixed"};
  return names[std::size_t(trend)];
}

Trend together(Trend a, Trend b) {
  if (a > b) std::swap(a, b);
  return a == Trend::better && b == Trend::worse ? Trend::mixed : b;
}

Expected<Diff> diff_results(const std::string& before, const std::string& after, const DiffOptions& options) {
  std::array<ResultFile, 2> files;
  for (std::size_t i = 0; i < 2; ++i) {
    auto file = read_result(i == 0 ? before : after);
    if (!file) return fail(file.error());
    files[i] = std::move(*file);
  }
  try {
    return diff_files(files, options);
  } catch (const Json::exception&) {
    return fail(ErrorKind::bad_input,
                fmt::format("{} or {} is no whole result", files[0].path, files[1].path));
  }
}

}  // namespace gnomon::studies
