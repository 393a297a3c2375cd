#include "compare/report/page.h"

#include <fmt/format.h>

#include <embedded/report.h>

#include "compare/number_text.h"
#include "compare/outputs.h"
#include "compare/report/html.h"
#include "compare/report/page_data.h"
#include "compare/report/sections.h"
#include "scene/files/sha256.h"

namespace gnomon::compare {
namespace {

// The built page (page/dist/page.html): style and script inline, with two places left for what is written
// here.
struct Template {
  std::string_view before_head, after_head, after_body, style, script;
};

// Text between the end of the tag that `opening` starts and `closing`.
std::string_view inline_block(std::string_view html, std::string_view opening, std::string_view closing) {
  const std::size_t tag = html.find(opening), start = html.find('>', tag) + 1;
  return html.substr(start, html.find(closing, start) - start);
}

Template page_template() {
  constexpr std::string_view head_mark = "<!--gnomon:head-->", body_mark = "<!--gnomon:body-->";
  const std::string_view html = embedded::report("page.html");
  const std::size_t head = html.find(head_mark), body = html.find(body_mark);
  const std::size_t after_head = head + head_mark.size();
  return {html.substr(0, head), html.substr(after_head, body - after_head),
          html.substr(body + body_mark.size()), inline_block(html, "<style", "</style>"),
          inline_block(html, "<script", "</script>")};
}

// A content-security-policy source for one inline block: the base64 of its SHA-256.
std::string hash_source(std::string_view block) {
  const std::string hex = sha256_hex(block);
  std::string digest;
  for (std::size_t i = 0; i < hex.size(); i += 2)
    digest += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
  return "'sha256-" + base64(digest) + "'";
}

std::string title(const Comparison& c) {
  std::string text = c.world->scene->name;
  if (c.lights.size() == 1 && c.lights[0].pixels.compared > 0)
    text += ": " + percent(c.lights[0].error.wrong_fraction) + " wrong";
  return text + " \u2013 Gnomon";
}

std::string head(const Comparison& c, const Template& page) {
  return fmt::format(
      R"(<meta http-equiv="Content-Security-Policy" content="{}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>{}</title>
<link rel="icon" href="data:,">)",
      page_security_policy(page.style, page.script), escaped(title(c)));
}

std::string navigation(const Comparison& c) {
  std::string links = R"(<li><a href="#overview">Overview</a></li>)";
  for (std::size_t i = 0; i < c.lights.size(); ++i)
    links += fmt::format(R"(<li><a href="#light-{}">Light: {}</a></li>)", i, escaped(shown_light_name(c, i)));
  links +=
      R"(<li><a href="#cost">Time and work</a></li><li><a href="#effects">Effects</a></li><li><a
href="#provenance">Provenance</a></li>)";
  return R"(<header class="bar-top"><span class="brand">Gnomon</span>
<nav aria-label="Sections"><ul>)" +
         links + "</ul></nav></header>\n";
}

}  // namespace

std::string page_security_policy(std::string_view style, std::string_view script) {
  return fmt::format(
      "default-src 'none'; img-src data:; style-src {}; script-src {}; base-uri 'none'; form-action 'none'",
      hash_source(style), hash_source(script));
}

std::string_view page_style() {
  return page_template().style;
}

std::string report_page(const PageInput& in) {
  const Comparison& c = in.comparison;
  const Template built = page_template();
  std::string page(built.before_head);
  page.append(head(c, built)).append(built.after_head);
  page += R"(<a class="skip" href="#overview">Skip to the report</a>
)" + navigation(c);
  page += "<main>\n" + overview_section(in);
  for (std::size_t i = 0; i < c.lights.size(); ++i) page += light_section(in, i);
  page += cost_section(in) + effects_section(in) + provenance_section(in) + "</main>\n";
  page += R"(<script type="application/json" id="result">)" + script_safe(in.json) + "</script>\n";
  page += R"(<script type="application/json" id="page-data">)" + script_safe(page_data(in)) + "</script>\n";
  return page.append(built.after_body);
}

Expected<std::string> report_html(const Comparison& comparison) {
  const Expected<PictureSet> pictures = encode_pictures(comparison);
  if (!pictures) return fail(pictures.error());
  return report_page(
      {comparison, *pictures, result_json(comparison), result_csv(comparison), comparison.total_ms});
}

}  // namespace gnomon::compare
