// Colours and sizes of the window's panels: dark or light, at any scale.
#pragma once

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

}  // namespace gnomon::app
