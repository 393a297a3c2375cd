// What the page says about labels, steps and rungs: one plain sentence for each, and cause and cure where
// there is one.
#pragma once

#include <string_view>

#include "compare/comparison.h"

namespace gnomon::compare {

struct LabelText {
  std::string_view name;    ///< "peter-panning"
  std::string_view letter;  ///< one letter beside the colour, so that colour never stands alone
  std::string_view what;    ///< half a line: what it is
  std::string_view cause;   ///< one or two sentences; empty for labels that are not errors
  std::string_view cure;
};
const LabelText& label_text(Label label);

struct StepText {
  std::string_view name;  ///< "slope"
  std::string_view what;  ///< what the step changes
};
const StepText& step_text(Cause cause);

struct RungText {
  std::string_view symbol;  ///< "V3"
  std::string_view name;    ///< "flat"
  std::string_view what;    ///< what this visibility is
};
const RungText& rung_text(Rung rung);

}  // namespace gnomon::compare
