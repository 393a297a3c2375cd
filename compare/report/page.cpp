#include "compare/report/page.h"

#include <fmt/format.h>

#include <embedded/report.h>

#include "compare/number_text.h"
#include "compare/outputs.h"
#include "compare/report/html.h"
#include "compare/report/sections.h"
#include "scene/files/sha256.h"

namespace gnomon::compare {
namespace {

// A content-security-policy source for one inline block: the base64 of its SHA-256.
std::string hash_source(std::string_view block) {
  const std::string hex = sha256_hex(block);
  std::string digest;
  for (std::size_t i = 0; i < hex.size(); i += 2)
    digest += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
  return "'sha256-" + base64(digest) + "'";
}

// Nothing may be loaded, sent or run but the page's own images, style and script.
std::string security_policy() {
  return fmt::format(
      "default-src 'none'; img-src data:; style-src {}; script-src {}; base-uri 'none'; form-action 'none'",
      hash_source(embedded::report("report.css")), hash_source(embedded::report("report.js")));
}

std::string title(const Comparison& c) {
  std::string text = c.world->scene->name;
  if (c.lights.size() == 1 && c.lights[0].pixels.compared > 0)
    text += ": " + percent(c.lights[0].error.wrong_fraction) + " wrong";
  return text + " \u2013 Gnomon";
}

std::string head(const Comparison& c) {
  return fmt::format(
      R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="{}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>{}</title>
<link rel="icon" href="data:,">
<style>{}</style>
</head>
)",
      security_policy(), escaped(title(c)), embedded::report("report.css"));
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

std::string report_page(const PageInput& in) {
  const Comparison& c = in.comparison;
  std::string page = head(c) + R"(<body>
<a class="skip" href="#overview">Skip to the report</a>
)" + navigation(c);
  page += "<main>\n" + overview_section(in);
  for (std::size_t i = 0; i < c.lights.size(); ++i) page += light_section(in, i);
  page += cost_section(in) + effects_section(in) + provenance_section(in) + "</main>\n";
  page += R"(<script type="application/json" id="result">)" + script_safe(in.json) + "</script>\n";
  page.append("<script>").append(embedded::report("report.js")).append("</script>\n</body>\n</html>\n");
  return page;
}

Expected<std::string> report_html(const Comparison& comparison) {
  const Expected<PictureSet> pictures = encode_pictures(comparison);
  if (!pictures) return fail(pictures.error());
  return report_page(
      {comparison, *pictures, result_json(comparison), result_csv(comparison), comparison.total_ms});
}

}  // namespace gnomon::compare
