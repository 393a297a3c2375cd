// The tables of labels, steps and rungs: what each is called in files and in words, its colour, and what is said of it.
// A new label is a value of Label and a row of labels.cpp; result.json and its schema, the channels, the pictures, the pages,
// the lab and grade read the rows.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string_view>

#include "compare/comparison.h"

namespace gnomon::compare {

struct LabelText {
  std::string_view key;       ///< "peter_panning", as in result.json
  std::string_view name;      ///< "peter-panning"
  std::string_view letter;    ///< one letter beside the colour, so that colour never stands alone
  glm::u8vec3 colour;         ///< the same in every image, page and window
  std::optional<Cause> step;  ///< the step that it stands for; none: the deciding one (docs/labels.md)
  std::string_view lesson;    ///< which explains it
  std::string_view what;      ///< half a line: what it is
  std::string_view cause;     ///< one or two sentences; empty for labels that are not errors
  std::string_view cure;
  std::string_view
      rule{};  ///< which pixels have it, in result_schema(); empty for labels that are not errors
};
const LabelText& label_text(Label label);

struct StepText {
  std::string_view key;   ///< "light_size", as in result.json
  std::string_view name;  ///< "light size"
  std::string_view what;  ///< what the step changes
  Label label;            ///< the one whose colour stands for the step
};
const StepText& step_text(Cause cause, Ladder ladder = Ladder::map);

struct RungText {
  std::string_view symbol;  ///< "V3"
  std::string_view name;    ///< "flat", in files, too
  std::string_view what;    ///< what this visibility is
};
const RungText& rung_text(Rung rung, Ladder ladder = Ladder::map);

}  // namespace gnomon::compare
