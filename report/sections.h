// The parts of the page, top to bottom. Each returns a whole block of HTML.
#pragma once

#include <string>

#include "report/page.h"

namespace gnomon::compare {

/// The pictures side by side, the verdicts and the budgets: what a projector shows first.
std::string overview_section(const PageInput& input);
/// The light whose labelled picture stands on the first screen: that with the most wrong pixels.
std::size_t labelled_light(const Comparison& comparison);
/// Its wrong pixels in the colours of their labels.
std::string label_figure(const PageInput& input, std::size_t index);
/// Everything about one light; `index` in Comparison::lights.
std::string light_section(const PageInput& input, std::size_t index);
/// Times and what does not depend on the machine.
std::string cost_section(const PageInput& input);
/// What shadows cost apart from what the picture costs, on both sides.
std::string shadow_cost_table(const PageInput& input);
/// Every stage of the run with its time, and their sum.
std::string time_budget_block(const TimeBudget& budget);
/// What was simulated and what was not, and what the loader had to say.
std::string effects_section(const PageInput& input);
/// Where the numbers come from, and the files.
std::string provenance_section(const PageInput& input);

/// The name that the page gives a light: as in the file, "light 2" where it has none, both where two share
/// one. Not escaped.
std::string shown_light_name(const Comparison& comparison, std::size_t index);
/// "lights.0.error.wrong": a key in result.json.
std::string light_key(std::size_t index, std::string_view rest);

/// <img> with its size, so that the page does not jump; its file where the page's pictures are beside it.
/// `id` may be empty.
std::string picture(const PageInput& input, const EncodedPicture& encoded, std::string_view alt,
                    std::string_view id);
/// The viewer, hidden until the script brings it to life. `options`: <option>s of its menus; `id` sets its
/// hint apart; `hint` is HTML; `exposure`: with a slider for it.
std::string viewer_block(const std::string& options, std::string_view id, std::string_view hint,
                         bool exposure);
/// A block that scrolls sideways where the page is narrow, by keyboard too; `label` must be unique on the
/// page.
std::string scroll_region(std::string_view label, std::string_view content);
/// The budget as a waterfall that adds up: one row per step that changes anything, and the sum.
std::string budget_table(const Comparison& comparison, std::size_t index);

}  // namespace gnomon::compare
