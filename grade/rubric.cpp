#include "grade/rubric.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <regex>
#include <set>

#include "compare/comparison.h"
#include "compare/result/figures.h"
#include "functions/functions.h"
#include "raster/programs/shader_folder.h"
#include "raster/settings.h"
#include "raster/technique_traits.h"
#include "scene/base/option_text.h"
#include "scene/files/json/json_reader.h"
#include "scene/files/path_status.h"
#include "scene/files/read_file.h"
#include "scene/load.h"

namespace gnomon::grade {

namespace {

constexpr NumberRange seconds_range{0.0, 3600.0, true};
constexpr NumberRange memory_range{1024.0, 1e6};
constexpr NumberRange pixels_range{0.0, 1e9, false, false, true};

const std::vector<std::string_view> kinds = {"draws", "at_most", "equals", "time", "answers"};

/// Options of compare that a rubric may set besides those of the shadow map. What is read besides the scene, what is written,
/// and with which shaders, whoever grades decides.
const std::vector<std::string_view> picture_options = {"accel",
                                                       "backend",
                                                       "camera",
                                                       "camera-distance",
                                                       "camera-height",
                                                       "camera-orbit",
                                                       "camera-target",
                                                       "camera-up",
                                                       "exposure",
                                                       "instances",
                                                       "light",
                                                       "light-azimuth",
                                                       "light-distance",
                                                       "light-elevation",
                                                       "light-size",
                                                       "max-lights",
                                                       "measure",
                                                       "memory",
                                                       "min-contribution",
                                                       "precision",
                                                       "runs",
                                                       "samples",
                                                       "seed",
                                                       "size",
                                                       "tessellate",
                                                       "time"};

bool may_set(const std::string& option) {
  if (raster::find_setting(option) != nullptr) return option != "technique";
  return std::find(picture_options.begin(), picture_options.end(), option) != picture_options.end();
}

std::vector<std::string_view> measure_names() {
  std::vector<std::string_view> names;
  for (const Measure& measure : measures()) names.push_back(measure.name);
  return names;
}

/// "0.1%" as a share, "0.5texel" in texels.
double read_limit(const JsonNode& node, Measure::Unit unit) {
  const std::string text = node.as_string();
  const std::string_view suffix = unit == Measure::Unit::share ? "%" : "texel";
  const double scale = unit == Measure::Unit::share ? 0.01 : 1.0;
  std::string_view number = text;
  if (number.ends_with(suffix)) number.remove_suffix(suffix.size());
  const auto value = parse_decimal(number);
  if (number.size() < text.size() && value && *value >= 0.0) return *value * scale;
  node.wrong("is no limit of this measure", unit == Measure::Unit::share
                                                ? "a percentage >= 0, such as \"0.1%\""
                                                : "texels >= 0, such as \"0.5texel\"");
  return 0.0;
}

std::string scene_path(const JsonNode& node, const std::string& folder) {
  const std::string name = node.as_string();
  const auto scenes = builtin_scenes();
  if (std::any_of(scenes.begin(), scenes.end(), [&](const BuiltinScene& s) { return s.name == name; }))
    return name;
  const auto path = resolve_path(folder, name, {.confine_paths = true});
  if (!path) {
    node.error(path.error().reason);
    return {};
  }
  const auto there = is_there(*path);
  if (!there) node.error(there.error().reason);
  if (there && !*there) node.error("no such scene: neither a file nor a built-in one");
  return *path;
}

Run read_run(const JsonNode& node, const std::string& folder) {
  const JsonObject object(node, {"scene", "options"});
  Run run;
  if (const auto scene = object.require("scene"))
    run.scene = scene_path(*scene, folder), run.named = scene->as_string();
  const auto options = object.find("options");
  if (!options) return run;
  if (!options->is(JsonValue::Type::object)) {
    options->wrong("is no set of options", "an object of strings, such as {\"bias\": \"0.5texel\"}");
    return run;
  }
  for (const JsonMember& member : options->value().members) {
    const JsonNode value(node.errors(), member.value, options->path() + "." + member.key);
    if (!may_set(member.key)) value.error("is not for a rubric to set");
    run.options.emplace_back(member.key, value.as_string());
  }
  return run;
}

/// Names of checks that stand above.
std::vector<std::size_t> read_needs(const JsonNode& node, const std::vector<Check>& earlier) {
  std::vector<std::string_view> names;
  for (const Check& check : earlier) names.push_back(check.name);
  std::vector<std::size_t> needs;
  for (const JsonNode& name : node.as_array()) {
    if (names.empty()) name.error("names no check that stands above this one");
    if (!names.empty()) needs.push_back(name.as_choice(names));
  }
  return needs;
}

/// One run: a group of a function's cases.
std::vector<Run> read_calls(const JsonObject& object) {
  Run run;
  const auto function = object.require("function");
  if (!function) return {};
  const std::size_t index = function->as_choice(functions::function_names());
  const functions::Function& called = functions::all_functions()[index];
  run.function = called.name;
  const auto cases = object.require("cases");
  if (!cases) return {};
  const std::vector<std::string_view> groups = functions::groups_of(called);
  run.cases = groups[cases->as_choice(groups)];
  return {std::move(run)};
}

Check read_check(const JsonNode& node, const std::string& folder, const std::vector<Check>& earlier) {
  const JsonObject object(node, {"name", "points", "kind", "measure", "at_most", "pixels", "times",
                                 "function", "cases", "needs", "hint", "runs"});
  Check check;
  if (const auto name = object.require("name")) check.name = name->as_string();
  if (const auto points = object.require("points")) check.points = points->as_number(positive_number);
  if (const auto kind = object.require("kind")) check.kind = static_cast<CheckKind>(kind->as_choice(kinds));
  check.hint = object.string("hint");
  if (const auto needs = object.find("needs")) check.needs = read_needs(*needs, earlier);
  const bool is_figure = check.kind == CheckKind::at_most;
  for (const char* key : {"measure", "at_most"})
    if (!is_figure) object.forbid(key, "applies to checks of the kind at_most");
  if (check.kind != CheckKind::equals) object.forbid("pixels", "applies to checks of the kind equals");
  if (check.kind != CheckKind::time) object.forbid("times", "applies to checks of the kind time");
  if (is_figure) {
    if (const auto measure = object.require("measure"))
      check.measure = measures()[measure->as_choice(measure_names())];
    if (const auto limit = object.require("at_most")) check.limit = read_limit(*limit, check.measure.unit);
  }
  if (check.kind == CheckKind::equals)
    if (const auto pixels = object.require("pixels")) check.limit = pixels->as_number(pixels_range);
  if (check.kind == CheckKind::time)
    if (const auto times = object.require("times")) check.limit = times->as_number(positive_number);
  if (check.kind == CheckKind::answers) {
    object.forbid("runs", "does not apply to checks of the kind answers");
    check.runs = read_calls(object);
    return check;
  }
  for (const char* key : {"function", "cases"}) object.forbid(key, "applies to checks of the kind answers");
  if (const auto runs = object.require("runs")) {
    for (const JsonNode& run : runs->as_array()) check.runs.push_back(read_run(run, folder));
    if (check.runs.empty()) runs->error("is empty");
  }
  return check;
}

/// Beside given files any shader may be handed in, one of the program's own otherwise.
std::vector<std::string> read_hand_in(const JsonNode& node, bool beside_given) {
  std::vector<std::string_view> names;
  for (const raster::ShaderFile& file : raster::own_shaders()) names.push_back(file.name);
  std::vector<std::string> files;
  for (const JsonNode& file : node.as_array()) {
    files.push_back(beside_given ? file.as_string() : std::string(names[file.as_choice(names)]));
    if (beside_given && !raster::is_shader(files.back()))
      file.wrong("is no shader", "a name that ends in .glsl");
  }
  if (files.empty()) node.error("is empty");
  return files;
}

/// The path of a file that students begin with, in the rubric's folder.
std::string beside(const std::string& folder, const std::string& name) {
  return fmt::format("{}{}student/{}", folder, folder.empty() ? "" : "/", name);
}

/// They lie in the folder student/ beside the rubric.
std::vector<GivenFile> read_given(const JsonNode& node, const std::string& folder) {
  std::vector<std::string_view> names;
  for (const raster::ShaderFile& file : raster::own_shaders()) names.push_back(file.name);
  std::vector<GivenFile> files;
  for (const JsonNode& file : node.as_array()) {
    const std::string name(names[file.as_choice(names)]);
    const auto text = read_file(beside(folder, name));
    if (!text) file.error(text.error().reason);
    files.push_back({name, text ? *text : std::string()});
  }
  return files;
}

/// A class would be graded for nothing.
void check_files_are_read(const JsonNode& hand_in, raster::Technique technique) {
  const std::set<std::string> read = raster::files_read_by(technique);
  for (const JsonNode& file : hand_in.as_array())
    if (!read.contains(file.as_string()))
      file.wrong(fmt::format("is not read by --technique {}", raster::technique_name(technique)),
                 fmt::format("{} or what it shares with others",
                             fmt::join(raster::technique_files(technique), ", ")));
}

/// Functions have no technique: what is handed in is theirs, and so are all checks.
void check_functions(const JsonNode& hand_in, const std::vector<Check>& checks, const JsonNode& node) {
  std::vector<std::string> files;
  for (const functions::Function& function : functions::all_functions())
    files.push_back(functions::file_of(function));
  for (const JsonNode& file : hand_in.as_array())
    if (std::find(files.begin(), files.end(), file.as_string()) == files.end())
      file.wrong("is no function, which a rubric without a technique asks for",
                 fmt::format("{}", fmt::join(files, ", ")));
  const auto is_asked = [&](const Check& check) {
    return std::ranges::all_of(check.runs, [&](const Run& run) {
      return std::ranges::any_of(hand_in.as_array(), [&](const JsonNode& file) {
        return file.as_string() == fmt::format("function/{}.glsl", run.function);
      });
    });
  };
  for (const Check& check : checks)
    if (!is_asked(check))
      node.error(
          fmt::format("check \"{}\" is about nothing that is handed in (a rubric without a technique has "
                      "checks of the kind answers alone)",
                      check.name));
}

/// Letters in groups with '-' between them, which is what pages need to know of a tag (BCP 47, 2.1).
std::string read_language(const JsonNode& node) {
  static const std::regex tag("[A-Za-z]{2,8}(-[A-Za-z0-9]{1,8})*");
  const std::string text = node.as_string();
  if (!std::regex_match(text, tag)) node.wrong("is no language", "a tag such as en, de, pt-BR");
  return text;
}

Rubric read_root(const JsonNode& node, const std::string& folder) {
  const JsonObject object(
      node, {"schema", "title", "text", "language", "technique", "hand_in", "given", "limits", "checks"});
  Rubric rubric;
  if (const auto schema = object.require("schema")) schema->as_choice({"gnomon/rubric/1"});
  if (const auto title = object.require("title")) rubric.title = title->as_string();
  rubric.text = object.string("text");
  if (const auto language = object.find("language")) rubric.language = read_language(*language);
  std::vector<std::string_view> names;
  for (const raster::TechniqueTraits& traits : raster::all_technique_traits()) names.push_back(traits.name);
  const auto technique = object.find("technique");
  const std::size_t index = technique ? technique->as_choice(names) : 0;
  if (technique) rubric.technique = names[index];
  const raster::Technique shadows = raster::all_technique_traits()[index].technique;
  if (!technique) object.forbid("given", "goes with a technique");
  const auto given = object.find("given");
  if (given) rubric.given = read_given(*given, folder), check_files_are_read(*given, shadows);
  const auto hand_in = object.require("hand_in");
  if (hand_in) {
    rubric.hand_in = read_hand_in(*hand_in, given.has_value());
    if (!given && technique) check_files_are_read(*hand_in, shadows);
    for (const std::string& name : rubric.hand_in)
      if (const auto text = read_file(beside(folder, name))) rubric.begun.push_back(*text);
  }
  if (const auto limits = object.find("limits")) {
    const JsonObject of(*limits, {"seconds", "memory_mb"});
    rubric.limits.seconds = of.number("seconds", rubric.limits.seconds, seconds_range);
    rubric.limits.memory_mb = of.number("memory_mb", rubric.limits.memory_mb, memory_range);
  }
  if (const auto checks = object.require("checks")) {
    for (const JsonNode& check : checks->as_array())
      rubric.checks.push_back(read_check(check, folder, rubric.checks));
    if (rubric.checks.empty()) checks->error("is empty");
    if (hand_in && !technique) check_functions(*hand_in, rubric.checks, *checks);
    if (technique)
      for (const Check& check : rubric.checks)
        if (check.kind == CheckKind::answers)
          checks->error(
              fmt::format("check \"{}\" is about a function, and the rubric about a technique", check.name));
  }
  return rubric;
}

}  // namespace

const std::vector<Measure>& measures() {
  static const std::vector<Measure> all = [] {
    using enum Measure::Unit;
    std::vector<Measure> list;
    for (const compare::Figure& figure : compare::figures())
      if (!figure.mark.name.empty())
        list.push_back(
            {figure.mark.name, figure.unit == "texels" ? texels : share, figure.mark.words, &figure});
    for (std::size_t i = 1; i <= compare::class_count; ++i) {
      const auto label = static_cast<compare::Label>(i);
      if (label >= compare::Label::unexplained) continue;  // of pictures that the program did not draw
      const bool decided_before = label == compare::Label::light_size ||
                                  label == compare::Label::outside_map ||
                                  label == compare::Label::custom_shader;
      list.push_back(
          {compare::label_name(label), share, "an error with this label", nullptr, !decided_before});
    }
    return list;
  }();
  return all;
}

double Rubric::points() const {
  double sum = 0.0;
  for (const Check& check : checks) sum += check.points;
  return sum;
}

Expected<Rubric> read_rubric(const std::string& path) {
  const auto text = read_file(path);
  if (!text) return fail(text.error());
  const auto document = parse_json(*text, path);
  if (!document) return fail(document.error());
  JsonErrors errors{*document};
  Rubric rubric = read_root(JsonNode(errors, document->root, ""), folder_of(path));
  if (errors.first) return fail(*errors.first);
  return rubric;
}

std::string run_text(const Run& run) {
  if (!run.function.empty()) return fmt::format("--call {} --cases {}", run.function, run.cases);
  std::string text = shell_quoted(run.named);
  for (const auto& [name, value] : run.options) {
    text += fmt::format(" --{}", name);
    if (!value.empty()) text += fmt::format(" {}", shell_quoted(value));
  }
  return text;
}

}  // namespace gnomon::grade
