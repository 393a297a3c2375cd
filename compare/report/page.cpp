#include "compare/report/page.h"

#include <fmt/format.h>

#include <embedded/report.h>

#include "compare/outputs.h"
#include "compare/report/html.h"
#include "scene/files/sha256.h"

namespace gnomon::compare {
namespace {

// A content-security-policy source for an inline block: 'sha256-' and its digest in base64.
std::string hash_source(std::string_view block) {
  const std::string hex = sha256_hex(block);
  std::string digest;
  for (std::size_t i = 0; i < hex.size(); i += 2)
    digest += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
  return "'sha256-" + base64(digest) + "'";
}

std::string head(const std::string& title) {
  const std::string_view css = embedded::report("report.css"), js = embedded::report("report.js");
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; style-src "
      "{}; "
      "script-src {}; base-uri 'none'; form-action 'none'\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{}</title>\n"
      "<link rel=\"icon\" href=\"data:,\">\n<style>{}</style>\n</head>\n",
      hash_source(css), hash_source(js), escaped(title), css);
}

std::string image(const EncodedPicture& picture, std::string_view alt) {
  return fmt::format("<img src=\"{}\" width=\"{}\" height=\"{}\" alt=\"{}\">",
                     data_uri("image/png", picture.png), picture.size.width, picture.size.height,
                     escaped(alt));
}

}  // namespace

std::string report_page(const PageInput& in) {
  const Comparison& c = in.comparison;
  std::string body = fmt::format("<body>\n<main>\n<h1>{}</h1>\n", escaped(c.world->scene->name));
  body += image(in.pictures.raster, "Rasterized") + image(in.pictures.raytraced, "Ray traced");
  for (std::size_t i = 0; i < c.lights.size(); ++i) {
    body += fmt::format("<p>{}</p>\n", escaped(verdict_sentence(c, c.lights[i])));
    body += image(in.pictures.lights[i].difference, "Difference") +
            image(in.pictures.lights[i].labels, "Labels") +
            image(in.pictures.lights[i].depth_map_small, "Depth map");
  }
  body += fmt::format(
      "</main>\n<script type=\"application/json\" "
      "id=\"result\">{}</script>\n<script>{}</script>\n</body>\n</html>\n",
      script_safe(in.json), embedded::report("report.js"));
  return head(c.world->scene->name) + body;
}

Expected<std::string> report_html(const Comparison& comparison) {
  const Expected<PictureSet> pictures = encode_pictures(comparison);
  if (!pictures) return fail(pictures.error());
  return report_page(
      {comparison, *pictures, result_json(comparison), result_csv(comparison), comparison.total_ms});
}

}  // namespace gnomon::compare
