// The report page: one HTML file that needs nothing but itself, or, where it would grow too large, the files
// beside it. It holds the result document (result.json), what the program knows beside it (report_facts), the pictures, and
// the pixels' numbers (page_data.h); its sections are made of these by page/src/report_sections.ts. Every number on the
// page carries its key in result.json (<data data-key="lights.0.error.wrong">), which the browser test compares.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "compare/comparison.h"
#include "compare/result/picture_set.h"
#include "report/shell.h"

namespace gnomon::report {

/// What stands before a comparison on a page that is about more than that: the page of the tuner.
struct PageIntroduction {
  std::string title;  ///< of the document, not escaped
  std::string facts;  ///< what it says, JSON text (page/src/tune_sections.ts)
};

struct PageData;  // page_data.h

struct PageInput {
  const compare::Comparison& comparison;
  const compare::PictureSet& pictures;
  std::string_view json;  ///< result.json's text so far, embedded in the page and offered for saving
  std::string_view csv;
  const PageIntroduction* introduction = nullptr;
  bool beside = false;  ///< pictures and pixels are files beside the page; set by report_page
};

/// The whole page, which takes what is in `data`; of more than `max_mb` megabytes its data, and the set's
/// pictures by their file names, are beside it.
BuiltPage report_page(PageInput input, PageData& data, double max_mb);

// What the page of a comparison knows beside its document. These are words and colours from the tables of labels, rungs,
// lessons and settings, and the sentences that the terminal says as well. It also knows what only the writing of the page
// tells.

/// Labels by their values, from uncertain on (page/src/report_document.ts: LabelFacts).
nlohmann::ordered_json label_facts();
/// V0 … V6, each with the step that leads to it.
nlohmann::ordered_json rung_facts(compare::Ladder ladder);
/// What has moved since the last frame, and what each side then makes for the shadows: key, words, made.
nlohmann::ordered_json situation_facts(bool has_map);
/// Everything that the sections of the page ask for (page/src/report_document.ts: Facts).
nlohmann::ordered_json report_facts(const PageInput& input);
/// What the page leaves out of a picture with more pixels than it has room for; empty where it has them all.
std::string reduced_words(const compare::Comparison& comparison);
/// The name that the page gives a light: as in the file, "light 2" where it has none, both where two share one.
std::string shown_light_name(const compare::Comparison& comparison, std::size_t index);

}  // namespace gnomon::report
