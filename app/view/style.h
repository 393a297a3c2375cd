// Colours and sizes of the window's panels: dark or light, at any scale.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "app/view/layout.h"
#include "app/view/look.h"

struct ImVec4;

namespace gnomon::app {

/// Gives Dear ImGui's current context its colours and sizes.
void apply_style(Theme theme, const TypeSize& type);
/// Loads the text's font in this size: DejaVu Sans, or Dear ImGui's own where that is not installed.
void load_font(const TypeSize& type);

/// Colours that the panels' own drawings use, as 0xAABBGGRR.
struct Ink {
  unsigned text, faint, grid, paper, accent, warning, good;
};
Ink ink_of(Theme theme);

// Lines of a paragraph. Dear ImGui's own wrapping breaks behind commas and points as well, in the midst of a number.

/// The text with line breaks in place of blanks, so that each line is no wider than `width` by `measure`, which must add
/// up over the parts of a line; a word that is wider has a line of its own. Breaks of the text's own stay.
std::string broken_at_blanks(std::string_view text, double width,
                             const std::function<double(std::string_view)>& measure);

}  // namespace gnomon::app
