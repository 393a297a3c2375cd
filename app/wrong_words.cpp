#include "app/wrong_words.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <optional>
#include <vector>

#include "app/help/manual.h"
#include "app/lesson_scene.h"
#include "scene/base/option_text.h"
#include "scene/load.h"

namespace gnomon::app {
namespace {

// Where one of their names means several of ours, the first that the command has is meant.
constexpr OptionSynonym synonyms[] = {
    {"resolution", "size"},
    {"res", "size"},
    {"dimensions", "size"},
    {"image-size", "size"},
    {"picture-size", "size"},
    {"width", "size"},
    {"height", "size"},
    {"spp", "samples"},
    {"samples-per-pixel", "samples"},
    {"shadow-samples", "samples"},
    {"light-samples", "samples"},
    {"num-samples", "samples"},
    {"shadow-map-size", "map-size"},
    {"shadow-map-resolution", "map-size"},
    {"shadow-resolution", "map-size"},
    {"shadow-size", "map-size"},
    {"map-resolution", "map-size"},
    {"depth-map-size", "map-size"},
    {"shadow-bias", "bias"},
    {"depth-bias", "bias"},
    {"constant-bias", "bias"},
    {"epsilon", "bias"},
    {"shadow-epsilon", "bias"},
    {"slope-scale", "slope-bias"},
    {"slope-scale-bias", "slope-bias"},
    {"slope-scaled-bias", "slope-bias"},
    {"slope-scaled-depth-bias", "slope-bias"},
    {"polygon-offset", "caster-bias"},
    {"normal-bias", "normal-offset"},
    {"shadow-normal-bias", "normal-offset"},
    {"method", "technique"},
    {"algorithm", "technique"},
    {"shadow-type", "technique"},
    {"shadow-technique", "technique"},
    {"filter", "technique"},
    {"kernel", "filter-kernel"},
    {"pcf-radius", "filter-radius"},
    {"filter-size", "filter-radius"},
    {"softness", "filter-radius"},
    {"num-cascades", "cascades"},
    {"cascade-count", "cascades"},
    {"culling", "cull"},
    {"cull-face", "cull"},
    {"accelerator", "accel"},
    {"acceleration", "accel"},
    {"acceleration-structure", "accel"},
    {"bvh", "accel"},
    {"tolerance", "fail-above"},
    {"tolerance", "max-error"},
    {"threshold", "fail-above"},
    {"threshold", "max-error"},
    {"max-error", "fail-above"},
    {"fail-above", "max-error"},
    {"metric", "measure"},
    {"out", "output"},
    {"outfile", "output"},
    {"out-dir", "output"},
    {"output-dir", "output"},
    {"output-file", "output"},
    {"output-path", "output"},
    {"dest", "output"},
    {"nthreads", "threads"},
    {"num-threads", "threads"},
    {"jobs", "threads"},
    {"cores", "threads"},
    {"device", "backend"},
    {"gpu", "backend"},
    {"repetitions", "runs"},
    {"repeat", "runs"},
    {"iterations", "runs"},
    {"random-seed", "seed"},
    {"view", "camera"},
    {"viewpoint", "camera"},
    {"silent", "quiet"},
    {"debug", "verbose"},
    {"address", "listen"},
    {"host", "listen"},
};

std::vector<std::string_view> command_names(const CLI::App& program) {
  std::vector<std::string_view> names;
  for (const CLI::App* command : program.get_subcommands({})) names.push_back(command->get_name());
  for (const WordForOption& word : words_for_options) names.push_back(word.word);
  return names;
}

bool looks_like_a_scene(const std::string& word) {
  const std::vector<BuiltinScene> scenes = builtin_scenes();
  return std::filesystem::path(word).has_extension() || !lesson_note(word).empty() ||
         std::any_of(scenes.begin(), scenes.end(),
                     [&](const BuiltinScene& scene) { return scene.name == word; });
}

/// "-shadowMapSize", "--shadow_map_size": "shadow-map-size".
std::string in_our_spelling(std::string_view typed) {
  typed.remove_prefix(std::min(typed.find_first_not_of('-'), typed.size()));
  std::string name;
  for (const char c : typed) {
    const bool is_capital = c >= 'A' && c <= 'Z';
    const bool begins_a_word = is_capital && !name.empty() && name.back() >= 'a' && name.back() <= 'z';
    if (begins_a_word) name += '-';
    name += c == '_' ? '-' : is_capital ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return name;
}

bool has_option(const CLI::App& command, std::string_view name) {
  return command.get_option_no_throw(fmt::format("--{}", name)) != nullptr;
}

/// The command's option that another program calls so, or that is only spelled in another way; "" where there is none.
std::string_view synonym_of(const CLI::App& command, std::string_view name) {
  if (has_option(command, name)) return name;
  for (const OptionSynonym& synonym : synonyms)
    if (synonym.theirs == name && has_option(command, synonym.ours)) return synonym.ours;
  return {};
}

/// " (an option of compare, raster)", or nothing.
std::string whose_option(const CLI::App& command, std::string_view name) {
  std::vector<std::string> owners;
  if (command.get_parent() != nullptr)
    for (const CLI::App* other : command.get_parent()->get_subcommands({}))
      if (has_option(*other, name)) owners.push_back(other->get_name());
  return owners.empty() ? std::string() : fmt::format(" (an option of {})", fmt::join(owners, ", "));
}

/// What was probably meant by an option that the command has not.
std::string option_hint(const CLI::App& command, const std::string& typed) {
  const std::string name = in_our_spelling(typed);
  if (const std::string_view ours = synonym_of(command, name); !ours.empty())
    return fmt::format("; did you mean --{}?", ours);
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& own : option->get_lnames()) names.push_back("--" + own);
  std::string hint = did_you_mean(typed, std::vector<std::string_view>(names.begin(), names.end()));
  if (hint.empty()) hint = whose_option(command, name);
  return hint.empty() ? " (--help lists them)" : hint;
}

/// Of the first argument that the command did not take.
std::string unexpected_argument(const CLI::App& command, const std::string& word) {
  const std::string prefix = command.get_parent() == nullptr ? "" : command.get_name() + ": ";
  if (!word.starts_with("-") || word == "-")
    return fmt::format("{}one argument too many (got {})", prefix, word);
  const std::string typed = word.substr(0, word.find('='));
  if (typed.starts_with("--") && has_option(command, typed.substr(2)))
    return fmt::format("{}{} stands behind the command's name, not before it", prefix, typed);
  return fmt::format("{}unknown option {}{}", prefix, typed, option_hint(command, typed));
}

/// What CLI11 says by itself of an option's value, in this program's words.
std::string in_plain_words(const std::string& text) {
  const auto parted = [&text](std::string_view before, std::string_view between) {
    const std::size_t at = text.find(between);
    return text.starts_with(before) && at != std::string::npos
               ? std::optional(std::pair(text.substr(before.size(), at - before.size()),
                                         text.substr(at + between.size())))
               : std::nullopt;
  };
  if (const auto flag = parted("Could not convert: ", " = "))
    return fmt::format("{}: not a switch's value (got {}, allowed on, off)", flag->first, flag->second);
  if (const auto none = parted("", ": 1 required "))
    return fmt::format("{}: has no value (allowed {})", none->first,
                       none->second.substr(0, none->second.rfind(" missing")));
  return text;
}

}  // namespace

std::span<const OptionSynonym> option_synonyms() {
  return synonyms;
}

std::string unknown_command_text(const CLI::App& program, const std::string& word) {
  if (looks_like_a_scene(word))
    return fmt::format("{0}: not a command; did you mean gnomon compare {0}?", word);
  const std::string hint = did_you_mean(word, command_names(program));
  return fmt::format("{}: not a command{}", word, hint.empty() ? " (see gnomon --help)" : hint);
}

std::string parse_failure_text(const CLI::App& program, const CLI::ParseError& error) {
  const std::vector<CLI::App*> chosen = program.get_subcommands();
  const CLI::App& command = chosen.empty() ? program : *chosen.front();
  const bool has_extras = dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr || chosen.empty();
  const std::vector<std::string> left_over = program.remaining(true);
  if (has_extras && !left_over.empty()) return unexpected_argument(command, left_over.front());
  return (chosen.empty() ? "" : command.get_name() + ": ") + in_plain_words(error.what());
}

}  // namespace gnomon::app
