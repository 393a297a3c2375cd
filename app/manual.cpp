#include "app/manual.h"

#include <embedded/schemas.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/map_options.h"
#include "app/values.h"
#include "compare/result/option_names.h"
#include "raster/technique_traits.h"
#include "scene/light.h"

namespace gnomon::app {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t page_width = 120;  // columns
constexpr const char* written_by_the_program =
    "<!-- Written by the program: docs/make_manual.sh. Edits here are lost. -->\n";

/// "- text", wrapped, further lines below the first.
std::string list_item(const std::string& text) {
  return "- " + wrap(text, 2, page_width).substr(2);
}

std::string option_item(const CLI::Option& option) {
  std::string names = option.get_positional() ? option.get_name(true) : option.get_name(false, true);
  for (std::size_t comma = names.find(','); comma != std::string::npos; comma = names.find(',', comma + 2))
    names.replace(comma, 1, ", ");
  const bool takes_value = !option.get_positional() && !option.get_type_name().empty();
  return list_item(fmt::format("`{}{}`: {}", names, takes_value ? " " + option.get_type_name() : "",
                               option.get_description()));
}

std::string command_chapter(const CLI::App& command) {
  std::string text = fmt::format("\n## gnomon {}\n\n{}\n```sh\n{}\n```\n\n", command.get_name(),
                                 wrap(command.get_description(), 0, page_width), command.get_footer());
  for (const CLI::Option* option : command.get_options())
    if (option->get_name() != "--help") text += option_item(*option);
  return text;
}

std::string options_chapter(const CLI::App& program) {
  std::string text = fmt::format(
      "{}# Commands and options\n\nEvery option with its unit, its range and its default, as `gnomon COMMAND "
      "--help` "
      "prints them.\n\n",
      written_by_the_program);
  for (const CLI::Option* option : program.get_options()) text += option_item(*option);
  for (const CLI::App* command : program.get_subcommands({})) text += command_chapter(*command);
  return text;
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

class KeyList {
 public:
  explicit KeyList(const Json& schema) : schema_(schema) {}

  /// Everything below a schema, under its path: "lights[].map.bias.slope".
  void add(const Json& given, const std::string& path, const std::string& note = {}) {
    std::string description = given.value("description", note);
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
        add(member, path.empty() ? key : path + "." + key);
    if (schema.contains("items") && schema["items"].is_object()) add(schema["items"], path + "[]");
  }
  std::string take() { return std::move(text_); }

 private:
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
  std::string text_;
};

std::string json_chapter() {
  const Json schema = Json::parse(embedded::schemas("result.schema.json"));
  KeyList keys(schema);
  keys.add(schema, "");
  return fmt::format(
      "{}# The keys of result.json\n\n{}\n`DIR/result.json` of `gnomon compare`, `--json FILE`, and each "
      "line of "
      "`DIR/sweep.jsonl`, in the order of\nthe file. `[]` stands for every element of a list. The schema "
      "itself is "
      "`compare/result/result.schema.json`;\ninstalled, `share/gnomon/schema/result.schema.json`.\n\n{}",
      written_by_the_program, wrap(schema.value("description", std::string()), 0, page_width), keys.take());
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
  std::string text = fmt::format(
      "{}# The techniques\n\nWhat `--technique` takes: what a texel of the map holds, how a pixel's "
      "visibility "
      "comes from it, which lights it\nis for, how wide its texels are, the slope bias where none is asked "
      "for, "
      "and the options that it reads of those\nthat not every technique reads (`options.md` says what they "
      "do). "
      "`pcf` reads some with some of its kernels alone.\n\n"
      "| technique | texel holds | decides by | lights | texels | default slope bias | reads |\n"
      "|---|---|---|---|---|---|---|\n",
      written_by_the_program);
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
  if (chapter == "techniques") return techniques_chapter();
  return {};
}

}  // namespace gnomon::app
