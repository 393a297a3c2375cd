#include <embedded/manual_pages.h>

#include <fmt/core.h>

#include <algorithm>
#include <cctype>

#include "lab/lessons/site.h"

namespace gnomon::lab::lessons {
namespace {

std::string stem_of(std::string_view file) {
  return std::string(file.substr(0, file.rfind('.')));
}

/// "options.md" is options.html, of those that there are; README.md is the first.
std::string page_of(std::string_view target, const std::vector<ManualChapter>& all) {
  const std::string_view path = target.substr(0, target.find('#')), place = target.substr(path.size());
  const std::string_view name = path.substr(path.rfind('/') + 1);
  if (path.empty()) return std::string(target);
  if (path == "README.md") return "index.html";
  const auto is_it = [&](const ManualChapter& chapter) { return chapter.file == name; };
  if (name == "README.md" || std::none_of(all.begin(), all.end(), is_it)) return {};
  return fmt::format("{}.html{}", stem_of(name), place);
}

/// `gnomon --manual options` leads to options.html.
std::string with_printed(std::string html, std::string_view file) {
  const std::string words = fmt::format("<code>gnomon --manual {}</code>", stem_of(file));
  const std::string link = fmt::format("<a href=\"{}.html\">{}</a>", stem_of(file), words);
  for (std::size_t at = 0; (at = html.find(words, at)) != std::string::npos; at += link.size())
    html.replace(at, words.size(), link);
  return html;
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
    if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_')
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

Expected<std::vector<SitePage>> manual_pages(std::vector<ManualChapter> chapters) {
  const std::vector<ManualChapter> printed = chapters;
  for (const auto& [name, text] : embedded::manual_pages_entries())
    chapters.push_back({std::string(name), std::string(text)});
  const auto target = [&](std::string_view link) { return page_of(link, chapters); };
  std::vector<SitePage> pages;
  for (const auto& [name, text] : chapters) {
    const auto html = html_of(text);
    if (!html) return fail(html.error());
    std::string article = with_links(with_places(*html), target);
    for (const ManualChapter& chapter : printed) article = with_printed(std::move(article), chapter.file);
    pages.push_back(
        {target(name),
         page_of_text(
             fmt::format("{} \u2013 Gnomon", title_of(text)),
             "<li><a href=\"../index.html\">Start</a></li><li><a href=\"index.html\">Manual</a></li>",
             "<article class=\"lesson-text\">\n" + article + "</article>\n")});
  }
  return pages;
}

}  // namespace gnomon::lab::lessons
