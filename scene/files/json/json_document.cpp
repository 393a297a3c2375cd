#include "scene/files/json/json_document.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "scene/files/read_file.h"

namespace gnomon {
namespace {

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

std::size_t skip_comment(std::string_view text, std::size_t at) {
  if (text.substr(at, 2) == "//") return std::min(text.find('\n', at), text.size());
  const std::size_t close = text.find("*/", at + 2);
  return close == std::string_view::npos ? text.size() : close + 2;
}

// Past a string that starts at `at` with a quote.
std::size_t skip_string(std::string_view text, std::size_t at) {
  for (++at; at < text.size() && text[at] != '"'; ++at)
    if (text[at] == '\\') ++at;
  return std::min(at + 1, text.size());
}

bool starts_comment(std::string_view text, std::size_t at) {
  return text.substr(at, 2) == "//" || text.substr(at, 2) == "/*";
}

// The first value or bracket at or after `at`: what lies between tokens is space, comments, commas and
// colons.
std::size_t next_token(std::string_view text, std::size_t at) {
  while (at < text.size()) {
    if (is_space(text[at]) || text[at] == ',' || text[at] == ':')
      ++at;
    else if (starts_comment(text, at))
      at = skip_comment(text, at);
    else
      break;
  }
  return at;
}

std::size_t token_end(std::string_view text, std::size_t at) {
  if (at >= text.size()) return text.size();
  if (text[at] == '"') return skip_string(text, at);
  if (std::string_view("{}[]").find(text[at]) != std::string_view::npos) return at + 1;
  while (at < text.size() && (std::isalnum(static_cast<unsigned char>(text[at])) || text[at] == '-' ||
                              text[at] == '+' || text[at] == '.'))
    ++at;
  return at;
}

// Builds the tree. nlohmann reports events in the text's order, so the position of each is that of the next
// token after the one before.
class TreeBuilder : public nlohmann::json_sax<nlohmann::json> {
 public:
  explicit TreeBuilder(const JsonDocument& document, JsonValue& root)
      : document_(document), text_(document.text), root_(root) {}
  std::optional<Error> error;

  bool null() override { return leaf({}); }
  bool boolean(bool value) override {
    JsonValue v;
    v.type = JsonValue::Type::boolean;
    v.boolean = value;
    return leaf(std::move(v));
  }
  bool number_integer(number_integer_t value) override { return number(static_cast<double>(value), true); }
  bool number_unsigned(number_unsigned_t value) override { return number(static_cast<double>(value), true); }
  bool number_float(number_float_t value, const string_t&) override { return number(value, false); }
  bool string(string_t& value) override {
    JsonValue v;
    v.type = JsonValue::Type::string;
    v.text = std::move(value);
    return leaf(std::move(v));
  }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open(JsonValue::Type::object); }
  bool start_array(std::size_t) override { return open(JsonValue::Type::array); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(string_t& name) override {
    consume_token();
    if (!keys_.back().insert(name).second) {
      error = document_.error_at(begin_, {}, fmt::format("duplicate key \"{}\"", printable(name)));
      return false;
    }
    open_.back()->members.push_back({std::move(name), begin_, {}});
    return true;
  }
  bool parse_error(std::size_t position, const std::string&, const nlohmann::detail::exception& e) override {
    error = syntax_error(position, e.what());
    return false;
  }

 private:
  void consume_token() {
    begin_ = next_token(text_, end_);
    end_ = token_end(text_, begin_);
  }

  JsonValue& place(JsonValue value) {
    if (open_.empty()) return root_ = std::move(value);
    JsonValue& parent = *open_.back();
    if (parent.type == JsonValue::Type::array) return parent.items.emplace_back(std::move(value));
    return parent.members.back().value = std::move(value);
  }

  bool leaf(JsonValue value) {
    consume_token();
    value.begin = begin_;
    value.end = end_;
    place(std::move(value));
    return true;
  }

  bool number(double value, bool whole) {
    JsonValue v;
    v.type = JsonValue::Type::number;
    v.number = value;
    v.whole = whole;
    return leaf(std::move(v));
  }

  bool open(JsonValue::Type type) {
    consume_token();
    JsonValue value;
    value.type = type;
    value.begin = begin_;
    open_.push_back(&place(std::move(value)));
    keys_.emplace_back();
    return true;
  }

  bool close() {
    consume_token();
    open_.back()->end = end_;
    open_.pop_back();
    keys_.pop_back();
    return true;
  }

  // nlohmann's position counts the bytes read, the offending one included. "[json.exception...] parse error
  // at line 1, column 2: syntax error while parsing value - invalid literal; last read: 'N'" is cut to its
  // end.
  Error syntax_error(std::size_t position, std::string_view what) const {
    const std::size_t at = std::min(position > 0 ? position - 1 : 0, text_.size());
    const std::size_t token = next_token(text_, end_);
    for (const std::string_view word : {"NaN", "nan", "Infinity", "-Infinity", "inf", "-inf"})
      if (text_.substr(token, word.size()) == word)
        return document_.error_at(token, {},
                                  fmt::format("not a number in JSON (got {}, allowed finite numbers)", word));
    if (what.find("number overflow") != std::string_view::npos)
      return document_.error_at(token, {},
                                fmt::format("the number is too large (got {}, allowed up to 1.8e308)",
                                            printable(text_.substr(token, token_end(text_, token) - token))));
    if (what.find("unexpected end of input") != std::string_view::npos)
      return document_.error_at(text_.size(), {}, "the file ends in the middle");
    const std::size_t colon = what.find(": ");
    std::string reason(colon == std::string_view::npos ? what : what.substr(colon + 2));
    if (const std::size_t quoted = reason.find("; last read: "); quoted != std::string::npos)
      reason.resize(quoted);
    return document_.error_at(at, {}, reason);
  }

  const JsonDocument& document_;
  std::string_view text_;
  JsonValue& root_;
  std::vector<JsonValue*> open_;
  std::vector<std::set<std::string>> keys_;
  std::size_t begin_ = 0, end_ = 0;
};

// Before any parser sees the text: what it must not start with, and how deep it nests.
std::optional<Error> check_outside(const JsonDocument& document) {
  const std::string_view text = document.text;
  if (text.starts_with("\xef\xbb\xbf") || text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"))
    return document.error_at(0, {}, "the file starts with a byte order mark (allowed: UTF-8 without one)");
  int depth = 0;
  for (std::size_t at = 0; at < text.size();) {
    if (text[at] == '"') {
      at = skip_string(text, at);
      continue;
    }
    if (starts_comment(text, at)) {
      if (text[at + 1] == '*' && text.find("*/", at + 2) == std::string_view::npos)
        return document.error_at(at, {}, "the comment that starts here does not end (allowed: /* ... */)");
      at = skip_comment(text, at);
      continue;
    }
    if (text[at] == '{' || text[at] == '[') ++depth;
    if (text[at] == '}' || text[at] == ']') --depth;
    if (depth > max_json_depth)
      return document.error_at(at, {},
                               fmt::format("nested too deeply (got more than {} levels, allowed {})",
                                           max_json_depth, max_json_depth));
    ++at;
  }
  if (next_token(text, 0) == text.size()) return document.error_at(0, {}, "the file is empty");
  return std::nullopt;
}

}  // namespace

const JsonMember* JsonValue::find(std::string_view key) const {
  const auto found =
      std::find_if(members.begin(), members.end(), [&](const JsonMember& m) { return m.key == key; });
  return found == members.end() ? nullptr : &*found;
}

Error JsonDocument::error_at(std::size_t offset, std::string field, std::string reason) const {
  const LineColumn at = line_column(text, offset);
  Error error{ErrorKind::bad_input, std::move(reason)};
  error.file = file;
  if (has_lines) {
    error.line = at.line;
    error.column = at.column;
  }
  error.field = std::move(field);
  return error;
}

Expected<JsonDocument> parse_json(std::string_view text, const std::string& file, bool has_lines) {
  JsonDocument document{file, std::string(text), {}, has_lines};
  if (auto error = check_outside(document)) return fail(std::move(*error));
  TreeBuilder builder(document, document.root);
  const bool parsed = nlohmann::json::sax_parse(document.text, &builder, nlohmann::json::input_format_t::json,
                                                /*strict=*/true, /*ignore_comments=*/true);
  if (builder.error) return fail(std::move(*builder.error));
  if (!parsed) return fail(document.error_at(0, {}, "is not JSON"));
  return document;
}

std::string describe(const JsonDocument& document, const JsonValue& value) {
  switch (value.type) {
    case JsonValue::Type::array:
      return fmt::format("an array of {}", value.items.size());
    case JsonValue::Type::object:
      return "an object";
    case JsonValue::Type::string:
      return fmt::format("\"{}\"", printable(value.text));
    default:
      return printable(std::string_view(document.text).substr(value.begin, value.end - value.begin));
  }
}

}  // namespace gnomon
