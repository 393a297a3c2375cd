// The settings: technique, map, biases, filter, light. Only what the technique reads is there.
#include <fmt/core.h>
#include <imgui/imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "lab/view/panels/panels.h"
#include "lab/view/state/presets.h"
#include "lab/view/window/style.h"
#include "raster/settings.h"

namespace gnomon::lab {

namespace {

/// What an option does, and what it is called on the command line.
struct Note {
  std::string_view what, acne, peter_panning;
  std::string options;

  explicit Note(const raster::MapSetting& row)
      : what(row.what),
        acne(row.acne),
        peter_panning(row.peter_panning),
        options(fmt::format("--{}", row.name)) {}
  Note(std::string_view does, std::string_view on_acne, std::string_view on_peter_panning,
       const char* options_of)
      : what(does), acne(on_acne), peter_panning(on_peter_panning), options(options_of) {}

  void show() const {
    ImGui::BeginTooltip();
    const float width = ImGui::GetFontSize() * 26.0f;
    wrapped(what, width);
    ImGui::Spacing();
    wrapped(fmt::format("Acne: {}", acne), width);
    wrapped(fmt::format("Peter-panning: {}", peter_panning), width);
    ImGui::TextDisabled("%s", options.c_str());
    ImGui::EndTooltip();
  }
  /// After an option's name, or a control with the name on it.
  void of_name() const {
    if (ImGui::IsItemHovered()) show();
  }
  /// After a control whose name stands above: for those who came to it by keyboard, to whom a name is no place.
  void of_control() const {
    if (ImGui::GetIO().NavVisible && ImGui::IsItemFocused() && ImGui::IsItemHovered()) show();
  }
};

/// The row's name above its control, with the unit at the right; below it in a narrow column.
void title_of(const raster::MapSetting& row, std::string_view unit) {
  ImGui::TextUnformatted(row.title.data(), row.title.data() + row.title.size());
  Note(row).of_name();
  if (unit.empty()) return;
  const float width = ImGui::CalcTextSize(unit.data(), unit.data() + unit.size()).x;
  const float left = ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x - width;
  const float name = ImGui::GetItemRectSize().x + ImGui::GetStyle().ItemSpacing.x;
  if (left >= ImGui::GetCursorPosX() + name) ImGui::SameLine(left);
  ImGui::TextDisabled("%.*s", static_cast<int>(unit.size()), unit.data());
}

bool slider(const Note& note, double& value, double from, double to, bool logarithmic) {
  ImGui::SetNextItemWidth(-FLT_MIN);
  const bool changed =
      ImGui::SliderScalar("##value", ImGuiDataType_Double, &value, &from, &to, "%.4g",
                          logarithmic ? ImGuiSliderFlags_Logarithmic : ImGuiSliderFlags_None);
  note.of_control();
  return changed;
}

struct RowControl {
  const raster::MapSetting& row;
  raster::MapOptions& map;
  const PanelContext& context;

  bool operator()(const raster::NumberSetting& number) const {
    title_of(row, row.slider_unit.empty() ? number.unit : row.slider_unit);
    double value = number.get(map);
    if (!slider(Note(row), value, number.slider.min, number.slider.max, number.logarithmic)) return false;
    number.set(map, value);
    return true;
  }
  bool operator()(const raster::IntegerSetting& integer) const {
    title_of(row, integer.unit);
    ImGui::SetNextItemWidth(-FLT_MIN);
    int value = integer.get(map);
    if (!integer.powers_of_two) {
      const bool changed = ImGui::SliderInt("##value", &value, integer.slider_from, integer.slider_to);
      Note(row).of_control();
      if (changed) integer.set(map, std::clamp(value, integer.slider_from, integer.slider_to));
      return changed;
    }
    const int limit = context.shown.max_map_size > 0 ? context.shown.max_map_size : integer.slider_to;
    int power = static_cast<int>(std::lround(std::log2(std::max(1, value))));
    const std::string text = fmt::format("{} x {}", value, value);
    const int most = static_cast<int>(std::log2(std::min(limit, integer.slider_to)));
    const bool changed = ImGui::SliderInt("##value", &power, 4, most, text.c_str(), ImGuiSliderFlags_NoInput);
    Note(row).of_control();
    if (changed) integer.set(map, 1 << std::clamp(power, 4, most));
    return changed;
  }
  bool operator()(const raster::SwitchSetting& flag) const {
    bool on = flag.get(map);
    const std::string label = fmt::format("{}##value", row.title);
    const bool changed = ImGui::Checkbox(label.c_str(), &on);
    Note(row).of_name();
    if (changed) flag.set(map, on);
    return changed;
  }
  bool operator()(const raster::ChoiceSetting& choice) const {
    title_of(row, {});
    const std::vector<std::string_view> names = choice.names();
    const std::size_t now = choice.get(map);
    ImGui::SetNextItemWidth(-FLT_MIN);
    bool changed = false;
    const bool open = ImGui::BeginCombo("##value", std::string(names[now]).c_str());
    if (!open) {
      Note(row).of_control();
      return false;
    }
    for (std::size_t i = 0; i < names.size(); ++i) {
      const bool chosen = i == now;
      if (ImGui::Selectable(std::string(names[i]).c_str(), chosen) && !chosen) {
        choice.set(map, i);
        changed = true;
      }
    }
    ImGui::EndCombo();
    return changed;
  }
  /// Typed as on the command line; a text that is no such list leaves the value as it is.
  bool operator()(const raster::ListSetting& list) const {
    title_of(row, list.unit);
    std::array<char, 128> text{};
    const std::string now = raster::setting_text(row, map);
    now.copy(text.data(), text.size() - 1);
    ImGui::SetNextItemWidth(-FLT_MIN);
    const bool entered =
        ImGui::InputText("##value", text.data(), text.size(), ImGuiInputTextFlags_EnterReturnsTrue);
    Note(row).of_control();
    return entered && text.data() != now && raster::set_setting(row, map, text.data()).has_value();
  }
  /// In texels whatever the unit, and beside the slider what that is in the world.
  bool operator()(const raster::ConstantBiasSetting& constant) const {
    const LivePicture& live = context.shown.live;
    if (!constant.may_be_automatic) return casters_constant(constant, live.texel_world);
    title_of(row, "texels");
    double texels = bias_texels(map.bias, live.bias_world, live.texel_world);
    bool changed = slider(Note(row), texels, constant.slider.min, constant.slider.max, false);
    if (changed) set_bias_texels(map.bias, texels, live.texel_world);
    faint(fmt::format("= {:.4g} world units along the ray", live.bias_world));
    changed |= unit();
    return changed;
  }
  /// In texels, too, whatever the unit was.
  bool casters_constant(const raster::ConstantBiasSetting& constant, double texel_world) const {
    double& value = map.bias.*constant.constant;
    raster::BiasUnit& unit = map.bias.*constant.unit;
    const bool in_texels = unit == raster::BiasUnit::texel;
    title_of(row, "texels");
    double texels = in_texels || !(texel_world > 0.0) ? value : value / texel_world;
    if (!slider(Note(row), texels, constant.slider.min, constant.slider.max, false)) return false;
    value = texels, unit = raster::BiasUnit::texel;
    return true;
  }
  bool unit() const {
    constexpr const char* names[] = {"world units", "texels", "automatic"};
    const raster::BiasUnit before = map.bias.unit;
    ImGui::SetNextItemWidth(-FLT_MIN);
    int now = static_cast<int>(before);
    if (!ImGui::Combo("##unit", &now, names, 3) || now == static_cast<int>(before)) return false;
    const LivePicture& live = context.shown.live;
    map.bias.unit = static_cast<raster::BiasUnit>(now);
    switch (map.bias.unit) {
      case raster::BiasUnit::world:
        map.bias.constant = live.bias_world;
        break;
      case raster::BiasUnit::texel:
        map.bias.constant = live.texel_world > 0.0 ? live.bias_world / live.texel_world : 0.0;
        break;
      case raster::BiasUnit::automatic:
        map.bias.constant = 1.0;
        break;
    }
    return true;
  }
};

/// The technique has a control of its own, above the groups.
bool is_shown(const raster::MapSetting& row, raster::SettingGroup group, const raster::MapOptions& map) {
  return row.group == group && row.name != "technique" && raster::reads(map, row);
}

bool group(PanelContext& context, raster::MapOptions& map, raster::SettingGroup group) {
  const auto rows = raster::map_settings();
  const bool any =
      std::any_of(rows.begin(), rows.end(), [&](const auto& row) { return is_shown(row, group, map); });
  if (!any || !ImGui::CollapsingHeader(raster::group_title(group).data(), ImGuiTreeNodeFlags_DefaultOpen))
    return false;
  bool changed = false;
  for (const raster::MapSetting& row : rows) {
    if (!is_shown(row, group, map)) continue;
    ImGui::PushID(row.name.data());
    changed |= std::visit(RowControl{row, map, context}, row.kind);
    ImGui::PopID();
  }
  ImGui::Spacing();
  return changed;
}

/// What the new technique would refuse is set aside.
void choose(raster::MapOptions& map, raster::Technique technique) {
  map.technique = technique;
  if (raster::uses_moments(technique)) map.bias.receiver_plane = map.bias.adaptive = false;
  if (raster::traits_of(technique).contents == raster::MapContents::back_depth) map.cull = raster::Cull::none;
  if (!raster::reads_setting(map, "snap")) map.snap = false;
}

bool technique(PanelContext& context, raster::MapOptions& map) {
  const LightType type = context.state.given.lights[context.state.setup.light].type;
  const Note note(*raster::find_setting("technique"));
  ImGui::TextUnformatted("Technique");
  note.of_name();
  ImGui::SetNextItemWidth(-FLT_MIN);
  bool changed = false;
  if (!ImGui::BeginCombo("##technique", std::string(raster::technique_name(map.technique)).c_str())) {
    note.of_control();
    return false;
  }
  for (const raster::TechniqueTraits& traits : raster::all_technique_traits()) {
    if (!traits.lights.has(type)) continue;
    const bool chosen = traits.technique == map.technique;
    if (ImGui::Selectable(std::string(traits.name).c_str(), chosen) && !chosen) {
      choose(map, traits.technique);
      changed = true;
    }
  }
  ImGui::EndCombo();
  return changed;
}

/// Shows a number of the light on a slider below its name.
bool light_number(const char* title, const Note& note, double& value, double from, double to,
                  const char* format) {
  ImGui::TextUnformatted(title);
  note.of_name();
  ImGui::PushID(title);
  ImGui::SetNextItemWidth(-FLT_MIN);
  const bool changed = ImGui::SliderScalar("##value", ImGuiDataType_Double, &value, &from, &to, format);
  note.of_control();
  ImGui::PopID();
  return changed;
}

/// A sun's up to twenty times the real one's; a lamp's up to a quarter of the way to the middle of the scene.
void light_extent(PanelContext& context, const Light& given) {
  constexpr double largest_sun = 10.0, largest_lamp = 0.25;
  const bool sun = given.type == LightType::directional;
  const double own = glm::length(given.position - context.state.given.centre);
  const double most = sun ? largest_sun : largest_lamp * (own > 0.0 ? own : 1.0);
  double size = light_size(posed_light(context.state));
  const Note note(
      "A large light casts soft shadows, one of size 0 sharp ones. Only pcss and hybrid draw them soft; what "
      "other techniques miss counts as light size.",
      "None; but pcss reads a wider part of the map, which needs more bias.", "None.", "--light-size");
  if (light_number("Size", note, size, 0.0, std::max(most, light_size(given)),
                   sun ? "%.2f degrees across" : "radius %.3g"))
    context.ask(Change{LightSizeTo{size}});
}

Note note_on_films() {
  return {
      "The camera or the lights move along a path; the space bar plays it and stops it. Every moment is a "
      "setting like any other, with its own labels.",
      "Acne swims over surfaces while the light moves; with csm and lispsm also while the camera moves.",
      "The gap at a contact grows and shrinks with the light's height.", "gnomon shimmer --path"};
}

void film(PanelContext& context) {
  const ViewState& state = context.state;
  if (!ImGui::CollapsingHeader("Film", ImGuiTreeNodeFlags_DefaultOpen)) return;
  const std::vector<LabFilm>& films = state.given.films;
  const LabFilm* now = state.film.film ? &films[*state.film.film] : nullptr;
  ImGui::SetNextItemWidth(-FLT_MIN);
  if (ImGui::BeginCombo("##film", now == nullptr ? "none" : now->title.c_str())) {
    if (ImGui::Selectable("none", now == nullptr)) context.ask(Change{PickFilm{}});
    for (std::size_t i = 0; i < films.size(); ++i)
      if (ImGui::Selectable(films[i].title.c_str(), now == &films[i])) context.ask(Change{PickFilm{i}});
    ImGui::EndCombo();
  } else {
    note_on_films().of_name();
  }
  if (now == nullptr) return;
  if (ImGui::Button(state.film.plays ? "Stop" : "Play")) context.ask(Change{TogglePlay{}});
  ImGui::SameLine();
  ImGui::SetNextItemWidth(-FLT_MIN);
  double seconds = state.film.seconds;
  const double from = 0.0, to = now->seconds;
  if (!ImGui::SliderScalar("##seconds", ImGuiDataType_Double, &seconds, &from, &to, "%.2f s")) return;
  context.ask(Change{PlayFilm{false}});
  context.ask(Change{FilmTo{seconds}});
}

Note note_on_place(const char* options) {
  return {"Where the light is.",
          "The flatter the light falls, the more depth a texel spans, and the more bias it takes.",
          "The flatter the light falls, the farther the same bias moves a shadow along the surface.",
          options};
}

/// A sun that was put elsewhere by hand stands there at no hour.
std::string hour_words(double hours, const app::LightPose& pose) {
  constexpr double as_near = 1.0;  // degrees
  if (std::abs(sun_at(hours).elevation_degrees - pose.elevation_degrees) > as_near)
    return "no hour of an equinox";
  const int minutes = static_cast<int>(std::lround(60.0 * hours));
  return fmt::format("{:02}:{:02}", minutes / 60, minutes % 60);
}

void lights(PanelContext& context) {
  const ViewState& state = context.state;
  if (!ImGui::CollapsingHeader("Light", ImGuiTreeNodeFlags_DefaultOpen)) return;
  if (state.given.lights.size() > 1) {
    ImGui::SetNextItemWidth(-FLT_MIN);
    if (ImGui::BeginCombo("##light", std::string(state.light_name()).c_str())) {
      for (std::uint32_t i = 0; i < state.given.lights.size(); ++i)
        if (ImGui::Selectable(state.given.lights[i].name.c_str(), i == state.setup.light))
          context.ask(Change{PickLight{i}});
      ImGui::EndCombo();
    }
  }
  const Light& light = state.given.lights[state.setup.light];
  const app::LightPose pose = current_light(state);
  double azimuth = pose.azimuth_degrees, elevation = pose.elevation_degrees;
  if (light_number("Comes from", note_on_place("--light-azimuth"), azimuth, -180.0, 180.0, "%.1f degrees"))
    context.ask(Change{LightAzimuthTo{azimuth}});
  if (light_number("Height", note_on_place("--light-elevation"), elevation, -90.0, 90.0, "%.1f degrees"))
    context.ask(Change{LightElevationTo{elevation}});
  if (light.type != LightType::directional) {
    const double own = glm::length(light.position - state.given.centre);
    double distance = pose.distance.value_or(own);
    const Note note = note_on_place("--light-distance");
    if (own > 0.0 && light_number("Distance", note, distance, 0.1 * own, 5.0 * own, "%.3g"))
      context.ask(Change{LightDistanceTo{distance}});
    return light_extent(context, light);
  }
  double hours = sun_hour(pose);
  const Note note(
      "Puts the sun where it stands at that hour of an equinox, 45 degrees north; +z is south, +x is east.",
      "The lower the sun, the more bias the ground needs.",
      "The lower the sun, the farther the same bias moves a shadow along the ground.",
      "--light-azimuth, --light-elevation");
  if (light_number("Time of day", note, hours, 6.0, 18.0, hour_words(hours, pose).c_str()))
    context.ask(Change{SunHour{hours}});
  light_extent(context, light);
}

void precision(PanelContext& context) {
  if (!ImGui::CollapsingHeader("Ray tracer")) return;
  constexpr const char* names[] = {"fast", "robust", "exact"};
  int now = static_cast<int>(context.state.setup.precision);
  const Note note(
      "What the truth is computed with: fast is float, robust has error bounds, exact has no rounding at "
      "all.",
      "None of the map. But rays that round can start inside their own surface: then the truth has acne.",
      "None.", "--precision");
  ImGui::TextUnformatted("Arithmetic of the rays");
  note.of_name();
  ImGui::SetNextItemWidth(-FLT_MIN);
  if (ImGui::Combo("##precision", &now, names, 3))
    context.ask(Change{SetPrecision{static_cast<raytrace::Precision>(now)}});
  note.of_control();
}

}  // namespace

std::string broken_to_width(std::string_view text, double width) {
  return broken_at_blanks(text, width, [](std::string_view part) {
    return static_cast<double>(ImGui::CalcTextSize(part.data(), part.data() + part.size()).x);
  });
}

void wrapped(std::string_view text, float width) {
  const float wide = width > 0.0f ? width : ImGui::GetContentRegionAvail().x;
  const std::string lines = broken_to_width(text, static_cast<double>(wide));
  ImGui::TextUnformatted(lines.c_str(), lines.c_str() + lines.size());
}

void faint(const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyle().Colors[ImGuiCol_TextDisabled]);
  wrapped(text);
  ImGui::PopStyleColor();
}

std::uint32_t colour(const glm::u8vec3& c) {
  return IM_COL32(c.r, c.g, c.b, 255);
}

void settings_panel(PanelContext& context) {
  raster::MapOptions map = context.state.setup.map;
  bool changed = technique(context, map);
  for (const raster::SettingGroup of : raster::panel_groups) changed |= group(context, map, of);
  if (changed && raster::check_map_options(map)) context.ask(Change{SetMap{map}});
  lights(context);
  film(context);
  precision(context);
}

}  // namespace gnomon::lab
