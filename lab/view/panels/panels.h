// The panels: each draws what it shows of the state with Dear ImGui and says what was asked for as actions. They
// change nothing themselves.
#pragma once

#include <cstdint>
#include <glm/gtc/type_precision.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "lab/view/state/input.h"
#include "lab/view/state/state.h"
#include "lab/view/window/layout.h"
#include "lab/view/window/style.h"
#include "lab/view/work/job.h"
#include "lab/view/work/render_thread.h"

namespace gnomon::lab {

struct PanelContext {
  const ViewState& state;
  const Snapshot& shown;
  const LabLayout& layout;
  TypeSize type;
  Ink ink{};
  const JobStatus& job;
  std::string note;  ///< the last thing done, for the status bar
  std::vector<Action>& actions;
  bool opens_menu = false;  ///< by the key for it

  void ask(Action action) { actions.push_back(std::move(action)); }
  /// The comparison to read numbers from; null: none yet.
  const ComparisonOutcome* outcome() const { return shown.outcome.get(); }
  /// It is of what is set now.
  bool is_current() const { return shown.outcome && shown.outcome->revision == state.revision; }
};

void menu_bar(PanelContext& context);
/// The left column; both parts of it, as tabs, where there is no room for two columns.
void left_column(PanelContext& context);
void right_column(PanelContext& context);
void status_bar(PanelContext& context);
void help_window(PanelContext& context);
/// Over the pictures and below the panels: their names, the line of a swipe, the probed pixel, the light's handle
/// and, over the view of texels, what the map covers.
void overlay(PanelContext& context);

// Parts of the columns.
void settings_panel(PanelContext& context);
void results_panel(PanelContext& context);
void probe_panel(PanelContext& context);
void curve_panel(PanelContext& context);

/// The text in lines that are no wider than this on the screen.
std::string broken_to_width(std::string_view text, double width);
/// Text that wraps at the panel's edge, or at a width of its own.
void wrapped(std::string_view text, float width = 0.0f);
void faint(const std::string& text);
/// A colour of the palette as Dear ImGui takes it.
std::uint32_t colour(const glm::u8vec3& c);

}  // namespace gnomon::lab
