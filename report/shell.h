// What every page has, whatever it is about. It has the built page (page/dist/page.html) with its style and
// script, the content-security policy, the bar on top, and the data that the script reads. The data's large
// parts and the pictures stand in the page itself, or, where it would grow too large, in files beside it.
// Those work from disk as well: pictures by <img>, data by <script> (a page from disk may fetch nothing).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "report/html.h"
#include "report/plain_page.h"

namespace gnomon::report {

/// A file beside report.html; the name is relative to its folder.
struct PageFile {
  std::string name, bytes;
};

struct BuiltPage {
  std::string html;
  std::vector<PageFile> files;  ///< of the data; pictures beside the page are the caller's
  double megabytes() const;
};

/// A part of the page's data that may stand in a file of its own: JSON text.
struct DataPart {
  std::string name, json;
};

struct PageShell {
  std::string title;  ///< not escaped
  std::string links;  ///< <li> items of the bar on top; of a page without `main` the script makes them
  std::string main;   ///< what <main> holds; empty: the script's sections, or the plain page without scripts
  std::vector<std::string> said{};  ///< of a page without `main`: what is to be read first without scripts
  std::vector<PagePicture> pictures{};  ///< the same
  std::vector<PageLink> saved{};        ///< the same
  std::string result;           ///< JSON text that other programs know, under id "result"; may be empty
  std::string data;             ///< JSON object that the script reads; the palette is added to it
  std::vector<DataPart> parts;  ///< added to it
  bool beside = false;          ///< the parts go into files
  std::string folder = "report-data";    ///< of these files
  std::string_view built = "page.html";  ///< which of the built pages
  LivePage live = LivePage::no;
  std::string_view skip = "Skip to the report";
  std::string_view language = "en";  ///< of its text (BCP 47), by which screen readers go
};

BuiltPage build_page(const PageShell& shell);

/// A page in the report's style that needs no script and has none; `main` is what <main> holds.
std::string static_page(std::string_view title, std::string_view main);

/// What a data file holds, and the JSON text in such a file.
std::string data_file(const DataPart& part);
std::string_view data_in_file(std::string_view file);

}  // namespace gnomon::report
