// The page for who lets no script run: its pictures, and what its document says as plain tables. Where scripts run, the
// page's own sections take its place, and its pictures with them (page/src/frame.ts).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace gnomon::report {

/// A picture that stands once in the page.
struct PagePicture {
  std::string name;           ///< by which the page's sections ask for it
  std::string source;         ///< a data URI, or the address of a file beside the page
  int width = 0, height = 0;  ///< 0: not known
  std::string alt{};          ///< what it shows; not escaped
  std::string caption{};      ///< without scripts; empty: the same
  bool waits = false;         ///< to be loaded until it is about to be seen
};

/// A file to be saved from the page.
struct PageLink {
  std::string name;    ///< of the file
  std::string source;  ///< a data URI, or its address
};

struct PlainPage {
  std::string_view title;                ///< not escaped
  const std::vector<std::string>& said;  ///< sentences to be read first, not escaped
  const std::vector<PagePicture>& pictures;
  const std::vector<PageLink>& saved;
  std::string_view document;  ///< JSON text
};

/// HTML with the title, the pictures, links to the files, and tables of the document's values, but for what single runs
/// took. Numbers have their keys, as in the sections: <data value="4" data-key="lights.0.error.wrong">. Those of lists have
/// none: they have a table of their own, of which the first 25 rows are shown.
std::string plain_page(const PlainPage& page);

}  // namespace gnomon::report
