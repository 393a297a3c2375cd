#include "studies/diff/same_view.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace gnomon::studies {
namespace {

using Json = nlohmann::ordered_json;

std::string text_of(const Json& value) {
  if (value.is_number_float()) return fmt::format("{:.4g}", value.get<double>());
  return value.is_string() ? value.get<std::string>() : value.is_null() ? "none" : value.dump();
}

std::string other_scene(const Json& a, const Json& b, const DiffOptions& options) {
  const std::string was = a.at("path").get<std::string>(), is = b.at("path").get<std::string>();
  if (a.at("sha256") == b.at("sha256") && a.at("triangles") == b.at("triangles") &&
      a.at("shapes") == b.at("shapes"))
    return {};
  if (a.at("name") != b.at("name")) return fmt::format("they show another scene ({}; {})", was, is);
  if (options.changed_scene) return {};
  return fmt::format("the scene has changed in between ({}; {}); {}", was, is, options.if_changed);
}

std::string size_text(const Json& size) {
  return fmt::format("{}x{}", size.at("width").get<int>(), size.at("height").get<int>());
}

std::string other_lights(const Json& a, const Json& b) {
  const auto names = [](const Json& lights) {
    std::string text;
    for (const Json& light : lights)
      text += (text.empty() ? "" : ", ") + light.at("light").at("name").get<std::string>();
    return text;
  };
  if (names(a) != names(b)) return fmt::format("their lights are others ({}; {})", names(a), names(b));
  for (std::size_t i = 0; i < a.size(); ++i)
    if (a[i].at("light") != b[i].at("light"))
      return fmt::format("light {} is another: it has moved, or is of another kind or size",
                         a[i].at("light").at("name").get<std::string>());
  return {};
}

std::string drawn_by(const Json& result) {
  return result.contains("judged") ? "another renderer" : "Gnomon";
}

void note_other(std::vector<std::string>& notes, std::string_view what, const Json& a, const Json& b) {
  if (a != b) notes.push_back(fmt::format("{}: {} before, {} now", what, text_of(a), text_of(b)));
}

/// What was measured of a map, not asked for.
bool is_measured(const std::string& key) {
  return key == "rays.rays" || std::ranges::any_of(
                                   std::initializer_list<const char*>{
                                       "window", "texel_world", "times_ms", "_per_ray", "taps", "silhouette",
                                       "receivers", "history_bytes", "minimum_variance", "_world"},
                                   [&](const char* part) { return key.find(part) != std::string::npos; });
}

void add_settings(std::vector<std::pair<std::string, Json>>& out, const std::string& key, const Json& value) {
  if (is_measured(key)) return;
  if (!value.is_object()) return out.emplace_back(key, value), void();
  for (const auto& [name, below] : value.items())
    add_settings(out, key.empty() ? name : key + "." + name, below);
}

const Json& find_setting(const std::vector<std::pair<std::string, Json>>& settings, const std::string& key) {
  static const Json none;
  const auto found = std::ranges::find(settings, key, &std::pair<std::string, Json>::first);
  return found == settings.end() ? none : found->second;
}

/// A bias that nobody set follows from the map's size.
bool follows(const std::string& key, const std::vector<std::pair<std::string, Json>>& before,
             const std::vector<std::pair<std::string, Json>>& after) {
  return key.starts_with("bias.constant") && find_setting(before, "bias.unit") == "auto" &&
         find_setting(after, "bias.unit") == "auto";
}

}  // namespace

std::string why_not_comparable(const Json& a, const Json& b, const DiffOptions& options) {
  if (drawn_by(a) != drawn_by(b))
    return fmt::format("{} drew one of them, {} the other", drawn_by(a), drawn_by(b));
  if (std::string why = other_scene(a.at("scene"), b.at("scene"), options); !why.empty()) return why;
  if (a.at("size") != b.at("size"))
    return fmt::format("their pictures have other sizes ({}; {})", size_text(a.at("size")),
                       size_text(b.at("size")));
  if (a.value("camera", Json()) != b.value("camera", Json()))
    return "they are seen from other places (camera)";
  return other_lights(a.at("lights"), b.at("lights"));
}

std::vector<std::string> notes_on(const Json& a, const Json& b) {
  std::vector<std::string> notes;
  note_other(notes, "the program", a.at("version"), b.at("version"));
  note_other(notes, "rays' precision", a.at("precision"), b.at("precision"));
  if (a.contains("judged"))
    note_other(notes, "the renderer", a["judged"].at("renderer").at("name"),
               b["judged"].at("renderer").at("name"));
  note_other(notes, "the machine (times tell nothing)", a.at("machine").at("cpu"), b.at("machine").at("cpu"));
  note_other(notes, "the scene's file", a.at("scene").at("path"), b.at("scene").at("path"));
  return notes;
}

std::vector<ChangedSetting> changed_settings(const Json& a, const Json& b) {
  std::vector<ChangedSetting> changed;
  for (std::size_t i = 0; i < b.at("lights").size(); ++i) {
    std::vector<std::pair<std::string, Json>> before, after;
    add_settings(before, "", a["lights"].at(i).at("map"));
    add_settings(after, "", b["lights"].at(i).at("map"));
    for (const auto& [key, value] : before)
      if (value != find_setting(after, key) && !follows(key, before, after))
        changed.push_back({key, text_of(value), text_of(find_setting(after, key))});
    for (const auto& [key, value] : after)
      if (find_setting(before, key).is_null() && !value.is_null())
        changed.push_back({key, "none", text_of(value)});
  }
  const auto same = [](const ChangedSetting& x, const ChangedSetting& y) {
    return x.key == y.key && x.before == y.before && x.after == y.after;
  };
  for (auto it = changed.begin(); it != changed.end(); ++it)
    changed.erase(std::remove_if(it + 1, changed.end(), [&](const auto& other) { return same(*it, other); }),
                  changed.end());
  return changed;
}

}  // namespace gnomon::studies
