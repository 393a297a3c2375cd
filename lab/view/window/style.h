// Colours and sizes of the window's panels: dark or light, at any scale.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "lab/view/state/look.h"
#include "lab/view/window/layout.h"
#include "scene/base/expected.h"

struct ImVec4;

namespace gnomon::lab {

/// Gives Dear ImGui's current context its colours and sizes.
void apply_style(Theme theme, const TypeSize& type);
/// The bytes of the text's font, DejaVu Sans; empty where it is not installed.
Expected<std::string> read_font();
/// Makes it the font in this size, or Dear ImGui's own where `bytes` is empty. The bytes have to outlive the context.
void load_font(const TypeSize& type, std::string& bytes);

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

}  // namespace gnomon::lab
