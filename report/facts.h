// What the page of a comparison knows beside its document: words and colours from the tables of labels, rungs, lessons and
// settings, the sentences that the terminal says as well, and what only the writing of the page tells.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "report/page.h"

namespace gnomon::compare {

/// Labels by their values, from uncertain on (page/src/report_document.ts: LabelFacts).
nlohmann::ordered_json label_facts();
/// V0 … V6, each with the step that leads to it.
nlohmann::ordered_json rung_facts();
/// Everything that the sections of the page ask for (page/src/report_document.ts: Facts).
nlohmann::ordered_json report_facts(const PageInput& input);
/// What the page leaves out of a picture with more pixels than it has room for; empty where it has them all.
std::string reduced_words(const Comparison& comparison);
/// The name that the page gives a light: as in the file, "light 2" where it has none, both where two share one.
std::string shown_light_name(const Comparison& comparison, std::size_t index);

}  // namespace gnomon::compare
