#include "compare/result/judged.h"

#include <fmt/core.h>

#include "compare/result/map_words.h"
#include "compare/result/number_text.h"
#include "compare/result/output_parts.h"

namespace gnomon::compare {
namespace {

std::string agreement_text(const Judged& j) {
  std::string text;
  for (const Agreement& one : j.agreement)
    text += fmt::format("{}{} of the {}", text.empty() ? "" : ", ", percent(one.share), one.what);
  return text.empty() ? "nothing to tell it by" : text;
}

std::string settings_text(const Judged& j) {
  std::string text;
  for (const auto& [key, value] : j.settings)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", key, value);
  return text;
}

std::string identified_text(const Identified& i) {
  return fmt::format(
      "inferred from the picture alone: nearest is {} ({}); it explains {} of the error, and "
      "differs "
      "from the picture by {} in the mean",
      i.options, counted(i.renders, "drawing"), percent(i.explained), percent(i.model_error));
}

std::string ladder_text(const Comparison& c) {
  const Judged& j = *c.judged;
  if (j.has_map)
    return fmt::format(
        "that of its own map, matrix and bias; the test (V5) is what was drawn on {} of the pixels",
        percent(j.biased_is_drawn));
  if (j.identified) return "inferred: that of the nearest setting of Gnomon's own, up to what was drawn";
  if (j.traces) return "that of its rays: no map; where Gnomon's own rays from nearby places find the cause";
  return "light size, and one step unexplained: the capture has no map";
}

/// "; 0.04 world units, 1.2 texels" of what is advised; what the setting's unit says already is left out.
std::string length_text(const AdvisedSetting& one) {
  if (!(one.unit_world > 0.0)) return {};
  const double world = one.instead * one.unit_world;
  if (const std::string two = two_lengths(one.units, one.instead); !two.empty()) return "; " + two;
  std::string text =
      one.unit == "world units" ? "" : "; " + with_noun(fmt::format("{:.3g}", world), "world unit");
  if (one.texel_world > 0.0) text += (text.empty() ? "; " : ", ") + texels_text(world / one.texel_world, 3);
  return text;
}

/// "; mean error 1.2 %, as captured 3.4 %" where that is another figure than the share of wrong pixels.
std::string mean_text(const Advice& a) {
  if (!a.mean_now || !a.mean_instead) return {};
  if (*a.mean_now == a.wrong_now && *a.mean_instead == a.wrong_instead) return {};
  return fmt::format("; mean error {}{}, as captured {}", a.about ? "about " : "", percent(*a.mean_instead),
                     percent(*a.mean_now));
}

}  // namespace

std::string advice_text(const Advice& a) {
  const auto stays = [](const auto& one) { return one.instead == one.now; };
  const auto text = [&](const AdvisedSetting& one) {
    const std::string unit = one.unit + length_text(one);
    return stays(one)
               ? fmt::format("{} stays {:.4g} ({})", one.setting, one.now, unit)
               : fmt::format("{} {:.4g} instead of {:.4g} ({})", one.setting, one.instead, one.now, unit);
  };
  std::string settings =
      (a.texels_of_each ? "a bias of " + texels_text(*a.texels_of_each, 4) + " on each layer: " : "") +
      text(a);
  if (a.with) settings += " and " + text(*a.with);
  for (const AdvisedSetting& layer : a.layers) settings += " and " + text(layer);
  return fmt::format("{}: {}{:.3g} % of the pixels wrong, as captured {:.3g} %{}", settings,
                     a.about ? "about " : "", 100.0 * a.wrong_instead, 100.0 * a.wrong_now, mean_text(a));
}

std::string in_engine_text(const Judged& judged, const Advice& advice) {
  std::string text;
  for (const auto& [setting, value] : advice.in_engine)
    text += fmt::format("{}{} {:.4g}", text.empty() ? judged.engine + ": " : ", ", setting, value);
  return text;
}

std::string renderer_text(const Judged& j) {
  return j.renderer + (j.version.empty() ? "" : " " + j.version);
}

std::vector<std::pair<std::string, std::string>> judged_lines(const Comparison& c) {
  const Judged& j = *c.judged;
  std::vector<std::pair<std::string, std::string>> out{{"drawn by", renderer_text(j)}};
  if (!j.settings.empty()) out.emplace_back("settings", settings_text(j));
  out.emplace_back("agreement", agreement_text(j));
  for (const Mended& m : j.mended)
    out.emplace_back("mended", fmt::format("{}: {} of the {} agreed, now {}", m.what, percent(m.before),
                                           m.evidence, percent(m.after)));
  out.emplace_back("ladder", ladder_text(c));
  if (j.identified) out.emplace_back("nearest", identified_text(*j.identified));
  for (const Advice& advice : j.advice) {
    out.emplace_back("advice", advice_text(advice));
    if (std::string text = in_engine_text(j, advice); !text.empty()) out.emplace_back("in engine", text);
  }
  if (j.advice_sought && j.advice.empty())
    out.emplace_back("advice", "none: no other bias that was tried leaves clearly less of the error");
  for (const std::string& note : j.notes) out.emplace_back("note", note);
  return out;
}

}  // namespace gnomon::compare
