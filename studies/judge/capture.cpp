#include "studies/judge/capture.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>

#include "scene/files/json/json_reader.h"
#include "scene/files/path_status.h"
#include "scene/files/read_file.h"
#include "scene/light_map/light_view.h"

namespace gnomon::compare {
namespace {

constexpr std::string_view schema_names[] = {"gnomon/capture/1", "gnomon/capture/2"};
constexpr NumberRange strength_range{0.0, 1.0, true};
constexpr NumberRange side_range{1.0, 16384.0, false, false, true};
constexpr NumberRange place_range{0.0, 1e6, false, false, true};
constexpr NumberRange radius_range{0.0, 64.0, true};
constexpr std::size_t most_layers = std::tuple_size_v<decltype(LightView::faces)>;
constexpr const char* layers_wanted = "needs one layer to six";

template <std::size_t N>
std::vector<std::string_view> choices(const std::array<std::string_view, N>& names) {
  return {names.begin(), names.end()};
}

class CaptureReader {
 public:
  CaptureReader(JsonErrors& errors, std::string folder) : errors_(errors), folder_(std::move(folder)) {}

  Capture read(const JsonValue& root);

 private:
  void read_renderer(const JsonNode& node);
  void read_size(const JsonNode& node);
  void read_depth(const JsonNode& node);
  void read_schema(const JsonNode& node);
  void read_layer(const JsonNode& node);
  void read_caster_bias(const JsonNode& node, CapturedLayer& layer);
  void read_select(const JsonNode& node, CapturedLayer& layer);
  void read_rect(const JsonNode& node, CapturedLayer& layer);
  CapturedBias bias_of(const JsonNode& node);
  void since_2(const JsonNode& node, const char* key);
  void read_bias(const JsonNode& node);
  void read_filter(const JsonNode& node);
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
  const JsonObject object(node, {"name", "version", "settings"});
  if (const auto name = object.require("name")) out_.renderer = text(*name);
  out_.version = object.string("version");
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
  const JsonObject object(
      node, {"depth", "convention", "rows", "clip_from_world", "caster_bias", "bias", "rect", "select"});
  CapturedLayer& layer = out_.map.emplace_back();
  if (const auto named = object.require("depth")) layer.depth = file(*named);
  if (const auto convention = object.require("convention"))
    layer.convention = static_cast<StoredDepth>(convention->as_choice(choices(stored_depth_names)));
  if (const auto rows = object.require("rows"))
    layer.rows = static_cast<RowOrder>(rows->as_choice(choices(row_order_names)));
  if (const auto bias = object.find("caster_bias")) read_caster_bias(*bias, layer);
  if (const auto bias = object.find("bias")) since_2(*bias, "bias of a layer"), layer.bias = bias_of(*bias);
  if (const auto rect = object.find("rect")) read_rect(*rect, layer);
  if (const auto select = object.find("select")) read_select(*select, layer);
  const auto matrix = object.require("clip_from_world");
  if (!matrix) return;
  const auto numbers = matrix->as_array(16);
  if (numbers.size() != 16) return;
  Mat4& m = layer.clip_from_world.emplace();
  for (int i = 0; i < 16; ++i) m[i / 4][i % 4] = numbers[static_cast<std::size_t>(i)].as_number();
}

void CaptureReader::read_caster_bias(const JsonNode& node, CapturedLayer& layer) {
  since_2(node, "caster_bias");
  const JsonObject object(node, {"constant", "constant_world", "slope", "clamp"});
  const CapturedCasterBias bias{object.number("constant", 0.0), object.number("constant_world", 0.0),
                                object.number("slope", 0.0), object.number("clamp", 0.0)};
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
  const JsonObject object(node, {"near", "far", "by"});
  CapturedSelect& select = layer.select.emplace();
  select.near = object.number("near", 0.0, non_negative_number);
  if (const auto far = object.find("far")) select.far = far->as_number(positive_number);
  if (const auto by = object.find("by")) select.by_distance = by->as_choice(choices(select_names)) == 1;
  if (!(select.far > select.near)) node.error("far must be more than near");
}

CapturedBias CaptureReader::bias_of(const JsonNode& node) {
  const JsonObject object(node, {"constant_depth", "slope", "normal_offset_world"});
  return {object.number("constant_depth", 0.0), object.number("slope", 0.0),
          object.number("normal_offset_world", 0.0, non_negative_number)};
}

void CaptureReader::read_bias(const JsonNode& node) {
  out_.bias = bias_of(node);
}

void CaptureReader::read_filter(const JsonNode& node) {
  const JsonObject object(node, {"kind", "radius_texels", "read"});
  CapturedFilter& filter = out_.filter.emplace();
  if (const auto kind = object.require("kind"))
    filter.kind = static_cast<FilterName>(kind->as_choice(choices(filter_names)));
  filter.radius_texels = object.number("radius_texels", filter.radius_texels, radius_range);
  const auto read = object.find("read");
  if (!read) return;
  since_2(*read, "read");
  filter.linear_depths = read->as_choice(choices(filter_read_names)) == 1;
  if (filter.linear_depths && filter.kind != FilterName::none)
    read->error("linear_depths is one comparison, with kind none; pcf averages comparisons of single texels");
}

Capture CaptureReader::read(const JsonValue& value) {
  const JsonObject root(JsonNode(errors_, value, ""),
                        {"$schema", "schema", "renderer", "scene", "camera", "light", "size", "visibility",
                         "shadowed", "unshadowed", "position", "depth", "map", "bias", "filter", "strength"});
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
  if (const auto node = root.find("light")) out_.light = name_or_place(*node);
  if (const auto node = root.require("size")) read_size(*node);
  for (const auto& [key, field] :
       {std::pair{"visibility", &Capture::visibility}, std::pair{"shadowed", &Capture::shadowed},
        std::pair{"unshadowed", &Capture::unshadowed}, std::pair{"position", &Capture::position}})
    if (const auto node = root.find(key)) out_.*field = file(*node);
  if (const auto node = root.find("depth")) read_depth(*node);
  if (const auto node = root.find("map")) {
    const auto layers = node->as_array();
    if (layers.empty() || layers.size() > most_layers) node->error(layers_wanted);
    for (const JsonNode& layer : layers) read_layer(layer);
  }
  if (const auto node = root.find("bias")) read_bias(*node);
  if (const auto node = root.find("filter")) read_filter(*node);
  if (const auto node = root.find("strength")) {
    since_2(*node, "strength");
    out_.strength = node->as_number(strength_range);
  }
  return std::move(out_);
}

Expected<void> check_depth(const Capture& capture) {
  const CapturedDepth& depth = *capture.depth;
  const auto wrong = [&](const char* field, std::string reason) {
    return capture_error(capture, fmt::format("depth.{}", field), std::move(reason));
  };
  if (depth.file.empty()) return wrong("file", "is missing");
  if (!depth.convention) return wrong("convention", "is missing");
  const bool of_buffer =
      *depth.convention == PixelDepth::zero_to_one || *depth.convention == PixelDepth::reversed;
  const std::string_view name = pixel_depth_names[static_cast<std::size_t>(*depth.convention)];
  if (of_buffer && !depth.near) return wrong("near", fmt::format("is missing; {} needs it", name));
  if (*depth.convention == PixelDepth::zero_to_one && !depth.far)
    return wrong("far", fmt::format("is missing; {} needs it", name));
  if (!of_buffer && (depth.near || depth.far))
    return wrong(depth.near ? "near" : "far", fmt::format("does not go with {}, which needs none", name));
  if (depth.near && depth.far && *depth.far <= *depth.near)
    return wrong("far", fmt::format("must be more than near (got {}, near {})", *depth.far, *depth.near));
  return {};
}

Expected<void> check_map(const Capture& capture) {
  const std::size_t layers = capture.map.size();
  if (layers > most_layers) return capture_error(capture, "map", layers_wanted);
  for (std::size_t i = 0; i < layers; ++i) {
    const CapturedLayer& layer = capture.map[i];
    const auto wrong = [&](const char* field, std::string reason) {
      return capture_error(capture, fmt::format("map[{}].{}", i, field), std::move(reason));
    };
    if (layer.depth.empty()) return wrong("depth", "is missing");
    if (!layer.convention) return wrong("convention", "is missing");
    if (!layer.rows) return wrong("rows", "is missing");
    if (!layer.clip_from_world) return wrong("clip_from_world", "is missing");
    if (layer.caster_bias && layer.caster_bias->slope != 0.0 && layer.convention == StoredDepth::distance)
      return wrong("caster_bias.slope",
                   "is of the depths that a matrix makes; of distances constant_world is known");
    if (layer.convention != capture.map.front().convention)
      return wrong(
          "convention",
          fmt::format("differs from that of map[0] (got {}, there {})",
                      stored_depth_names[static_cast<std::size_t>(*layer.convention)],
                      stored_depth_names[static_cast<std::size_t>(*capture.map.front().convention)]));
  }
  const auto has_select = [](const CapturedLayer& layer) { return layer.select.has_value(); };
  const auto selected = std::count_if(capture.map.begin(), capture.map.end(), has_select);
  if (selected != 0 && selected != static_cast<std::ptrdiff_t>(layers))
    return capture_error(capture, "map",
                         "has a select in some layers; it needs one in all of them or in none");
  for (std::size_t i = 1; i < layers; ++i)
    if (capture.map[i].bias && capture.map[i].bias->slope !=
                                   capture.map[0].bias.value_or(capture.bias.value_or(CapturedBias{})).slope)
      return capture_error(
          capture, fmt::format("map[{}].bias.slope", i),
          "differs from that of map[0]; layers may differ in constant_depth and normal_offset_world");
  if (layers == 0 && capture.bias) return capture_error(capture, "bias", "says nothing without map");
  if (layers == 0 && capture.filter) return capture_error(capture, "filter", "says nothing without map");
  return {};
}

}  // namespace

tl::unexpected<Error> capture_error(const Capture& capture, std::string field, std::string reason) {
  Error error{ErrorKind::bad_input, std::move(reason)};
  error.file = capture.path.empty() ? "capture" : capture.path;
  error.field = std::move(field);
  return fail(std::move(error));
}

Expected<Capture> read_capture(const std::string& path) {
  const auto bytes = read_file(path);
  if (!bytes) return fail(bytes.error());
  const auto document = parse_json(*bytes, path);
  if (!document) return fail(document.error());
  JsonErrors errors{*document};
  Capture capture = CaptureReader(errors, folder_of(path)).read(document->root);
  if (errors.first) return fail(*errors.first);
  capture.path = path;
  return capture;
}

Expected<void> check_capture(const Capture& capture) {
  const auto wrong = [&](const char* field, const char* reason) {
    return capture_error(capture, field, reason);
  };
  if (capture.renderer.empty()) return wrong("renderer", "is missing");
  if (capture.scene.empty()) return wrong("scene", "is missing");
  if (capture.size.pixels() == 0) return wrong("size", "is missing");
  const bool ratio = !capture.shadowed.empty() || !capture.unshadowed.empty();
  if (capture.visibility.empty() && !ratio)
    return wrong("visibility", "is missing, and so are shadowed and unshadowed");
  if (!capture.visibility.empty() && ratio)
    return wrong("visibility", "cannot stand beside shadowed and unshadowed");
  if (ratio && capture.shadowed.empty()) return wrong("shadowed", "is missing; unshadowed is there");
  if (ratio && capture.unshadowed.empty()) return wrong("unshadowed", "is missing; shadowed is there");
  if (!capture.position.empty() && capture.depth) return wrong("depth", "cannot stand beside position");
  if (capture.depth)
    if (const auto sound = check_depth(capture); !sound) return sound;
  return check_map(capture);
}

}  // namespace gnomon::compare
