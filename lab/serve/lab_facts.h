// What the lab's page knows beforehand and what it reads of one moment, as JSON text. It is the engine's side of what the
// page and its engine say to each other (docs/lab.md, "The page and its engine").
#pragma once

#include <string>

#include "lab/serve/lab_engine.h"

namespace gnomon::lab {

/// Settings by group with their ranges and notes, techniques and what they read, labels, pictures, presets, scenes.
/// `worker`: the page has its engine itself.
std::string lab_facts(const LabOptions& options, bool worker);

/// What there is at that moment: the words of its state, what is drawn and compared of it, numbers, verdict, and what went
/// wrong. `compare_words`: LabEngine::compare_words().
std::string lab_reading(const LabMoment& moment, const std::vector<std::string>& compare_words);

/// One pixel explained (pixel_story.h); "null" where nothing is compared yet. `place`: in the picture's full size.
std::string lab_pixel(const LabMoment& moment, PixelPlace place);

}  // namespace gnomon::lab
