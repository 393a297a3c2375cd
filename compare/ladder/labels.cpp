// Names and colours of causes and labels. The colours are Okabe and Ito's colour-blind-safe set (Okabe & Ito
// 2008, "Color Universal Design") and, for the classes beyond its size, three of Paul Tol's "muted" scheme
// (2021). Right and uncounted pixels stay grey, so that colour always means "wrong".
#include <array>

#include "compare/result/outputs.h"

namespace gnomon::compare {

std::string_view cause_name(Cause cause) {
  constexpr std::array<std::string_view, cause_count> names{"light_size", "sampling", "slope",
                                                            "precision",  "bias",     "filter"};
  return names[static_cast<std::size_t>(cause)];
}

std::string_view label_name(Label label) {
  switch (label) {
    case Label::uncertain:
      return "uncertain";
    case Label::silhouette:
      return "silhouette";
    case Label::facing_away:
      return "facing_away";
    case Label::background:
      return "background";
    case Label::right:
      return "right";
    case Label::acne:
      return "acne";
    case Label::precision:
      return "precision";
    case Label::peter_panning:
      return "peter_panning";
    case Label::light_leak:
      return "light_leak";
    case Label::aliasing:
      return "aliasing";
    case Label::missed_feature:
      return "missed_feature";
    case Label::false_feature:
      return "false_feature";
    case Label::blur:
      return "blur";
    case Label::light_size:
      return "light_size";
    case Label::outside_map:
      return "outside_map";
    case Label::custom_shader:
      return "custom_shader";
    case Label::unexplained:
      return "unexplained";
  }
  return "unknown";
}

glm::u8vec3 label_colour(Label label) {
  switch (label) {
    case Label::uncertain:
      return {0xb5, 0xd3, 0xa8};
    case Label::silhouette:
      return {0x1c, 0x1e, 0x22};
    case Label::facing_away:
      return {0x8f, 0x93, 0x9b};
    case Label::background:
      return {0x3c, 0x42, 0x4c};
    case Label::right:
      return {0xf2, 0xf2, 0xef};
    case Label::acne:
      return {0xd5, 0x5e, 0x00};  // vermillion
    case Label::precision:
      return {0xf0, 0xe4, 0x42};  // yellow
    case Label::peter_panning:
      return {0x00, 0x72, 0xb2};  // blue
    case Label::light_leak:
      return {0x56, 0xb4, 0xe9};  // sky blue
    case Label::aliasing:
      return {0xcc, 0x79, 0xa7};  // reddish purple
    case Label::missed_feature:
      return {0x00, 0x9e, 0x73};  // bluish green
    case Label::false_feature:
      return {0xe6, 0x9f, 0x00};  // orange
    case Label::blur:
      return {0x99, 0x99, 0x33};  // olive (Tol)
    case Label::light_size:
      return {0x33, 0x22, 0x88};  // indigo (Tol)
    case Label::outside_map:
      return {0x88, 0x22, 0x55};  // wine (Tol)
    case Label::custom_shader:
      return {0x66, 0x33, 0x33};  // dark red (Tol, "dark")
    case Label::unexplained:
      return {0x00, 0x00, 0x00};
  }
  return {0, 0, 0};
}

}  // namespace gnomon::compare
