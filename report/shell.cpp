#include "report/shell.h"

#include <fmt/format.h>

#include <embedded/report.h>

#include "compare/result/palette.h"
#include "report/html.h"

namespace gnomon::report {
namespace {

// The built page: style and script inline, with two places left for what is written here.
struct Template {
  std::string_view before_head, after_head, after_body, style, script;
};

// Text between the end of the tag that `opening` starts and `closing`.
std::string_view inline_block(std::string_view html, std::string_view opening, std::string_view closing) {
  const std::size_t tag = html.find(opening), start = html.find('>', tag) + 1;
  return html.substr(start, html.find(closing, start) - start);
}

Template page_template(std::string_view name) {
  constexpr std::string_view head_mark = "<!--gnomon:head-->", body_mark = "<!--gnomon:body-->";
  const std::string_view html = embedded::report(name);
  const std::size_t head = html.find(head_mark), body = html.find(body_mark);
  const std::size_t after_head = head + head_mark.size();
  return {html.substr(0, head), html.substr(after_head, body - after_head),
          html.substr(body + body_mark.size()), inline_block(html, "<style", "</style>"),
          inline_block(html, "<script", "</script>")};
}

constexpr std::string_view data_file_head = "(globalThis.gnomonFiles=globalThis.gnomonFiles||{})",
                           data_file_value = "]=";

/// Writes the fixed colours and scales as JSON: colours by name, the stops of scales evenly spaced from 0 to 1.
std::string palette_json() {
  const auto quoted = [](const glm::u8vec3& c) { return fmt::format("\"{}\"", hex_colour(c.r, c.g, c.b)); };
  const auto stops = [&](glm::u8vec3 (*scale)(double)) {
    std::vector<std::string> list;
    for (int i = 0; i <= 8; ++i) list.push_back(quoted(scale(i / 8.0)));
    return fmt::format("[{}]", fmt::join(list, ","));
  };
  return fmt::format(
      R"({{"false_shadow":{},"missed_shadow":{},"surely_lit":{},"surely_shadowed":{},"traced":{},"viridis":{},"magma":{}}})",
      quoted(compare::false_shadow_colour), quoted(compare::missed_shadow_colour),
      quoted(compare::surely_lit_colour), quoted(compare::surely_shadowed_colour),
      quoted(compare::traced_colour), stops(compare::viridis), stops(compare::magma));
}

// The data with its parts, which are large, or with the folder that holds them.
void append_data(std::string& html, const PageShell& shell) {
  append_script_safe(html, std::string_view(shell.data).substr(0, shell.data.rfind('}')));
  html += shell.data.find(':') == std::string::npos ? "" : ",";
  html += "\"palette\":" + palette_json() + ",";
  if (shell.beside) return append_script_safe(html, fmt::format("\"folder\":\"{}\"}}", shell.folder));
  html += "\"parts\":{";
  for (std::size_t i = 0; i < shell.parts.size(); ++i) {
    append_script_safe(html, fmt::format("{}\"{}\":", i > 0 ? "," : "", shell.parts[i].name));
    append_script_safe(html, shell.parts[i].json);
  }
  html += "}}";
}

std::size_t bytes_of(const PageShell& shell) {
  std::size_t bytes = shell.main.size() + 4 * shell.result.size() + shell.data.size();
  for (const PagePicture& picture : shell.pictures) bytes += picture.source.size();
  for (const DataPart& part : shell.parts) bytes += shell.beside ? 0 : part.json.size();
  return bytes;
}

/// "Sweep of fence" of the title "Sweep of fence – Gnomon".
std::string_view without_program(std::string_view title) {
  return title.substr(0, title.rfind(" \u2013 "));
}

}  // namespace

double BuiltPage::megabytes() const {
  std::size_t bytes = html.size();
  for (const PageFile& file : files) bytes += file.bytes.size();
  return static_cast<double>(bytes) / 1e6;
}

std::string data_file(const DataPart& part) {
  return fmt::format("{}[\"{}\"{}{};\n", data_file_head, part.name, data_file_value, part.json);
}

std::string_view data_in_file(std::string_view file) {
  const std::size_t value = file.find(data_file_value);
  if (!file.starts_with(data_file_head) || value == std::string_view::npos || !file.ends_with(";\n"))
    return {};
  const std::size_t start = value + data_file_value.size();
  return file.substr(start, file.size() - 2 - start);
}

BuiltPage build_page(const PageShell& shell) {
  const Template built = page_template(shell.built);
  BuiltPage out;
  out.html.reserve(bytes_of(shell) + embedded::report(shell.built).size() + (std::size_t{1} << 16));
  constexpr std::string_view own_language = "lang=\"en\"";
  out.html = built.before_head;
  if (const std::size_t at = out.html.find(own_language); at != std::string::npos)
    out.html.replace(at, own_language.size(), fmt::format("lang=\"{}\"", shell.language));
  out.html.append(page_head({shell.title, built.style, built.script, shell.beside, shell.live}))
      .append(built.after_head);
  out.html += fmt::format(R"(<a class="skip" href="#main">{}</a>)", shell.skip);
  out.html += R"(
<header class="bar-top"><span class="brand">Gnomon</span>
<nav aria-label="Sections"><ul>)" +
              shell.links + "</ul></nav></header>\n<main id=\"main\">\n";
  out.html +=
      shell.main.empty()
          ? plain_page({without_program(shell.title), shell.said, shell.pictures, shell.saved, shell.result})

          : shell.main;
  out.html += "</main>\n";
  if (!shell.result.empty()) {
    out.html += R"(<script type="application/json" id="result">)";
    append_script_safe(out.html, shell.result);
    out.html += "</script>\n";
  }
  out.html += R"(<script type="application/json" id="page-data">)";
  append_data(out.html, shell);
  out.html += "</script>\n";
  out.html.append(built.after_body);
  if (shell.beside)
    for (const DataPart& part : shell.parts)
      out.files.push_back({fmt::format("{}/{}.js", shell.folder, part.name), data_file(part)});
  return out;
}

std::string static_page(std::string_view title, std::string_view main) {
  const Template built = page_template("page.html");
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n{}<style>{}</style>\n</head>\n"
      "<body>\n<main id=\"main\">\n{}</main>\n</body>\n</html>\n",
      page_head({title, built.style}), built.style, main);
}

}  // namespace gnomon::report
