// What the hybrid did for one light: which pixels the sheets decided, where rays were cast, and what it took.
#include <fmt/core.h>

#include "compare/result/option_names.h"
#include "compare/result/output_parts.h"
#include "compare/result/palette.h"
#include "report/html.h"
#include "report/lessons.h"
#include "report/light_block.h"

namespace gnomon::compare {
namespace {

std::string share_of(std::uint64_t part, std::uint64_t whole) {
  return whole > 0 ? percent(static_cast<double>(part) / static_cast<double>(whole)) : std::string("none");
}

std::string count_row(const LightBlock& b, glm::u8vec3 colour, std::string_view name, std::string_view key,
                      std::uint64_t count, std::uint64_t receivers) {
  return fmt::format(
      R"(<tr><td>{}</td><th scope="row">{}</th><td class="n">{}</td><td class="n">{}</td></tr>
)",
      swatch(colour, ""), name, keyed_count(b.key(fmt::format("map.hybrid.{}", key)), count),
      share_of(count, receivers));
}

std::string counts(const LightBlock& b, const raster::ExternalCosts& e) {
  return fmt::format(
      R"(<table><thead><tr><td></td><th scope="col">of the pixels that the light can reach</th><th scope="col"
class="n">pixels</th><th scope="col" class="n">share</th></tr></thead><tbody>
{}{}{}</tbody></table>)",
      count_row(b, surely_lit_colour, "surely lit", "surely_lit", e.surely_lit, e.receivers),
      count_row(b, surely_shadowed_colour, "surely in shadow", "surely_shadowed", e.surely_shadowed,
                e.receivers),
      fmt::format(R"(<tr><td>{}</td><th scope="row">ambiguous: traced</th><td class="n">{}</td><td
class="n">{}</td></tr>
)",
                  swatch(traced_colour, ""), grouped(e.receivers - e.surely_lit - e.surely_shadowed),
                  share_of(e.receivers - e.surely_lit - e.surely_shadowed, e.receivers)));
}

std::string costs(const LightBlock& b, const raster::ExternalCosts& e) {
  const auto time = [&b](std::string_view name, const Times& times) {
    return keyed(b.key(fmt::format("map.hybrid.times_ms.{}.median", name)), times.median(),
                 milliseconds(times.median()));
  };
  return fmt::format(
      "<p>{} rays were cast where pure ray tracing asks for {}: {}. The sheets took {} to build and hold {} "
      "while light and scene stand still; each frame took {} to find the receivers and {} to decide and "
      "trace.</p>\n",
      keyed_count(b.key("map.hybrid.rays"), e.rays), keyed_count(b.key("map.hybrid.all_rays"), e.all_rays),
      share_of(e.rays, e.all_rays), time("build", e.build), byte_count(e.bytes),
      time("receivers", e.receivers_ms), time("shadow", e.shadow));
}

}  // namespace

std::string hybrid_block(const LightBlock& b) {
  const auto& external = drawn_record(b.in.comparison, b.light).external;
  if (!external) return "";
  const EncodedPicture& decisions = b.in.pictures.lights[b.index].decisions;
  std::string out = "<h3>Who decided each pixel</h3>\n<div class=\"columns\">\n<div>";
  out += counts(b, *external) + costs(b, *external) + lesson_details(lesson("hybrid")) + "</div>\n";
  if (!decisions.png.empty())
    out += "<figure>" +
           picture(b.in, decisions,
                   "The picture in grey, tinted where the map decides alone; traced pixels stand out.",
                   fmt::format("picture-decisions-{}", b.index)) +
           "<figcaption>Rays were cast for the dark red pixels alone.</figcaption></figure>\n";
  return out + "</div>\n";
}

}  // namespace gnomon::compare
