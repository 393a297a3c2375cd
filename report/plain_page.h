// The page for who lets no script run: its pictures, and what its document says as plain tables. Where scripts run, the
// page's own sections take its place, and its pictures with them (page/src/frame.ts).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace gnomon::compare {

/// A picture that stands once in the page.
struct PagePicture {
  std::string name;           ///< by which the page's sections ask for it
  std::string source;         ///< a data URI, or the address of a file beside the page
  int width = 0, height = 0;  ///< 0: not known
  std::string alt{};          ///< what it shows; not escaped
  std::string caption{};      ///< without scripts; empty: the same
  bool waits = false;         ///< to be loaded until it is about to be seen
};

/// HTML with `title`, the pictures, and tables of all values of `document`, a JSON text. Numbers have their keys, as in the
/// sections: <data value="4" data-key="lights.0.error.wrong">.
std::string plain_page(std::string_view title, const std::vector<PagePicture>& pictures,
                       std::string_view document);

}  // namespace gnomon::compare
