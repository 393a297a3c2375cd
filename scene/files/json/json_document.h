// JSON with positions: nlohmann's parser feeds a small tree in which every value knows where it stands in the
// text, so that every later complaint can say file:line:column. Comments are allowed; everything else is RFC
// 8259, and duplicate keys, a byte order mark and nesting deeper than max_json_depth are errors.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scene/base/expected.h"

namespace gnomon {

inline constexpr int max_json_depth = 64;

struct JsonMember;

struct JsonValue {
  enum class Type : std::uint8_t { null, boolean, number, string, array, object };
  Type type = Type::null;
  bool boolean = false;
  bool whole = false;  ///< a number written without point and exponent
  double number = 0.0;
  std::string text;                 ///< of a string, decoded
  std::vector<JsonValue> items;     ///< of an array
  std::vector<JsonMember> members;  ///< of an object, in the file's order
  std::size_t begin = 0, end = 0;   ///< bytes of the source

  const JsonMember* find(std::string_view key) const;
};

struct JsonMember {
  std::string key;
  std::size_t key_begin = 0;
  JsonValue value;
};

struct JsonDocument {
  std::string file;  ///< for messages
  std::string text;
  JsonValue root;
  bool has_lines = true;  ///< false: the text is part of a binary file, and positions would mislead

  /// An error at a byte offset of the text.
  Error error_at(std::size_t offset, std::string field, std::string reason) const;
};

Expected<JsonDocument> parse_json(std::string_view text, const std::string& file, bool has_lines = true);

/// "a string", "an object", "an array of 3", or a number or literal as written: for "(got X, ...)".
std::string describe(const JsonDocument& document, const JsonValue& value);

}  // namespace gnomon
