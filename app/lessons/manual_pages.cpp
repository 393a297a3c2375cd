#include <embedded/manual_pages.h>

#include <fmt/core.h>

#include "app/lessons/site.h"

namespace gnomon::app::lessons {
namespace {

/// "options.md" is options.html, of those that there are; README.md is the first.
std::string page_of(std::string_view target) {
  const std::string_view name = target.substr(target.rfind('/') + 1);
  if (target.starts_with('#')) return std::string(target);
  if (target == "README.md") return "index.html";
  if (embedded::manual_pages(name).empty() || name == "README.md") return {};
  return std::string(name.substr(0, name.rfind('.'))) + ".html";
}

/// "Commands and options" of "# Commands and options".
std::string title_of(std::string_view text) {
  const std::size_t at = text.find("# ") + 2;
  return std::string(text.substr(at, text.find('\n', at) - at));
}

}  // namespace

Expected<std::vector<SitePage>> manual_pages() {
  std::vector<SitePage> pages;
  for (const auto& [name, text] : embedded::manual_pages_entries()) {
    const auto html = html_of(text);
    if (!html) return fail(html.error());
    const std::string file = page_of(name);
    pages.push_back(
        {file, page_of_text(
                   fmt::format("{} \u2013 Gnomon", title_of(text)),
                   "<li><a href=\"../index.html\">Start</a></li><li><a href=\"index.html\">Manual</a></li>",
                   "<article class=\"lesson-text\">\n" + with_links(*html, page_of) + "</article>\n")});
  }
  return pages;
}

}  // namespace gnomon::app::lessons
