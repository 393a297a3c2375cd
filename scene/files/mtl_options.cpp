#include "scene/files/mtl_options.h"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <set>

#include "scene/files/read_file.h"

namespace gnomon {
namespace {

/// An option of a texture statement (Wavefront's "MTL material format", section "Options for texture map
/// statements"): how many words may follow, and how many of them must be numbers where they are there.
struct TextureOption {
  std::string_view name;
  int most;          ///< words
  bool are_numbers;  ///< then the words end where no number follows
};
constexpr std::array<TextureOption, 14> options{{{"-s", 3, true},
                                                 {"-o", 3, true},
                                                 {"-t", 3, true},
                                                 {"-mm", 2, true},
                                                 {"-bm", 1, true},
                                                 {"-boost", 1, true},
                                                 {"-texres", 1, true},
                                                 {"-clamp", 1, false},
                                                 {"-blendu", 1, false},
                                                 {"-blendv", 1, false},
                                                 {"-cc", 1, false},
                                                 {"-imfchan", 1, false},
                                                 {"-type", 1, false},
                                                 {"-colorspace", 1, false}}};

constexpr std::string_view blanks = " \t\r";

/// The next word, taken off the front.
std::string_view take_word(std::string_view& rest) {
  rest.remove_prefix(std::min(rest.find_first_not_of(blanks), rest.size()));
  const std::string_view word = rest.substr(0, rest.find_first_of(blanks));
  rest.remove_prefix(word.size());
  return word;
}

std::string_view without_blanks(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  return text.substr(0, text.find_last_not_of(blanks) + 1);
}

/// The words after an option; numbers that are missing get `otherwise`.
std::vector<std::string> arguments(const TextureOption& option, std::string_view& rest,
                                   const char* otherwise) {
  std::vector<std::string> words;
  while (static_cast<int>(words.size()) < option.most) {
    std::string_view after = rest;
    const std::string_view word = take_word(after);
    if (word.empty() || (option.are_numbers && !parse_decimal(word))) break;
    words.emplace_back(word);
    rest = after;
  }
  while (option.are_numbers && static_cast<int>(words.size()) < option.most) words.emplace_back(otherwise);
  return words;
}

/// A statement after its key.
std::string plain_statement(std::string_view key, std::string_view rest, std::set<std::string>& unused) {
  std::string out(key);
  for (;;) {
    std::string_view after = rest;
    const std::string_view word = take_word(after);
    const TextureOption* option = nullptr;
    for (const TextureOption& known : options)
      if (known.name == word) option = &known;
    if (option == nullptr) break;
    rest = after;
    const auto words = arguments(*option, rest, word == "-s" ? "1" : "0");
    if (word == "-s" || word == "-o" || word == "-clamp") {
      out += fmt::format(" {}", word);
      for (const std::string& w : words) out += " " + w;
    } else if (word != "-blendu" && word != "-blendv" && word != "-bm" && word != "-texres") {
      unused.insert(fmt::format("{} {}", key, word));
    }
  }
  return fmt::format("{} {}", out, without_blanks(rest));
}

/// "d -halo 0.5" as "d 0.5"; any other statement as it is.
std::string plain_dissolve(std::string_view line, std::string_view rest, bool& has_halo) {
  if (take_word(rest) != "-halo") return std::string(line);
  has_halo = true;
  return fmt::format("d {}", without_blanks(rest));
}

}  // namespace

std::string plain_mtl(std::string_view text, std::vector<std::string>& notes) {
  std::string out;
  std::set<std::string> unused;
  bool has_halo = false;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    std::string_view rest = text.substr(at, end - at);
    const std::string_view line = rest, key = take_word(rest);
    const bool is_map = key == "map_Kd" || key == "map_d";
    if (is_map)
      out += plain_statement(key, rest, unused);
    else if (key == "newmtl")
      out += fmt::format("newmtl {}", without_blanks(rest));
    else
      out += key == "d" ? plain_dissolve(line, rest, has_halo) : std::string(line);
    if (end < text.size()) out += '\n';
    at = end + 1;
  }
  for (const std::string& option : unused)
    notes.push_back(fmt::format("The option {} of textures is not used.", option));
  if (has_halo) notes.emplace_back("The option d -halo is not used: as much is let through at every angle.");
  return out;
}

}  // namespace gnomon
