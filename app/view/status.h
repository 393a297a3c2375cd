// The viewer in words: the window's title, and the command line that makes the same comparison without a
// window.
#pragma once

#include <string>
#include <vector>

#include "app/view/state.h"
#include "app/view/studio.h"
#include "app/view/view.h"

namespace gnomon::app {

/// Scene, view, technique, map size, bias in texels and world units, share of wrong pixels, times.
std::string status_line(const ViewState& state, const Readings& readings, const std::string& scene);

/// "gnomon compare SCENE --size ... ": what differs from the defaults and, always, size, map size and bias.
std::string compare_command(const ViewState& state, const ViewOptions& options);

/// Lights that were turned but are not the chosen one: the command line has no words for them.
std::vector<std::string> other_turned_lights(const ViewState& state);

}  // namespace gnomon::app
