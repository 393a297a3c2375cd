#include "scene/files/json/json_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <cctype>

#include "scene/base/option_text.h"
#include "scene/files/pictures/image_io.h"
#include "scene/files/read_file.h"

namespace gnomon {
namespace {

std::string join(const std::string& path, std::string_view key) {
  return path.empty() ? std::string(key) : fmt::format("{}.{}", path, key);
}

std::optional<Vec3f> hex_color(std::string_view text) {
  if (text.size() != 7 || text[0] != '#') return std::nullopt;
  Vec3f color;
  for (std::size_t i = 0; i < 3; ++i) {
    const int high = hex_digit(text[1 + 2 * i]);
    const int low = hex_digit(text[2 + 2 * i]);
    if (high < 0 || low < 0) return std::nullopt;
    color[static_cast<int>(i)] = linear_from_srgb(static_cast<float>(16 * high + low) / 255.0f);
  }
  return color;
}

}  // namespace

void JsonErrors::add(std::size_t offset, const std::string& field, std::string reason) {
  if (!first) first = document.error_at(offset, field, std::move(reason));
}

bool NumberRange::contains(double value) const {
  if (!std::isfinite(value)) return false;
  if (min_open ? !(value > min) : !(value >= min)) return false;
  if (max_open ? !(value < max) : !(value <= max)) return false;
  return !whole || std::trunc(value) == value;
}

std::string NumberRange::text() const {
  const std::string_view noun = whole ? "a whole number" : "a number";
  const bool low = min != -infinity;
  const bool high = max != infinity;
  if (low && high)
    return fmt::format("{} in {}{:g}, {:g}{}", noun, min_open ? '(' : '[', min, max, max_open ? ')' : ']');
  if (low) return fmt::format("{} {} {:g}", noun, min_open ? ">" : ">=", min);
  if (high) return fmt::format("{} {} {:g}", noun, max_open ? "<" : "<=", max);
  return std::string(noun);
}

std::string suggestion(std::string_view word, const std::vector<std::string_view>& candidates) {
  const std::string_view best = nearest_name(word, candidates);
  return best.empty() ? "" : fmt::format("; did you mean \"{}\"?", best);
}

void JsonNode::wrong(std::string_view what, std::string_view allowed) const {
  error(fmt::format("{} (got {}, allowed {})", what, describe(errors_->document, *value_), allowed));
}

double JsonNode::as_number(const NumberRange& range) const {
  if (!is(JsonValue::Type::number)) {
    wrong("wrong type", range.text());
    return 0.0;
  }
  if (!range.contains(value_->number)) wrong("out of range", range.text());
  return value_->number;
}

bool JsonNode::as_boolean() const {
  if (!is(JsonValue::Type::boolean)) wrong("wrong type", "true or false");
  return value_->boolean;
}

std::string JsonNode::as_string() const {
  if (!is(JsonValue::Type::string)) wrong("wrong type", "a string");
  return value_->text;
}

std::size_t JsonNode::as_choice(const std::vector<std::string_view>& choices) const {
  const std::string text = as_string();
  const auto found = std::find(choices.begin(), choices.end(), text);
  if (found != choices.end()) return static_cast<std::size_t>(found - choices.begin());
  error(fmt::format("unknown value (got {}, allowed {}){}", describe(errors_->document, *value_),
                    fmt::join(choices, ", "), suggestion(text, choices)));
  return 0;
}

bool JsonNode::components(double* out, std::size_t count) const {
  const std::string allowed = fmt::format("an array of {} numbers", count);
  if (!is(JsonValue::Type::array) || value_->items.size() != count) {
    wrong("wrong type", allowed);
    return false;
  }
  for (std::size_t i = 0; i < count; ++i)
    out[i] =
        JsonNode(*errors_, value_->items[i], fmt::format("{}[{}]", path_, i)).as_number(coordinate_range);
  return true;
}

Vec2 JsonNode::as_vec2() const {
  Vec2 v(0.0);
  components(&v.x, 2);
  return v;
}

Vec3 JsonNode::as_vec3() const {
  Vec3 v(0.0);
  components(&v.x, 3);
  return v;
}

Vec2 JsonNode::as_scale2() const {
  return is(JsonValue::Type::number) ? Vec2(as_number(coordinate_range)) : as_vec2();
}

Vec3 JsonNode::as_scale3() const {
  return is(JsonValue::Type::number) ? Vec3(as_number(coordinate_range)) : as_vec3();
}

Vec3 JsonNode::as_direction() const {
  const Vec3 v = as_vec3();
  const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  if (!(largest > 0.0)) {
    wrong("has no direction", "a vector that is not zero");
    return {0.0, 1.0, 0.0};
  }
  return glm::normalize(v / largest);
}

Vec3f JsonNode::as_color(const NumberRange& range) const {
  if (is(JsonValue::Type::number)) return Vec3f(static_cast<float>(as_number(range)));
  if (is(JsonValue::Type::string)) {
    if (const auto color = hex_color(value_->text)) return *color;
    wrong("not a colour", "a number, [r, g, b] or \"#rrggbb\"");
    return Vec3f(0.0f);
  }
  if (!is(JsonValue::Type::array) || value_->items.size() != 3) {
    wrong("wrong type", "a number, [r, g, b] or \"#rrggbb\"");
    return Vec3f(0.0f);
  }
  Vec3f color;
  for (int i = 0; i < 3; ++i) {
    const JsonNode item(*errors_, value_->items[static_cast<std::size_t>(i)],
                        fmt::format("{}[{}]", path_, i));
    color[i] = static_cast<float>(item.as_number(range));
  }
  return color;
}

std::vector<JsonNode> JsonNode::as_array(std::size_t size) const {
  std::vector<JsonNode> nodes;
  if (!is(JsonValue::Type::array) || (size != 0 && value_->items.size() != size)) {
    wrong("wrong type", size == 0 ? std::string("an array") : fmt::format("an array of {}", size));
    return nodes;
  }
  nodes.reserve(value_->items.size());
  for (std::size_t i = 0; i < value_->items.size(); ++i)
    nodes.emplace_back(*errors_, value_->items[i], fmt::format("{}[{}]", path_, i));
  return nodes;
}

namespace {

/// "; `map[].select` says it", or "": what an unknown key means elsewhere in the format.
std::string meaning_of(std::string_view key, std::span<const KeyMeaning> meanings) {
  std::string word;
  for (const char c : key)
    if (c != '_' && c != '-') word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  for (const KeyMeaning& meaning : meanings)
    if (word == meaning.word) return fmt::format("; `{}` says it", meaning.said_by);
  return {};
}

}  // namespace

JsonObject::JsonObject(const JsonNode& node, std::vector<std::string_view> known_keys)
    : node_(node), keys_(std::move(known_keys)) {
  if (!node.is(JsonValue::Type::object)) node.wrong("wrong type", "an object");
  for (const JsonMember& member : node.value().members) {
    if (std::find(keys_.begin(), keys_.end(), member.key) != keys_.end()) continue;
    const std::string key = printable(member.key);
    const std::string meaning = meaning_of(member.key, node.errors().meanings);
    node.errors().add(member.key_begin, join(node.path(), key),
                      fmt::format("unknown key (got \"{}\", allowed {}){}", key, fmt::join(keys_, ", "),
                                  meaning.empty() ? suggestion(member.key, keys_) : meaning));
  }
}

std::optional<JsonNode> JsonNode::child(std::string_view key) const {
  const JsonMember* member = value_->find(key);
  if (!member) return std::nullopt;
  return JsonNode(*errors_, member->value, join(path_, key));
}

std::optional<JsonNode> JsonObject::find(std::string_view key) const {
  assert(std::find(keys_.begin(), keys_.end(), key) != keys_.end());
  return node_.child(key);
}

std::optional<JsonNode> JsonObject::require(std::string_view key) const {
  auto found = find(key);
  if (!found && node_.is(JsonValue::Type::object))
    node_.errors().add(node_.value().begin, join(node_.path(), key), "is missing");
  return found;
}

void JsonObject::forbid(std::string_view key, std::string_view why) const {
  const JsonMember* member = node_.value().find(key);
  if (member) node_.errors().add(member->key_begin, join(node_.path(), key), std::string(why));
}

std::string_view JsonObject::exactly_one(const std::vector<std::string_view>& keys) const {
  std::vector<std::string_view> present;
  for (const std::string_view key : keys) {
    if (has(key)) present.push_back(key);
  }
  if (present.size() == 1) return present.front();
  if (present.empty() && node_.is(JsonValue::Type::object))
    node_.errors().add(node_.value().begin, node_.path(),
                       fmt::format("needs one of {}", fmt::join(keys, ", ")));
  if (present.size() > 1)
    node_.errors().add(
        node_.value().find(present[1])->key_begin, join(node_.path(), present[1]),
        fmt::format("cannot stand beside {} (allowed one of {})", present[0], fmt::join(keys, ", ")));
  return {};
}

double JsonObject::number(std::string_view key, double otherwise, const NumberRange& range) const {
  const auto found = find(key);
  return found ? found->as_number(range) : otherwise;
}

bool JsonObject::boolean(std::string_view key, bool otherwise) const {
  const auto found = find(key);
  return found ? found->as_boolean() : otherwise;
}

std::string JsonObject::string(std::string_view key, std::string otherwise) const {
  const auto found = find(key);
  return found ? found->as_string() : std::move(otherwise);
}

Vec3f JsonObject::color(std::string_view key, const Vec3f& otherwise, const NumberRange& range) const {
  const auto found = find(key);
  return found ? found->as_color(range) : otherwise;
}

}  // namespace gnomon
