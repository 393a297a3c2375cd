#include "judge/commands/judge_options.h"

#include <algorithm>
#include <sstream>

#include "app/options/option_kinds.h"

namespace gnomon::app {
namespace {

using judge::Capture;

void add_text(CLI::App& app, const char* name, const char* type, const char* text, CaptureOptions& options,
              std::string& field) {
  add_value(app, name, type, text, [&options, &field](const std::string& value) -> Expected<void> {
    field = value, options.any = true;
    return {};
  });
}

template <class Enum, std::size_t N>
void add_named(CLI::App& app, const char* name, const char* text,
               const std::array<std::string_view, N>& names, CaptureOptions& options,
               const std::function<void(Enum)>& store) {
  std::vector<std::pair<std::string_view, Enum>> choices;
  for (std::size_t i = 0; i < N; ++i) choices.emplace_back(names[i], static_cast<Enum>(i));
  const std::string help =
      describe(text, choice_names<Enum>(Choices<Enum>(choices), " or "), "the capture's");
  add_value(app, name, "NAME", help, [choices, store, &options](const std::string& value) -> Expected<void> {
    const auto chosen = parse_choice<Enum>(value, Choices<Enum>(choices));
    if (!chosen) return fail(chosen.error());
    store(*chosen), options.any = true;
    return {};
  });
}

void add_real(CLI::App& app, const char* name, OptionRange range, const char* unit, const char* text,
              CaptureOptions& options, const std::function<void(double)>& store) {
  const std::string help = describe(text, fmt::format("{}, {}", unit, range_text(range)), "the capture's");
  add_value(app, name, "NUMBER", help, [range, store, &options](const std::string& value) -> Expected<void> {
    const auto number = parse_number(value, range);
    if (!number) return fail(number.error());
    store(*number), options.any = true;
    return {};
  });
}

void add_lists(CLI::App& app, CaptureOptions& options) {
  app.add_option("--renderer-setting", options.settings,
                 "what its shadow was drawn with, for the report; may be given again [default the capture's]")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
  app.add_option("--map", options.map_files,
                 "the layers of the light's depth map [EXR; default the capture's]")
      ->type_name("FILE.exr...");
  app.add_option(
         "--map-matrix", options.map_matrices,
         "world-to-clip matrix of each layer: 16 numbers, column-major, with commas or spaces between "
         "[default the capture's]")
      ->type_name("NUMBERS...");
}

void add_map_parts(CLI::App& app, CaptureOptions& o) {
  add_lists(app, o);
  add_named<judge::StoredDepth>(app, "--map-convention", "what the map's texels hold",
                                judge::names_of(judge::stored_conventions), o,
                                [&o](auto v) { o.map_convention = v; });
  add_named<judge::RowOrder>(app, "--map-rows", "which row of the map comes first", judge::row_order_names, o,
                             [&o](auto v) { o.map_rows = v; });
  add_real(app, "--map-bias", raster::bias_range, "stored depth",
           "constant bias of the test; positive takes shadow away", o,
           [&o](double v) { o.bias_constant = v; });
  add_real(app, "--map-slope-bias", raster::bias_range, "multiples of the texel's own depth slope",
           "slope bias of the test", o, [&o](double v) { o.bias_slope = v; });
  add_real(app, "--map-normal-offset", {0.0, 1e30}, "world units", "offset along the receiver's normal", o,
           [&o](double v) { o.bias_normal_offset = v; });
  add_real(app, "--map-caster-bias", raster::bias_range, "stored depth",
           "by how much casters were moved from the light in all layers", o,
           [&o](double v) { o.caster_constant = v; });
  add_real(app, "--map-caster-bias-world", raster::bias_range, "world units along the light's ray",
           "the same in another unit", o, [&o](double v) { o.caster_constant_world = v; });
  add_real(app, "--map-caster-slope-bias", raster::bias_range,
           "multiples of the stored depth's slope from texel to texel",
           "factor of the casters' polygon offset", o, [&o](double v) { o.caster_slope = v; });
  add_real(app, "--map-caster-bias-clamp", raster::bias_range, "stored depth",
           "the most that constant and slope add; 0 is no limit", o, [&o](double v) { o.caster_clamp = v; });
  add_named<judge::FilterName>(app, "--map-filter", "what the renderer averages", judge::filter_names, o,
                               [&o](auto v) { o.filter_kind = v; });
  add_real(app, "--map-filter-radius", {0.0, 64.0, true}, "texels", "how far the filter reads", o,
           [&o](double v) { o.filter_radius = v; });
}

void add_depth_parts(CLI::App& app, CaptureOptions& o) {
  const auto depth = [&o]() -> judge::CapturedDepth& {
    if (!o.given.depth) o.given.depth.emplace();
    return *o.given.depth;
  };
  add_value(app, "--depth", "FILE", "the camera's depth buffer [EXR or 16-bit PNG; default the capture's]",
            [depth, &o](const std::string& value) -> Expected<void> {
              depth().file = value, o.any = true;
              return {};
            });
  add_named<judge::PixelDepth>(app, "--depth-convention", "what it holds", judge::pixel_depth_names, o,
                               [depth](auto v) { depth().convention = v; });
  add_real(app, "--depth-near", {0.0, 1e30}, "world units", "of zero_to_one and reversed", o,
           [depth](double v) { depth().near = v; });
  add_real(app, "--depth-far", {0.0, 1e30}, "world units", "of zero_to_one and reversed", o,
           [depth](double v) { depth().far = v; });
}

Expected<Mat4> parse_matrix(const std::string& text) {
  std::string spaced = text;
  std::replace(spaced.begin(), spaced.end(), ',', ' ');
  std::istringstream words(spaced);
  std::vector<double> numbers;
  for (std::string word; words >> word;) {
    const auto number = parse_number(word, raster::bias_range);
    if (!number) return fail(ErrorKind::usage, "--map-matrix: " + number.error().reason);
    numbers.push_back(*number);
  }
  if (numbers.size() != 16)
    return fail(ErrorKind::usage,
                fmt::format("--map-matrix: needs 16 numbers for each layer (got {})", numbers.size()));
  Mat4 matrix(0.0);
  for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = numbers[static_cast<std::size_t>(i)];
  return matrix;
}

void set_caster_bias(judge::CapturedLayer& layer, const CaptureOptions& o) {
  using Bias = judge::CapturedCasterBias;
  for (const auto& [given, field] :
       {std::pair(o.caster_constant, &Bias::constant),
        std::pair(o.caster_constant_world, &Bias::constant_world), std::pair(o.caster_slope, &Bias::slope),
        std::pair(o.caster_clamp, &Bias::clamp)}) {
    if (!given) continue;
    if (!layer.caster_bias) layer.caster_bias.emplace();
    (*layer.caster_bias).*field = *given;
  }
}

Expected<void> set_map(Capture& capture, const CaptureOptions& o) {
  if (!o.map_files.empty()) {
    capture.map.clear();
    for (const std::string& file : o.map_files) capture.map.emplace_back().depth = file;
  }
  if (!o.map_matrices.empty() && o.map_matrices.size() != capture.map.size())
    return fail(ErrorKind::usage,
                fmt::format("--map-matrix: one for each layer of the map (got {}, layers {})",
                            o.map_matrices.size(), capture.map.size()));
  for (std::size_t i = 0; i < o.map_matrices.size(); ++i) {
    const auto matrix = parse_matrix(o.map_matrices[i]);
    if (!matrix) return fail(matrix.error());
    capture.map[i].clip_from_world = *matrix;
  }
  for (judge::CapturedLayer& layer : capture.map) {
    if (o.map_convention) layer.convention = o.map_convention;
    if (o.map_rows) layer.rows = o.map_rows;
    set_caster_bias(layer, o);
  }
  return {};
}

Expected<void> set_settings(Capture& capture, const std::vector<std::string>& settings) {
  for (const std::string& text : settings) {
    const std::size_t at = text.find('=');
    if (at == 0 || at == std::string::npos)
      return fail(ErrorKind::usage,
                  fmt::format("--renderer-setting: not understood (got {}, allowed NAME=VALUE)", text));
    const std::string name = text.substr(0, at);
    std::erase_if(capture.settings, [&](const auto& setting) { return setting.first == name; });
    capture.settings.emplace_back(name, text.substr(at + 1));
  }
  return {};
}

std::string first_bias_option(const CaptureOptions& o) {
  return o.bias_constant ? "--map-bias" : o.bias_slope ? "--map-slope-bias" : "--map-normal-offset";
}

/// "--depth-near" of "depth.near", "--map-rows" of "map[0].rows"; empty of what no option gives.
std::string option_of(const std::string& field, const CaptureOptions& o) {
  static constexpr std::string_view same[] = {"renderer",   "scene",    "camera",     "light",    "size",
                                              "visibility", "shadowed", "unshadowed", "position", "depth"};
  if (std::find(std::begin(same), std::end(same), field) != std::end(same)) return "--" + field;
  if (field == "bias") return first_bias_option(o);
  if (field == "filter") return o.filter_kind ? "--map-filter" : "--map-filter-radius";
  static constexpr std::pair<std::string_view, const char*> others[] = {
      {"filter.kind", "--map-filter"},
      {"bias.slope", "--map-slope-bias"},
      {"caster_bias.constant", "--map-caster-bias"},
      {"caster_bias.slope", "--map-caster-slope-bias"},
      {"caster_bias.clamp", "--map-caster-bias-clamp"}};
  for (const auto& [end, option] : others)
    if (field == end || field.ends_with("]." + std::string(end))) return option;
  const std::size_t dot = field.find('.');
  if (dot == std::string::npos) return field.starts_with("map") ? "--map" : "";
  const std::string part = field.substr(dot + 1);
  if (field.starts_with("depth.")) return part == "file" ? "--depth" : "--depth-" + part;
  if (!field.starts_with("map[")) return {};
  return part == "depth" ? "--map" : part == "clip_from_world" ? "--map-matrix" : "--map-" + part;
}

}  // namespace

Error named_by_option(Error error, const CaptureOptions& options) {
  const std::string option = option_of(error.field, options);
  if (option.empty()) return error;
  error.file.clear();
  error.field = option;
  return error;
}

Error usage_error(Error error, const CaptureOptions& options) {
  error.kind = ErrorKind::usage;
  return named_by_option(std::move(error), options);
}

void add_capture_options(CLI::App& app, CaptureOptions& o) {
  Capture& c = o.given;
  add_text(app, "--renderer", "NAME", "who drew it [default the capture's]", o, c.renderer);
  add_text(app, "--renderer-version", "TEXT", "its version [default the capture's]", o, c.version);
  add_named<judge::RendererKind>(app, "--renderer-kind", "how it makes shadows", judge::renderer_kind_names,
                                 o, [&c](auto v) { c.kind = v; });
  add_text(app, "--scene", "SCENE", "what it loaded [default the capture's]", o, c.scene);
  add_text(app, "--camera", "NAME", "name or number, from 0 [default the capture's]", o, c.camera);
  add_text(
      app, "--light", "NAME",
      "name or number, from 0; of several the one to judge; of a recorded frame a number from 1 [default all "
      "of them]",
      o, c.light);
  add_text(app, "--visibility", "FILE", "picture of the visibility [EXR or PNG; default the capture's]", o,
           c.visibility);
  add_text(app, "--shadowed", "FILE",
           "linear picture with shadows [EXR or 16-bit PNG; default the capture's]", o, c.shadowed);
  add_text(app, "--unshadowed", "FILE",
           "linear picture without shadows [EXR or 16-bit PNG; default the capture's]", o, c.unshadowed);
  add_text(app, "--position", "FILE.exr", "world positions [EXR; default the capture's]", o, c.position);
  add_value(app, "--size", "WxH", describe("of the pictures", size_choices(), "the capture's"),
            [&o](const std::string& value) {
              o.any = true;
              return assign(o.given.size, parse_size(value));
            });
  add_real(app, "--strength", {0.0, 1.0, true}, "share", "of the shadow; full shadow is drawn as 1 less that",
           o, [&c](double v) { c.strength = v; });
  add_depth_parts(app, o);
  add_map_parts(app, o);
}

Expected<Capture> with_options(Capture capture, const CaptureOptions& o) {
  const Capture& given = o.given;
  if (!given.visibility.empty()) capture.shadowed.clear(), capture.unshadowed.clear();
  if (!given.shadowed.empty() || !given.unshadowed.empty()) capture.visibility.clear();
  if (!given.position.empty()) capture.depth.reset();
  if (given.depth) capture.position.clear();
  for (std::string Capture::*field :
       {&Capture::renderer, &Capture::version, &Capture::scene, &Capture::camera, &Capture::light,
        &Capture::visibility, &Capture::shadowed, &Capture::unshadowed, &Capture::position})
    if (!(given.*field).empty()) capture.*field = given.*field;
  if (given.size.pixels() > 0) capture.size = given.size;
  if (given.strength) capture.strength = given.strength;
  if (given.kind) capture.kind = given.kind;
  if (const auto set = set_settings(capture, o.settings); !set) return fail(set.error());
  if (given.depth) {
    judge::CapturedDepth& depth = capture.depth ? *capture.depth : capture.depth.emplace();
    if (!given.depth->file.empty()) depth.file = given.depth->file;
    if (given.depth->convention) depth.convention = given.depth->convention;
    if (given.depth->near) depth.near = given.depth->near;
    if (given.depth->far) depth.far = given.depth->far;
  }
  if (o.bias_constant || o.bias_slope || o.bias_normal_offset) {
    judge::CapturedBias& bias = capture.bias ? *capture.bias : capture.bias.emplace();
    bias.constant_depth = o.bias_constant.value_or(bias.constant_depth);
    bias.slope = o.bias_slope.value_or(bias.slope);
    bias.normal_offset_world = o.bias_normal_offset.value_or(bias.normal_offset_world);
  }
  if (o.filter_kind || o.filter_radius) {
    judge::CapturedFilter& filter = capture.filter ? *capture.filter : capture.filter.emplace();
    filter.kind = o.filter_kind.value_or(filter.kind);
    if (o.filter_radius && filter.kind == judge::FilterName::none)
      return fail(ErrorKind::usage, "--map-filter-radius: is of filters: --map-filter none reads one texel");
    filter.radius_texels = o.filter_radius.value_or(filter.radius_texels);
  }
  if (const auto set = set_map(capture, o); !set) return fail(set.error());
  return capture;
}

}  // namespace gnomon::app
