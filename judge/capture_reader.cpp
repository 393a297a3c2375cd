// Reads capture.json (capture.schema.json), of one light or of several.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "judge/capture.h"
#include "judge/capture_words.h"
#include "scene/files/json/json_reader.h"
#include "scene/files/path_status.h"
#include "scene/files/read_file.h"

namespace gnomon::judge {
namespace {

constexpr std::string_view schema_names[] = {"gnomon/capture/1", "gnomon/capture/2"};
constexpr NumberRange strength_range{0.0, 1.0, true};
constexpr NumberRange jitter_range{-1.0, 1.0};
constexpr NumberRange side_range{1.0, 16384.0, false, false, true};
constexpr NumberRange place_range{0.0, 1e6, false, false, true};
constexpr NumberRange radius_range{0.0, 64.0, true};
constexpr std::size_t most_lights = 64;
constexpr std::array<std::string_view, 2> caster_words{"known", "found"};

/// What `lights[]` has for each light, and a capture of one light itself.
constexpr std::array<std::string_view, 10> light_keys{
    "light", "visibility", "shadowed", "unshadowed", "map", "bias", "filter", "strength", "fade", "also"};

template <std::size_t N>
std::vector<std::string_view> choices(const std::array<std::string_view, N>& names) {
  return {names.begin(), names.end()};
}

class CaptureReader {
 public:
  CaptureReader(JsonErrors& errors, std::string folder) : errors_(errors), folder_(std::move(folder)) {}

  std::vector<Capture> read(const JsonValue& root);

 private:
  void read_renderer(const JsonNode& node);
  void read_size(const JsonNode& node);
  void read_jitter(const JsonNode& node);
  void read_depth(const JsonNode& node);
  void read_schema(const JsonNode& node);
  void read_layer(const JsonNode& node);
  void read_caster_bias(const JsonNode& node, CapturedLayer& layer);
  void read_select(const JsonNode& node, CapturedLayer& layer);
  void read_rect(const JsonNode& node, CapturedLayer& layer);
  CapturedBias bias_of(const JsonNode& node);
  void since_2(const JsonNode& node, const char* key);
  void read_light(const JsonObject& object);
  std::vector<Capture> read_lights(const JsonObject& root);
  void read_fade(const JsonNode& node);
  BiasAngle angle_of(const JsonObject& object, const char* key, const std::vector<std::string_view>& forms);
  void read_filter(const JsonNode& node);
  void read_moments(const JsonObject& object, CapturedFilter& filter);
  std::string text(const JsonNode& node);
  std::string file(const JsonNode& node);
  std::string name_or_place(const JsonNode& node);

  JsonErrors& errors_;
  std::string folder_;
  int version_ = 2;
  Capture out_;
};

void CaptureReader::read_schema(const JsonNode& node) {
  const std::string name = node.as_string();
  if (name == schema_names[0]) version_ = 1;
  if (name != schema_names[0] && name != schema_names[1])
    node.wrong("unknown version", fmt::format("\"{}\" or \"{}\"", schema_names[0], schema_names[1]));
}

/// A reader of version 1 would have refused the key.
void CaptureReader::since_2(const JsonNode& node, const char* key) {
  if (version_ < 2) node.error(fmt::format("{} needs \"schema\": \"{}\"", key, schema_names[1]));
}

std::string CaptureReader::text(const JsonNode& node) {
  std::string text = node.as_string();
  if (text.empty()) node.error("is empty");
  return text;
}

std::string CaptureReader::file(const JsonNode& node) {
  const std::filesystem::path named = text(node);
  return named.is_absolute() || folder_.empty() ? named.string() : (folder_ / named).string();
}

std::string CaptureReader::name_or_place(const JsonNode& node) {
  if (node.is(JsonValue::Type::number))
    return fmt::format("{}", static_cast<int>(node.as_number(place_range)));
  return text(node);
}

void CaptureReader::read_renderer(const JsonNode& node) {
  const JsonObject object(node, {"name", "version", "kind", "settings"});
  if (const auto name = object.require("name")) out_.renderer = text(*name);
  out_.version = object.string("version");
  if (const auto kind = object.find("kind")) {
    since_2(*kind, "kind");
    out_.kind = static_cast<RendererKind>(kind->as_choice(choices(renderer_kind_names)));
  }
  const auto settings = object.find("settings");
  if (!settings) return;
  if (!settings->is(JsonValue::Type::object)) settings->wrong("wrong type", "an object");
  for (const JsonMember& member : settings->value().members) {
    const JsonNode value(errors_, member.value, settings->path() + "." + printable(member.key));
    const bool plain = value.is(JsonValue::Type::string) || value.is(JsonValue::Type::number) ||
                       value.is(JsonValue::Type::boolean);
    if (!plain) value.wrong("wrong type", "a text, a number or a truth value");
    const JsonValue& v = member.value;
    out_.settings.emplace_back(member.key, value.is(JsonValue::Type::string)
                                               ? v.text
                                               : errors_.document.text.substr(v.begin, v.end - v.begin));
  }
}

void CaptureReader::read_size(const JsonNode& node) {
  const auto sides = node.as_array(2);
  if (sides.size() != 2) return;
  out_.size = {static_cast<int>(sides[0].as_number(side_range)),
               static_cast<int>(sides[1].as_number(side_range))};
}

void CaptureReader::read_depth(const JsonNode& node) {
  const JsonObject object(node, {"file", "convention", "near", "far"});
  CapturedDepth& depth = out_.depth.emplace();
  if (const auto named = object.require("file")) depth.file = file(*named);
  if (const auto convention = object.require("convention"))
    depth.convention = static_cast<PixelDepth>(convention->as_choice(choices(pixel_depth_names)));
  if (const auto near = object.find("near")) depth.near = near->as_number(positive_number);
  if (const auto far = object.find("far")) depth.far = far->as_number(positive_number);
}

void CaptureReader::read_layer(const JsonNode& node) {
  const JsonObject object(node, {"depth", "convention", "rows", "clip_from_world", "caster_bias", "bias",
                                 "rect", "select", "range"});
  CapturedLayer& layer = out_.map.emplace_back();
  if (const auto named = object.require("depth")) layer.depth = file(*named);
  if (const auto convention = object.require("convention")) {
    layer.convention = static_cast<StoredDepth>(convention->as_choice(choices(names_of(stored_conventions))));
    const StoredConvention& row = convention_of(*layer.convention);
    if (row.since_2) since_2(*convention, row.name.data());
  }
  if (const auto rows = object.require("rows"))
    layer.rows = static_cast<RowOrder>(rows->as_choice(choices(row_order_names)));
  if (const auto bias = object.find("caster_bias")) read_caster_bias(*bias, layer);
  if (const auto bias = object.find("bias")) since_2(*bias, "bias of a layer"), layer.bias = bias_of(*bias);
  if (const auto rect = object.find("rect")) read_rect(*rect, layer);
  if (const auto select = object.find("select")) read_select(*select, layer);
  if (const auto range = object.find("range")) {
    since_2(*range, "range");
    layer.range = range->as_vec2();
    if (layer.range->x == layer.range->y) range->error("needs two different numbers");
  }
  const auto matrix = object.require("clip_from_world");
  if (!matrix) return;
  const auto numbers = matrix->as_array(16);
  if (numbers.size() != 16) return;
  Mat4& m = layer.clip_from_world.emplace();
  for (int i = 0; i < 16; ++i) m[i / 4][i % 4] = numbers[static_cast<std::size_t>(i)].as_number();
}

void CaptureReader::read_caster_bias(const JsonNode& node, CapturedLayer& layer) {
  since_2(node, "caster_bias");
  const JsonObject object(
      node, {"constant", "constant_world", "slope", "clamp", "normal_offset_world", "normal_offset_angle"});
  const CapturedCasterBias bias{
      object.number("constant", 0.0),
      object.number("constant_world", 0.0),
      object.number("slope", 0.0),
      object.number("clamp", 0.0),
      object.number("normal_offset_world", 0.0),
      angle_of(object, "normal_offset_angle", {"none", "sine", "one_minus_cosine"})};
  layer.caster_bias = bias;
}

void CaptureReader::read_rect(const JsonNode& node, CapturedLayer& layer) {
  since_2(node, "rect");
  const auto numbers = node.as_array(4);
  if (numbers.size() != 4) return;
  const auto whole = [&](std::size_t i, const NumberRange& range) {
    return static_cast<int>(numbers[i].as_number(range));
  };
  layer.rect =
      CapturedRect{whole(0, place_range), whole(1, place_range), whole(2, side_range), whole(3, side_range)};
}

void CaptureReader::read_select(const JsonNode& node, CapturedLayer& layer) {
  since_2(node, "select");
  const JsonObject object(node, {"near", "far", "by", "blend"});
  CapturedSelect& select = layer.select.emplace();
  select.near = object.number("near", 0.0, non_negative_number);
  if (const auto far = object.find("far")) select.far = far->as_number(positive_number);
  if (const auto by = object.find("by")) select.by_distance = by->as_choice(choices(select_names)) == 1;
  select.blend = object.number("blend", 0.0, non_negative_number);
  if (!(select.far > select.near)) node.error("far must be more than near");
  if (select.blend > 0.0 && !(select.blend <= select.far - select.near))
    node.error("blend must not be more than from near to far");
}

BiasAngle CaptureReader::angle_of(const JsonObject& object, const char* key,
                                  const std::vector<std::string_view>& forms) {
  const auto node = object.find(key);
  if (!node) return BiasAngle::none;
  since_2(*node, key);
  const std::size_t chosen = node->as_choice(forms);
  const auto all = choices(bias_angle_names);
  return static_cast<BiasAngle>(std::find(all.begin(), all.end(), forms[chosen]) - all.begin());
}

CapturedBias CaptureReader::bias_of(const JsonNode& node) {
  const JsonObject object(
      node, {"constant_depth", "slope", "normal_offset_world", "angle", "min", "max", "normal_offset_angle"});
  CapturedBias bias{object.number("constant_depth", 0.0), object.number("slope", 0.0),
                    object.number("normal_offset_world", 0.0, non_negative_number)};
  bias.angle = angle_of(object, "angle", choices(bias_angle_names));
  bias.normal_offset_angle = angle_of(object, "normal_offset_angle", {"none", "sine", "one_minus_cosine"});
  for (const auto& [key, field] :
       {std::pair{"min", &CapturedBias::min}, std::pair{"max", &CapturedBias::max}})
    if (const auto limit = object.find(key)) since_2(*limit, key), bias.*field = limit->as_number();
  if (bias.min > bias.max)
    node.error(fmt::format("min must not be more than max (got {}, max {})", bias.min, bias.max));
  return bias;
}

void CaptureReader::read_fade(const JsonNode& node) {
  since_2(node, "fade");
  const JsonObject object(node, {"from", "to", "by"});
  CapturedFade& fade = out_.fade.emplace();
  if (const auto from = object.require("from")) fade.from = from->as_number(non_negative_number);
  if (const auto to = object.require("to")) fade.to = to->as_number(positive_number);
  if (const auto by = object.find("by")) fade.by_distance = by->as_choice(choices(select_names)) == 1;
  if (fade.to < fade.from)
    node.error(fmt::format("to must not be less than from (got {}, from {})", fade.to, fade.from));
}

void CaptureReader::read_filter(const JsonNode& node) {
  const JsonObject object(node, {"kind", "radius_texels", "read", "exponents", "light_bleeding_reduction",
                                 "minimum_variance", "moment_bias"});
  CapturedFilter& filter = out_.filter.emplace();
  if (const auto kind = object.require("kind"))
    filter.kind = static_cast<FilterName>(kind->as_choice(choices(filter_names)));
  if (filter.kind == FilterName::none)
    object.forbid("radius_texels", "is of filters: kind none reads one texel");
  filter.radius_texels = object.number("radius_texels", filter.radius_texels, radius_range);
  if (const auto read = object.find("read")) {
    since_2(*read, "read");
    filter.read = static_cast<FilterRead>(read->as_choice(choices(names_of(read_conventions))));
    if (filter.read == FilterRead::linear_depths && filter.kind != FilterName::none &&
        filter.kind != FilterName::pcf)
      read->error("linear_depths is of the kinds none and pcf");
    if (filter.read == FilterRead::moments && !has_moments(filter.kind))
      read->error("moments are of the kinds vsm, esm, evsm and msm");
  }
  for (const char* key : {"exponents", "light_bleeding_reduction", "minimum_variance", "moment_bias"})
    if (filter.read != FilterRead::moments) object.forbid(key, "is of moments (`read`)");
  if (filter.read == FilterRead::moments) read_moments(object, filter);
}

void CaptureReader::read_moments(const JsonObject& object, CapturedFilter& filter) {
  using enum FilterName;
  if (filter.kind == esm) object.forbid("light_bleeding_reduction", "is not of esm");
  if (filter.kind != vsm && filter.kind != evsm) object.forbid("minimum_variance", "is of vsm and evsm");
  if (filter.kind != msm) object.forbid("moment_bias", "is of msm");
  filter.light_bleeding_reduction = object.number("light_bleeding_reduction", 0.0, {0.0, 0.999});
  filter.minimum_variance = object.number("minimum_variance", 0.0, non_negative_number);
  filter.moment_bias = object.number("moment_bias", filter.moment_bias, strength_range);
  const bool exponential = filter.kind == FilterName::esm || filter.kind == FilterName::evsm;
  const auto node = exponential ? object.require("exponents") : object.find("exponents");
  if (!node) return;
  for (const JsonNode& number : node->as_array())
    filter.exponents.push_back(number.as_number(positive_number));
  const std::size_t most = filter.kind == FilterName::evsm ? 2 : exponential ? 1 : 0;
  if (filter.exponents.empty() || filter.exponents.size() > most)
    node->error("has esm one of, evsm one for each of its warps, the other kinds none");
}

void CaptureReader::read_jitter(const JsonNode& node) {
  since_2(node, "jitter");
  const auto both = node.as_array();
  if (both.size() != 2) return node.error("needs two numbers, to the right and downwards");
  out_.jitter = {both[0].as_number(jitter_range), both[1].as_number(jitter_range)};
}

/// What is of one light: its pictures, its map and how that is tested.
void CaptureReader::read_light(const JsonObject& object) {
  if (const auto node = object.find("light")) out_.light = name_or_place(*node);
  for (const auto& [key, field] :
       {std::pair{"visibility", &Capture::visibility}, std::pair{"shadowed", &Capture::shadowed},
        std::pair{"unshadowed", &Capture::unshadowed}})
    if (const auto node = object.find(key)) out_.*field = file(*node);
  if (const auto node = object.find("map")) {
    const auto layers = node->as_array();
    if (layers.empty() || layers.size() > most_layers)
      node->error(fmt::format("needs one layer to {}", most_layers));
    for (const JsonNode& layer : layers) read_layer(layer);
  }
  if (const auto node = object.find("bias")) out_.bias = bias_of(*node);
  if (const auto node = object.find("filter")) read_filter(*node);
  if (const auto node = object.find("strength"))
    since_2(*node, "strength"), out_.strength = node->as_number(strength_range);
  if (const auto node = object.find("fade")) read_fade(*node);
  if (const auto node = object.find("also")) since_2(*node, "also"), out_.also = file(*node);
}

std::vector<Capture> CaptureReader::read_lights(const JsonObject& root) {
  const JsonNode list = *root.find("lights");
  since_2(list, "lights");
  for (const std::string_view key : light_keys) root.forbid(key, "is of one light: it stands in lights[]");
  const auto nodes = list.as_array();
  if (nodes.empty() || nodes.size() > most_lights)
    list.error(fmt::format("needs one light to {}", most_lights));
  const Capture shared = out_;
  std::vector<Capture> captures;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    out_ = shared;
    const JsonObject object(nodes[i], choices(light_keys));
    read_light(object);
    object.require("light");
    out_.within = nodes[i].path() + ".";
    for (const Capture& before : captures)
      if (before.light == out_.light) nodes[i].error("is of a light that stands before");
    captures.push_back(std::move(out_));
  }
  return captures;
}

std::vector<Capture> CaptureReader::read(const JsonValue& value) {
  std::vector<std::string_view> keys{"$schema",  "schema", "renderer", "scene",   "camera", "size",
                                     "position", "depth",  "lights",   "casters", "jitter"};
  keys.insert(keys.end(), light_keys.begin(), light_keys.end());
  const JsonObject root(JsonNode(errors_, value, ""), std::move(keys));
  if (const auto schema = root.require("schema")) read_schema(*schema);
  if (const auto node = root.require("renderer")) read_renderer(*node);
  if (const auto node = root.require("scene")) {
    out_.scene = file(*node);
    // A name that is no file beside the capture may be that of a built-in scene.
    if (file_kind_or_none(out_.scene) == FileKind::none &&
        std::filesystem::path(out_.scene).extension().empty())
      out_.scene = text(*node);
  }
  if (const auto node = root.find("camera")) out_.camera = name_or_place(*node);
  if (const auto node = root.require("size")) read_size(*node);
  if (const auto node = root.find("position")) out_.position = file(*node);
  if (const auto node = root.find("depth")) read_depth(*node);
  if (const auto node = root.find("jitter")) read_jitter(*node);
  if (const auto node = root.find("casters"))
    since_2(*node, "casters"), out_.casters_found = node->as_choice(choices(caster_words)) == 1;
  if (root.has("lights")) return read_lights(root);
  read_light(root);
  return {std::move(out_)};
}

}  // namespace

Expected<std::vector<Capture>> read_captures(const std::string& path) {
  const auto bytes = read_file(path);
  if (!bytes) return fail(bytes.error());
  const auto document = parse_json(*bytes, path);
  if (!document) return fail(document.error());
  JsonErrors errors{.document = *document, .meanings = capture_words};
  std::vector<Capture> captures = CaptureReader(errors, folder_of(path)).read(document->root);
  if (errors.first) return fail(*errors.first);
  for (Capture& capture : captures) capture.path = path;
  return captures;
}

Expected<Capture> read_capture(const std::string& path, const std::string& light) {
  auto read = read_captures(path);
  if (!read) return fail(read.error());
  std::vector<Capture>& captures = *read;
  if (captures.size() == 1 && captures.front().within.empty()) return std::move(captures.front());
  std::vector<std::string> names;
  for (std::size_t i = 0; i < captures.size(); ++i) {
    if (captures[i].light == light || (light.empty() && captures.size() == 1)) return std::move(captures[i]);
    names.push_back(captures[i].light);
  }
  for (std::size_t i = 0; i < captures.size(); ++i)
    if (fmt::format("{}", i) == light) return std::move(captures[i]);
  Capture whole;
  whole.path = path;
  return capture_error(
      whole, "lights",
      light.empty() ? fmt::format("has {} lights, and one is wanted (allowed {})", captures.size(),
                                  fmt::join(names, ", "))
                    : fmt::format("has no such light (got {}, allowed {})", light, fmt::join(names, ", ")));
}

}  // namespace gnomon::judge
