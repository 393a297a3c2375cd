// The few things that writing HTML needs: escaping, data URIs, colours.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "scene/image.h"

namespace gnomon::report {

/// Text for element content and quoted attributes. Control characters of ASCII become spaces; those of Unicode, and what is
/// not UTF-8, escapes (scene/base/expected.h).
std::string escaped(std::string_view text);
/// Escapes text and holds numbers together with the word behind them ("4.1 %" and "8 x 8" do not break), and options whole.
std::string flowing(std::string_view text);
/// A file's name as a part of a relative address: "shot#1" -> "shot%231".
std::string url_segment(std::string_view name);
std::string data_uri(std::string_view mime, std::string_view bytes);
/// Appends JSON text that may stand inside <script>: no '<' is left in it, and no character in its strings that changes the
/// order in which they are shown.
void append_script_safe(std::string& html, std::string_view json);

/// A small square of a colour with a letter on it, as legends show it; decoration, hidden from screen
/// readers.
std::string swatch(const glm::u8vec3& colour, std::string_view letter);
/// "#d55e00"
std::string hex_colour(std::uint8_t r, std::uint8_t g, std::uint8_t b);

// What stands at the head of every page that the program writes, whatever it is about. It is a content-security policy. By
// that nothing may be loaded, sent or run but the page's own style and script and its pictures.

/// Whom a page asks that is no document.
enum class LivePage : std::uint8_t {
  no,
  served,  ///< the server that it came from, whose pictures and pages it shows
  worker   ///< a program in a worker of its own, by files beside it
};

struct PageHead {
  std::string_view title;     ///< not escaped
  std::string_view style;     ///< all that stands between <style> and </style>
  std::string_view script{};  ///< all that stands between <script> and </script>; empty: no script may run
  bool beside = false;        ///< the page has files of pictures and data beside it
  LivePage live = LivePage::no;
};

/// Elements of <head>, to follow the one that names the encoding; the style and the script themselves are not among them.
std::string page_head(const PageHead& head);

}  // namespace gnomon::report
