#include <embedded/manual_pages.h>

#include <fmt/core.h>

#include <cctype>

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

/// "shared-options" of "Shared options", as GitHub names a heading's place.
std::string place_of(std::string_view heading) {
  std::string place;
  for (const char c : heading) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-')
      place += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    else if (c == ' ')
      place += '-';
  }
  return place;
}

/// Gives every heading a place that links lead to, and every shared option: "--map-size" (the lab's panels lead there).
std::string with_places(std::string_view html) {
  constexpr std::string_view heading = "<h2>", option = "<li><code>--", shared = "Shared options</h2>";
  std::string out;
  bool is_shared = false;
  for (std::size_t at = 0; at < html.size();) {
    const std::string_view rest = html.substr(at);
    if (rest.starts_with(heading)) {
      const std::string_view words = rest.substr(heading.size(), rest.find("</h2>") - heading.size());
      is_shared = rest.substr(heading.size()).starts_with(shared);
      out += fmt::format("<h2 id=\"{}\">", place_of(words));
      at += heading.size();
    } else if (is_shared && rest.starts_with(option)) {
      const std::size_t name = option.size() - 2;
      out += fmt::format("<li id=\"{}\"><code>", rest.substr(name, rest.find_first_of(" <", name) - name));
      at += name;
    } else {
      out += html[at++];
    }
  }
  return out;
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
                   "<article class=\"lesson-text\">\n" + with_links(with_places(*html), page_of) +
                       "</article>\n")});
  }
  return pages;
}

}  // namespace gnomon::app::lessons
