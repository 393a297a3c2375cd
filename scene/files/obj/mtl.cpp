#include "scene/files/obj/mtl.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "scene/files/obj/obj_text.h"
#include "scene/files/read_file.h"

namespace gnomon {
namespace {

/// An option of a texture statement (Wavefront's "MTL material format", section "Options for texture map
/// statements"). It says how many words may follow, and how many of them must be numbers where they are there.
struct TextureOption {
  std::string_view name;
  std::size_t most;  ///< words
  bool are_numbers;  ///< then the words end where no number follows
  bool is_noted;     ///< it would change what is seen, and is not used
};
constexpr std::array<TextureOption, 14> options{{{"-s", 3, true, false},
                                                 {"-o", 3, true, false},
                                                 {"-clamp", 1, false, false},
                                                 {"-bm", 1, true, false},
                                                 {"-texres", 1, true, false},
                                                 {"-blendu", 1, false, false},
                                                 {"-blendv", 1, false, false},
                                                 {"-t", 3, true, true},
                                                 {"-mm", 2, true, true},
                                                 {"-boost", 1, true, true},
                                                 {"-cc", 1, false, true},
                                                 {"-imfchan", 1, false, true},
                                                 {"-type", 1, false, true},
                                                 {"-colorspace", 1, false, true}}};

/// The name that notes give to a map that is not used; empty: the statement is none of those.
std::string_view other_map(std::string_view key) {
  if (key == "map_bump" || key == "map_Bump") return "bump";
  if (key == "map_disp" || key == "map_Disp") return "disp";
  for (const std::string_view name : {"map_Ka", "map_Ks", "map_Ns", "map_Ke", "bump", "disp", "refl", "norm"})
    if (key == name) return name;
  return {};
}

constexpr std::string_view blanks = " \t";

/// The next word, taken off the front.
std::string_view consume_word(std::string_view& rest) {
  rest.remove_prefix(std::min(rest.find_first_not_of(blanks), rest.size()));
  const std::string_view word = rest.substr(0, rest.find_first_of(blanks));
  rest.remove_prefix(word.size());
  return word;
}

std::string without_blanks(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  return std::string(text.substr(0, text.find_last_not_of(blanks) + 1));
}

/// The words after an option.
std::vector<std::string_view> arguments(const TextureOption& option, std::string_view& rest) {
  std::vector<std::string_view> words;
  while (words.size() < option.most) {
    std::string_view after = rest;
    const std::string_view word = consume_word(after);
    if (word.empty() || (option.are_numbers && !parse_decimal(word))) break;
    words.push_back(word);
    rest = after;
  }
  return words;
}

/// The first two of them, or what is there.
Vec2 pair_of(const std::vector<std::string_view>& words, double otherwise) {
  Vec2 out(otherwise);
  for (std::size_t i = 0; i < std::min<std::size_t>(words.size(), 2); ++i)
    out[static_cast<int>(i)] = parse_decimal(words[i]).value_or(otherwise);
  return out;
}

class MtlReader {
 public:
  /// `text` is what the file says with continued lines joined, `written` what stands in it.
  MtlReader(std::string_view text, std::string_view written, const std::string& file)
      : text_(text), written_(written), file_(file) {}

  Expected<MtlLibrary> run() {
    for (std::size_t at = 0; at < text_.size() && !error_;) {
      const std::size_t end = std::min(text_.find_first_of("\r\n", at), text_.size());
      read(text_.substr(at, end - at));
      at = end + 1;
    }
    if (error_) return fail(std::move(*error_));
    for (const std::string& option : unused_)
      out_.notes.push_back(fmt::format("The option {} is not used.", option));
    if (has_halo_)
      out_.notes.emplace_back("The option d -halo is not used: as much is let through at every angle.");
    return std::move(out_);
  }

 private:
  MtlMaterial& material() { return out_.materials.empty() ? nameless_ : out_.materials.back(); }

  void read(std::string_view rest) {
    const std::string_view key = consume_word(rest);
    MtlMaterial& m = material();
    if (key == "newmtl") return begin_material(without_blanks(rest));
    if (key == "Kd") return read_color(key, rest, m.diffuse);
    if (key == "Ks") return read_color(key, rest, m.specular);
    if (key == "Ke") return read_color(key, rest, m.emission);
    if (key == "Tf" || key == "Kt") return read_color(key, rest, m.transmittance);
    if (key == "Ns") return read_number(key, rest, m.shininess);
    if (key == "Ni") return read_number(key, rest, m.ior);
    if (key == "d") return read_dissolve(rest, m);
    if (key == "Tr") return read_transparency(rest, m);
    if (key == "illum") return read_illum(rest, m);
    if (key == "map_Kd") return read_texture(key, rest, m.colours);
    if (key == "map_d") return read_texture(key, rest, m.mask);
    if (const std::string_view name = other_map(key); !name.empty())
      if (!texture(key, rest, nullptr).file.empty()) m.other_maps.emplace(name);
  }

  void begin_material(std::string name) {
    if (name.empty()) return;
    out_.materials.push_back({std::move(name)});
    has_dissolve_ = has_transparency_ = false;
  }

  // ---- numbers ----

  /// `count` of them, where one alone may stand for all; none: the statement says something else, or is wrong.
  std::optional<Vec3> numbers(std::string_view key, std::string_view rest, std::size_t count) {
    rest = rest.substr(0, rest.find('#'));
    Vec3 out(0.0);
    std::size_t got = 0;
    for (; got < count; ++got) {
      const std::string_view word = consume_word(rest);
      if (word.empty()) break;
      if (got == 0 && (word == "spectral" || word == "xyz")) {
        unused_.insert(fmt::format("{} {}", key, word));
        return std::nullopt;
      }
      const auto value = parse_decimal(word);
      if (!value)
        fail_at(key, word,
                fmt::format("not a finite number (got {}, allowed for example 0.8)", printable(word)));
      out[static_cast<int>(got)] = value.value_or(0.0);
    }
    if (got == 1) return Vec3(out.x);
    if (got < count)
      fail_at(key, rest,
              fmt::format("too few numbers (got {}, allowed {})", got, count == 1 ? "1" : "1 or 3"));
    return out;
  }

  template <class Color>
  void read_color(std::string_view key, std::string_view rest, Color& color) {
    if (const auto value = numbers(key, rest, 3)) color = *value;
  }
  void read_number(std::string_view key, std::string_view rest, double& number) {
    if (const auto value = numbers(key, rest, 1)) number = value->x;
  }

  static void read_illum(std::string_view rest, MtlMaterial& m) {
    const std::string_view word = consume_word(rest);
    if (!word.empty()) m.illum = 0;
    std::from_chars(word.data(), word.data() + word.size(), m.illum);
  }

  void read_dissolve(std::string_view rest, MtlMaterial& m) {
    std::string_view after = rest;
    if (consume_word(after) == "-halo") has_halo_ = true, rest = after;
    read_number("d", rest, m.dissolve);
    has_dissolve_ = true;
    warn_of_both(m);
  }

  void read_transparency(std::string_view rest, MtlMaterial& m) {
    const auto value = numbers("Tr", rest, 1);
    if (!value) return;
    if (value->x == 1.0) {
      m.has_full_transparency = true;
      return;
    }
    if (!has_dissolve_) m.dissolve = 1.0 - value->x;
    has_transparency_ = true;
    warn_of_both(m);
  }

  void warn_of_both(const MtlMaterial& m) {
    if (has_dissolve_ && has_transparency_)
      out_.warnings.insert(fmt::format("Material '{}': Tr is not used, since d is given, too.", m.name));
  }

  // ---- textures ----

  /// What is not used of it goes to `unused` where that is asked for.
  static MtlTexture texture(std::string_view key, std::string_view rest, std::set<std::string>* unused) {
    MtlTexture out;
    for (;;) {
      std::string_view after = rest;
      const std::string_view word = consume_word(after);
      const auto* const option =
          std::find_if(options.begin(), options.end(), [&](const auto& o) { return o.name == word; });
      if (option == options.end()) break;
      rest = after;
      const auto words = arguments(*option, rest);
      if (word == "-s") out.scale = pair_of(words, 1.0);
      if (word == "-o") out.offset = pair_of(words, 0.0);
      if (word == "-clamp") out.clamped = words.empty() || !words.front().starts_with("off");
      if (option->is_noted && unused != nullptr) unused->insert(fmt::format("{} {} of textures", key, word));
    }
    out.file = without_blanks(rest);
    return out;
  }

  void read_texture(std::string_view key, std::string_view rest, MtlTexture& to) {
    MtlTexture read = texture(key, rest, &unused_);
    if (!read.file.empty()) to = std::move(read);
  }

  void fail_at(std::string_view key, std::string_view where, std::string reason) {
    if (error_) return;
    const LineColumn at = line_column(written_, static_cast<std::size_t>(where.data() - text_.data()));
    error_ = Error{ErrorKind::bad_input, std::move(reason), file_, at.line, at.column, std::string(key)};
  }

  std::string_view text_, written_;
  const std::string& file_;
  MtlLibrary out_;
  MtlMaterial nameless_{};                                // what stands before the first newmtl
  bool has_dissolve_ = false, has_transparency_ = false;  // the material at hand
  std::set<std::string> unused_;
  bool has_halo_ = false;
  std::optional<Error> error_;
};

}  // namespace

Expected<MtlLibrary> parse_mtl(std::string_view text, const std::string& file) {
  text = without_byte_order_mark(text);
  const std::string joined = join_continued_lines(text);
  return MtlReader(joined, text, file).run();
}

}  // namespace gnomon
