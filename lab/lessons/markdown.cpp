#include "lab/lessons/site.h"

#include <embedded/lesson_images.h>
#include <fmt/core.h>
#include <md4c-html.h>
#include <md4c.h>

#include "report/html.h"

namespace gnomon::lab::lessons {

namespace {

void append(const MD_CHAR* text, MD_SIZE size, void* out) {
  static_cast<std::string*>(out)->append(text, size);
}

/// The text with every stretch from `opening` to `closing` replaced by what `replacement` makes of that between.
template <class Replacement>
std::string replaced(const std::string& html, std::string_view opening, std::string_view closing,
                     const Replacement& replacement) {
  std::string out;
  std::size_t copied = 0;
  for (std::size_t at = html.find(opening); at != std::string::npos; at = html.find(opening, copied)) {
    const std::size_t start = at + opening.size(), end = html.find(closing, start);
    if (end == std::string::npos) break;
    out.append(html, copied, at - copied);
    out += replacement(std::string_view(html).substr(start, end - start));
    copied = end + closing.size();
  }
  return out.append(html, copied);
}

/// "../images/a.png" is a.png.
std::string_view file_name(std::string_view path) {
  return path.substr(path.rfind('/') + 1);  // npos + 1 is 0
}

/// "../defaults.md" of docs/lessons is docs/defaults.md.
std::string in_project(std::string_view path) {
  std::string_view folder = "docs/lessons/";
  while (path.starts_with("../")) {
    path.remove_prefix(3);
    folder = folder.substr(0, folder.substr(0, folder.size() - 1).rfind('/') + 1);
  }
  return std::string(folder) + std::string(path);
}

}  // namespace

Expected<std::string> html_of(std::string_view markdown) {
  std::string html;
  const unsigned dialect = MD_FLAG_TABLES | MD_FLAG_STRIKETHROUGH;
  if (md_html(markdown.data(), static_cast<MD_SIZE>(markdown.size()), append, &html, dialect, 0) != 0)
    return fail(ErrorKind::internal, "a lesson's Markdown cannot be read");
  html = replaced(html, "<table>", "</table>", [](std::string_view table) {
    return fmt::format(
        "<div class=\"scroll\" role=\"group\" tabindex=\"0\" aria-label=\"Table\"><table>{}</table></div>",
        table);
  });
  // A corner of a table without words is no heading.
  for (const char* align : {"", " align=\"left\"", " align=\"center\"", " align=\"right\""})
    html = replaced(html, fmt::format("<th{}>", align), "</th>", [align](std::string_view cell) {
      return fmt::format("<{0}{1}>{2}</{0}>", cell.empty() ? "td" : "th", align, cell);
    });
  return html;
}

std::string with_links(const std::string& html, const std::function<std::string(std::string_view)>& target) {
  return replaced(html, "<a href=\"", "</a>", [&](std::string_view link) {
    const std::string_view address = link.substr(0, link.find('"')), words = link.substr(link.find('>') + 1);
    if (address.find("://") != std::string_view::npos)
      return fmt::format("<a href=\"{}\">{}</a>", address, words);
    if (const std::string page = target(address); !page.empty())
      return fmt::format("<a href=\"{}\">{}</a>", page, words);
    return fmt::format("{} (<code>{}</code>)", words, in_project(address));
  });
}

std::string first_picture(std::string_view markdown) {
  const std::size_t start = markdown.find("](", markdown.find("!["));
  if (start == std::string_view::npos) return {};
  return std::string(markdown.substr(start + 2, markdown.find(')', start) - start - 2));
}

Expected<std::string> picture_html(std::string_view path, std::string_view alt) {
  const std::string_view bytes = embedded::lesson_images(file_name(path));
  if (bytes.empty())
    return fail(ErrorKind::internal, fmt::format("a lesson's picture is missing (got {})", path));
  return fmt::format("<img src=\"{}\" alt=\"{}\">",
                     report::data_uri(path.ends_with(".svg") ? "image/svg+xml" : "image/png", bytes), alt);
}

Expected<std::string> with_pictures(const std::string& html) {
  Expected<void> missing;
  std::string out = replaced(html, "<img src=\"", ">", [&](std::string_view image) {
    const std::size_t alt = image.find("alt=\"") + 5;
    const auto made =
        picture_html(image.substr(0, image.find('"')), image.substr(alt, image.find('"', alt) - alt));
    if (!made) missing = fail(made.error());
    return made.value_or(std::string());
  });
  if (!missing) return fail(missing.error());
  return out;
}

}  // namespace gnomon::lab::lessons
