#include "app/help/manual.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "app/options/map_options.h"
#include "app/options/values.h"
#include "compare/result/option_names.h"
#include "compare/result/result_schema.h"
#include "raster/technique_traits.h"
#include "scene/light.h"

namespace gnomon::app {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t page_width = 120;  // columns

/// "- text", wrapped, further lines below the first.
std::string list_item(const std::string& text) {
  return "- " + wrap(text, 2, page_width).substr(2);
}

/// "-o,--output", or "SCENE": what an option is called in every command that has it.
std::string option_key(const CLI::Option& option) {
  return option.get_positional() ? option.get_name(true) : option.get_name(false, true);
}

/// "`-o, --output DIR`".
std::string option_heading(const CLI::Option& option) {
  return fmt::format("`{}`", option_usage(option));
}

std::string option_item(const CLI::Option& option) {
  return list_item(fmt::format("{}: {}", option_heading(option), option.get_description()));
}

/// A sweep's switch takes "off or on", which its description says at its end; the rest is what the switch
/// does in every other command.
std::string shared_text(const CLI::Option& option) {
  constexpr std::string_view values_of_a_switch = "; off or on";
  std::string text = option.get_description();
  if (text.ends_with(values_of_a_switch)) text.resize(text.size() - values_of_a_switch.size());
  return text;
}

/// SharedOptions holds the options that two commands or more describe in the same words. Of several such
/// descriptions of one option it has the one that most commands use; the others stay with their commands.
class SharedOptions {
 public:
  explicit SharedOptions(const CLI::App& program) {
    for (const CLI::App* command : program.get_subcommands({}))
      for (const CLI::Option* option : command->get_options()) count(*option);
  }
  /// The option as the shared list shows it, or null where this command's description is another.
  const CLI::Option* find(const CLI::Option& option) const {
    const Words* most = most_used(option_key(option));
    return most != nullptr && most->text == shared_text(option) ? most->option : nullptr;
  }
  std::string list() const {
    std::string text;
    for (const std::string& key : keys_)
      if (const Words* most = most_used(key)) text += option_item(*most->option);
    return text;
  }

 private:
  struct Words {
    std::string text;
    const CLI::Option* option = nullptr;  ///< the first that is described so
    int commands = 0;
  };

  void count(const CLI::Option& option) {
    const std::string key = option_key(option);
    if (option.get_name() == "--help") return;
    if (!words_.contains(key)) keys_.push_back(key);
    std::vector<Words>& known = words_[key];
    const std::string text = shared_text(option);
    auto found =
        std::find_if(known.begin(), known.end(), [&](const Words& words) { return words.text == text; });
    if (found == known.end()) found = known.insert(known.end(), {text, &option});
    ++found->commands;
  }
  const Words* most_used(const std::string& key) const {
    const auto known = words_.find(key);
    if (known == words_.end()) return nullptr;
    const auto most =
        std::max_element(known->second.begin(), known->second.end(),
                         [](const Words& a, const Words& b) { return a.commands < b.commands; });
    return most->commands > 1 ? &*most : nullptr;
  }

  std::vector<std::string> keys_;  ///< in the order in which the commands first name them
  std::map<std::string, std::vector<Words>> words_;
};

/// The command's own options, then the names of those that it shares; a shared one that takes its value in
/// another form here, as a sweep's lists, is named with that form.
std::string command_chapter(const CLI::App& command, const SharedOptions& shared) {
  std::string own, names;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_name() == "--help") continue;
    const CLI::Option* same = shared.find(*option);
    if (same == nullptr) {
      own += option_item(*option);
    } else {
      const bool same_form = option_heading(*option) == option_heading(*same);
      names += " " + (same_form ? fmt::format("`{}`", option_key(*option)) : option_heading(*option));
    }
  }
  return fmt::format("\n## gnomon {}\n\n{}\n```sh\n{}\n```\n\n{}{}{}", command.get_name(),
                     wrap(command.get_description(), 0, page_width), command.get_footer(), own,
                     own.empty() || names.empty() ? "" : "\n",
                     names.empty() ? "" : wrap("[Shared](#shared-options):" + names, 0, page_width));
}

std::string options_chapter(const CLI::App& program) {
  std::string text = "# Commands and options\n\n";
  text += wrap(
      "For whoever types a command: every option with its unit, its range and its default. An option that "
      "several commands share is described once, under [Shared options](#shared-options), and named at each "
      "of them. `gnomon COMMAND --help` prints all of a command's options in one piece. Of an option that is "
      "given again the last value counts, and a note says so.",
      0, page_width);
  text += "\n";
  for (const CLI::Option* option : program.get_options()) text += option_item(*option);
  const SharedOptions shared(program);
  for (const CLI::App* command : program.get_subcommands({})) text += command_chapter(*command, shared);
  return text + "\n## Shared options\n\n" + shared.list();
}

/// "number, null", "\"hard\" or \"pcf\"", "array of integer".
std::string type_text(const Json& schema) {
  if (schema.contains("const")) return schema["const"].dump();
  if (schema.contains("enum")) {
    std::vector<std::string> values;
    for (const Json& value : schema["enum"]) values.push_back(value.dump());
    return fmt::format("{}", fmt::join(values, ", "));
  }
  if (!schema.contains("type")) return {};
  if (!schema["type"].is_array()) return schema["type"].get<std::string>();
  return fmt::format("{}", fmt::join(schema["type"].get<std::vector<std::string>>(), " or "));
}

/// How often the schema, or a part of it, refers to each definition ("#/$defs/time").
void count_references(const Json& part, std::map<std::string, int>& counts) {
  if (part.is_object() && part.contains("$ref")) ++counts[part["$ref"].get<std::string>()];
  for (const Json& member : part)
    if (member.is_structured()) count_references(member, counts);
}

class KeyList {
 public:
  explicit KeyList(const Json& schema) : schema_(schema) { count_references(schema, counts_); }

  /// Everything below a schema, under its path: "lights[].map.bias.slope".
  void add(const Json& given, const std::string& path, const std::string& note = {}) {
    std::string description = given.value("description", note);
    if (is_shared(given)) {
      entry(path, shared_name(given), description);
      return;
    }
    const Json& schema = resolve(given);
    if (description.empty()) description = schema.value("description", std::string());
    if (schema.contains("anyOf") || schema.contains("oneOf")) {
      for (const Json& choice : schema.contains("anyOf") ? schema["anyOf"] : schema["oneOf"])
        add(choice, path, description);
      return;
    }
    if (!path.empty()) entry(path, type_text(schema), description);
    if (schema.contains("properties"))
      for (const auto& [key, member] : schema["properties"].items())
        add(member, path.empty() ? key : fmt::format("{}.{}", path, key));
    if (schema.contains("items") && schema["items"].is_object()) add(schema["items"], path + "[]");
  }
  /// The keys of each object that stands in several places, once and under its name.
  void add_shared() {
    for (const auto& [name, definition] : schema_["$defs"].items()) {
      const Json reference = {{"$ref", "#/$defs/" + name}};
      if (!is_shared(reference)) continue;
      text_ += fmt::format("\n## {}\n\n", name);
      for (const auto& [key, member] : definition["properties"].items()) add(member, key);
    }
  }
  std::string take() { return std::move(text_); }

 private:
  bool is_shared(const Json& given) const {
    if (!given.contains("$ref") || !resolve(given).contains("properties")) return false;
    return counts_.at(given["$ref"].get<std::string>()) > 1;
  }
  static std::string shared_name(const Json& given) {
    const std::string name = given["$ref"].get<std::string>().substr(std::string("#/$defs/").size());
    return fmt::format("[{0}](#{0})", name);
  }
  const Json& resolve(const Json& schema) const {
    if (!schema.contains("$ref")) return schema;
    return schema_.at(Json::json_pointer(schema["$ref"].get<std::string>().substr(1)));
  }
  // An object or a list without words of its own is told by what is in it.
  void entry(const std::string& path, const std::string& type, const std::string& description) {
    const bool is_only_a_holder = description.empty() && (type == "object" || type == "array");
    if (is_only_a_holder) return;
    text_ += list_item(fmt::format("`{}`{}{}", path, type.empty() ? "" : " (" + type + ")",
                                   description.empty() ? "" : ": " + description));
  }

  const Json& schema_;
  std::map<std::string, int> counts_;  ///< of references, by definition
  std::string text_;
};

std::string json_chapter() {
  const Json schema = compare::result_schema();
  KeyList keys(schema);
  keys.add(schema, "");
  keys.add_shared();
  const std::string intro =
      "For whoever reads results with a program: `DIR/result.json` of `gnomon compare`, `--json FILE`, "
      "and each line of `DIR/sweep.jsonl`, in the order of the file. `[]` stands for every element of a "
      "list. An object that stands in several places is described once, below the list. The schema itself"
      " is what `gnomon --manual schema` prints; installed, `share/gnomon/schema/result.schema.json`.";
  return fmt::format("# The keys of result.json\n\n{}\n{}\n{}", wrap(intro, 0, page_width),
                     wrap(schema.value("description", std::string()), 0, page_width), keys.take());
}

std::string_view contents_text(raster::MapContents contents) {
  switch (contents) {
    case raster::MapContents::nearest_depth:
      return "depth of the nearest surface";
    case raster::MapContents::back_depth:
      return "depth of the nearest surface that faces away from the light";
    case raster::MapContents::midpoint_depth:
      return "depth halfway between the two nearest surfaces";
    case raster::MapContents::moments:
      return "filtered moments of the depth";
    case raster::MapContents::pixels:
      return "list of the pixels that look it up";
    case raster::MapContents::sheets:
      return "connected pieces of surface";
    case raster::MapContents::nothing:
      return "nothing: there is no map";
  }
  return {};
}

std::string_view test_text(raster::ShadowTest test) {
  switch (test) {
    case raster::ShadowTest::single:
      return "one comparison of depths";
    case raster::ShadowTest::averaged:
      return "mean of comparisons";
    case raster::ShadowTest::moments:
      return "bound from moments";
    case raster::ShadowTest::exact:
      return "exact, without a bias";
    case raster::ShadowTest::sampled:
      return "mean of a few rays, denoised";
  }
  return {};
}

std::string_view texel_text(raster::TexelShape shape) {
  switch (shape) {
    case raster::TexelShape::of_light:
      return "as the light sees";
    case raster::TexelShape::cascades:
      return "of one width in each cascade, along the camera";
    case raster::TexelShape::warped:
      return "wider with the distance to the camera";
  }
  return {};
}

std::string lights_text(raster::LightTypeSet lights) {
  std::vector<std::string_view> names;
  for (const LightType type : {LightType::directional, LightType::point, LightType::spot})
    if (lights.has(type)) names.push_back(light_type_name(type));
  return names.size() == 3 ? "all" : fmt::format("{}", fmt::join(names, ", "));
}

/// The options that this technique reads and not all of its kind, with their dashes.
std::string options_text(raster::Technique technique) {
  std::vector<std::string> names;
  for (const raster::MapSetting& setting : raster::map_settings())
    if (setting.read_by != nullptr && raster::reads(raster::traits_of(technique), setting))
      names.push_back(fmt::format("`--{}`", setting.name));
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, " "));
}

std::string techniques_chapter() {
  const std::string intro =
      "For whoever chooses a technique: what `--technique` takes. For each one the table says what a "
      "texel of the map holds, how a pixel's visibility comes from it, which lights it is for, how wide "
      "its texels are, the slope bias where none is asked for, and the options that it reads of those "
      "that not every technique reads ([options](options.md#shared-options)). `pcf` reads some with some "
      "of its kernels alone.";
  std::string text = fmt::format(
      "# The techniques\n\n{}\n"
      "| technique | texel holds | decides by | lights | texels | default slope bias | reads |\n"
      "|---|---|---|---|---|---|---|\n",
      wrap(intro, 0, page_width));
  for (const raster::TechniqueTraits& t : raster::all_technique_traits()) {
    const bool biased = raster::compares_depths(t.technique);
    text += fmt::format("| `{}` | {} | {} | {} | {} | {} | {} |\n", t.name, contents_text(t.contents),
                        test_text(t.test), lights_text(t.lights), texel_text(t.texels),
                        biased ? number_text(t.default_slope_bias) : "none", options_text(t.technique));
  }
  return text;
}

}  // namespace

std::string manual_chapter(const CLI::App& program, std::string_view chapter) {
  if (chapter == "options") return options_chapter(program);
  if (chapter == "json") return json_chapter();
  if (chapter == "schema") return compare::result_schema().dump(2) + "\n";
  if (chapter == "techniques") return techniques_chapter();
  return {};
}

}  // namespace gnomon::app
