// What stands at the head of every page that the program writes, whatever it is about: a content-security policy, by which
// nothing may be loaded, sent or run but the page's own style and script and its pictures.
#pragma once

#include <string>
#include <string_view>

namespace gnomon::compare {

struct PageHead {
  std::string_view title;     ///< not escaped
  std::string_view style;     ///< all that stands between <style> and </style>
  std::string_view script{};  ///< all that stands between <script> and </script>; empty: no script may run
  bool beside = false;        ///< the page has files of pictures and data beside it
};

/// Elements of <head>, to follow the one that names the encoding; the style and the script themselves are not among them.
std::string page_head(const PageHead& head);

}  // namespace gnomon::compare
