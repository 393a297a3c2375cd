// The schema of result.json. What tables of the program know is made from their rows; result.schema.in.json has the rest.
#pragma once

#include <nlohmann/json.hpp>

namespace gnomon::compare {

/// Returns the JSON Schema (draft 2020-12) that every result.json and each line of a sweep.jsonl keeps. An object of
/// result.schema.in.json with one of these keys gets more properties:
/// - "figures": "edges": a number for each figure of that block (figures.h), all of them required, and no others
/// - "labels": true: what "each" says for each label of an error (labels.h), likewise; without "each" the count of its pixels
/// - "settings": "filter": those of map_settings() in that group which have a key (settings.h), where the object has none of
///   that name
/// "techniques": true puts their names first in the object's "enum".
/// Of an object with "properties" all are required but those that its "optional" names and blocks of figures that not every
/// light has, and there are no others.
nlohmann::ordered_json result_schema();

}  // namespace gnomon::compare
