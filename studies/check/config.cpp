#include "studies/check/config.h"

#define TOML_EXCEPTIONS 0  // NOLINT: the library's own switch
#include <fmt/core.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <set>

#include "scene/base/option_text.h"
#include "scene/files/path_status.h"
#include "scene/files/read_file.h"

namespace gnomon::studies {
namespace {

constexpr std::array<std::string_view, 4> top_keys{"baseline", "limits", "scene", "settings"};
constexpr std::array<std::string_view, 5> scene_keys{"file", "limits", "name", "settings", "view"};
constexpr std::array<std::string_view, 3> view_keys{"limits", "name", "settings"};
constexpr std::array<std::string_view, 2> limit_keys{"fail-above", "fail-worse"};

using Values = std::vector<ConfigValue>;

class Reader {
 public:
  explicit Reader(std::string path) { config_.path = std::move(path); }

  Expected<CheckConfig> read(const toml::table& file) {
    if (auto known = only(file, "", top_keys); !known) return fail(known.error());
    if (const toml::node* node = file.get("baseline")) {
      if (!node->is_string()) return wrong(*node, "baseline", "not a folder (allowed a text)");
      auto folder = word(*node, "baseline", "baseline");
      if (!folder) return fail(folder.error());
      config_.baseline = beside(folder->text);
    }
    CheckRun all;
    if (auto taken = take_values(file, "", all); !taken) return fail(taken.error());
    const toml::array* scenes = file["scene"].as_array();
    if (scenes == nullptr || scenes->empty())
      return fail(Error{ErrorKind::bad_input, "has no [[scene]]", config_.path});
    std::size_t index = 0;
    for (const toml::node& scene : *scenes)
      if (auto added = add_scene(scene, fmt::format("scene[{}]", index++), all); !added)
        return fail(added.error());
    return std::move(config_);
  }

 private:
  ConfigValue at(const toml::node& node, std::string key, std::string field) const {
    const toml::source_position& begin = node.source().begin;
    return {std::move(key), {}, std::move(field), int(begin.line), int(begin.column)};
  }
  tl::unexpected<Error> wrong(const toml::node& node, const std::string& field, std::string reason) const {
    return fail(config_.wrong(at(node, {}, field), std::move(reason)));
  }

  Expected<void> only(const toml::table& table, const std::string& field,
                      std::span<const std::string_view> known) const {
    for (const auto& [key, node] : table) {
      const std::string_view name = key.str();
      if (std::ranges::find(known, name) != known.end()) continue;
      std::string hint = did_you_mean(name, known);
      if (hint.empty()) hint = fmt::format(" (allowed {})", joined(known));
      return fail(config_.wrong(
          {{}, {}, join(field, name), int(key.source().begin.line), int(key.source().begin.column)},
          "unknown key" + hint));
    }
    return {};
  }
  static std::string joined(std::span<const std::string_view> names) {
    std::string text;
    for (const std::string_view name : names) text += (text.empty() ? "" : ", ") + std::string(name);
    return text;
  }
  static std::string join(const std::string& field, std::string_view name) {
    return field.empty() ? std::string(name) : fmt::format("{}.{}", field, name);
  }

  /// As an option's word.
  Expected<ConfigValue> word(const toml::node& node, const std::string& key, const std::string& field) const {
    ConfigValue value = at(node, key, field);
    if (const auto* text = node.as_string())
      value.text = text->get();
    else if (const auto* integer = node.as_integer())
      value.text = std::to_string(integer->get());
    else if (const auto* number = node.as_floating_point())
      value.text = number_text(number->get());
    else if (const auto* boolean = node.as_boolean())
      value.text = boolean->get() ? "on" : "off";
    else if (const toml::array* list = node.as_array())
      return words(*list, std::move(value));
    else
      return wrong(node, field, "not a value (allowed a text, a number, true, false, or a list of them)");
    return value;
  }
  Expected<ConfigValue> words(const toml::array& list, ConfigValue value) const {
    for (const toml::node& one : list) {
      if (one.is_array() || one.is_table()) return wrong(one, value.field, "not a value in a list");
      const auto part = word(one, value.key, value.field);
      if (!part) return part;
      value.text += (value.text.empty() ? "" : ",") + part->text;
    }
    return value;
  }

  Expected<void> take(const toml::table& from, const std::string& name, const std::string& field,
                      Values& into) const {
    const toml::node* node = from.get(name);
    if (node == nullptr) return {};
    const toml::table* table = node->as_table();
    if (table == nullptr) return wrong(*node, join(field, name), "not a table");
    if (name == "limits")
      if (auto known = only(*table, join(field, name), limit_keys); !known) return known;
    for (const auto& [key, value] : *table) {
      auto read = word(value, std::string(key.str()), join(join(field, name), key.str()));
      if (!read) return fail(read.error());
      const auto same = std::ranges::find(into, read->key, &ConfigValue::key);
      if (same == into.end())
        into.push_back(std::move(*read));
      else
        *same = std::move(*read);
    }
    return {};
  }
  Expected<void> take_values(const toml::table& from, const std::string& field, CheckRun& run) const {
    if (auto taken = take(from, "settings", field, run.settings); !taken) return taken;
    return take(from, "limits", field, run.limits);
  }

  /// A name is a folder's.
  Expected<std::string> name_of(const toml::table& table, const std::string& field,
                                const std::string& fallback) const {
    const toml::node* node = table.get("name");
    std::string name = fallback;
    if (node != nullptr) {
      if (!node->is_string()) return wrong(*node, field + ".name", "not a text");
      name = node->as_string()->get();
    }
    const bool plain = !name.empty() && name.front() != '.' && name.front() != '-' &&
                       std::ranges::all_of(name, [](unsigned char c) {
                         return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.';
                       });
    if (!plain)
      return wrong(
          node != nullptr ? *node : static_cast<const toml::node&>(table), field + ".name",
          fmt::format("not a name of a folder (got {}, allowed letters, digits, _ - .)", printable(name)));
    return name;
  }

  Expected<void> add_scene(const toml::node& node, const std::string& field, const CheckRun& all) {
    const toml::table* table = node.as_table();
    if (table == nullptr) return wrong(node, field, "not a table");
    if (auto known = only(*table, field, scene_keys); !known) return known;
    const toml::node* file = table->get("file");
    if (file == nullptr || !file->is_string())
      return wrong(node, field + ".file", "is missing (allowed a scene's file or name)");
    CheckRun run = all;
    const std::string given = file->as_string()->get();
    run.place = at(*file, "file", field + ".file");
    run.place.text = given;
    run.scene = file_kind_or_none(beside(given)) == FileKind::none ? given : beside(given);
    auto name = name_of(*table, field, std::filesystem::path(given).stem().string());
    if (!name) return fail(name.error());
    run.name = *name;
    if (auto taken = take_values(*table, field, run); !taken) return taken;
    const toml::node* views = table->get("view");
    if (views == nullptr) return add(std::move(run), node);
    if (!views->is_array() || views->as_array()->empty())
      return wrong(*views, field + ".view", "not a list of [[scene.view]]");
    std::size_t index = 0;
    for (const toml::node& view : *views->as_array())
      if (auto added = add_view(view, fmt::format("{}.view[{}]", field, index++), run); !added) return added;
    return {};
  }
  Expected<void> add_view(const toml::node& node, const std::string& field, CheckRun run) {
    const toml::table* table = node.as_table();
    if (table == nullptr) return wrong(node, field, "not a table");
    if (auto known = only(*table, field, view_keys); !known) return known;
    const auto name = name_of(*table, field, "");
    if (!name) return fail(name.error());
    run.name += "-" + *name;
    if (auto taken = take_values(*table, field, run); !taken) return taken;
    return add(std::move(run), node);
  }
  Expected<void> add(CheckRun run, const toml::node& node) {
    for (const CheckRun& other : config_.runs)
      if (is_same_word(other.name, run.name))
        return wrong(node, "name",
                     fmt::format("two runs are called {}; name = \"...\" tells them apart", run.name));
    config_.runs.push_back(std::move(run));
    return {};
  }

  std::string beside(const std::string& named) const {
    const std::filesystem::path path(named);
    return path.is_absolute() ? named : (std::filesystem::path(config_.path).parent_path() / path).string();
  }

  CheckConfig config_;
};

}  // namespace

bool is_limit(const std::string& key) {
  return std::ranges::find(limit_keys, key) != limit_keys.end();
}

Error CheckConfig::wrong(const ConfigValue& value, std::string reason) const {
  return {ErrorKind::bad_input, std::move(reason), path, value.line, value.column, value.field};
}

Expected<CheckConfig> read_check_config(const std::string& path) {
  const auto text = read_file(path);
  if (!text) return fail(text.error());
  const toml::parse_result file = toml::parse(without_byte_order_mark(*text), path);
  if (!file) {
    const toml::source_position& at = file.error().source().begin;
    return fail(Error{ErrorKind::bad_input, std::string(file.error().description()), path, int(at.line),
                      int(at.column)});
  }
  return Reader(path).read(file.table());
}

}  // namespace gnomon::studies
