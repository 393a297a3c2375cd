// The times of a sweep's cells, which are drawn in rounds: all cells once, then all again. So what else the machine does for a
// while falls on none of them alone. sweep_times.jsonl holds the rounds one after the other.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "compare/result/shadow_cost.h"
#include "raster/frame.h"
#include "scene/base/expected.h"

namespace gnomon::studies {

/// What a further round adds to a cell's times: the runs of its passes. The lights are those compared, in their order.
nlohmann::ordered_json round_json(const std::vector<raster::LightRecord>& lights, std::size_t cell,
                                  const compare::MachineInfo& machine);

/// One line for each cell, all of its runs together. `times`: the lines of all rounds; their count is a multiple of `cells`
/// where the last one is whole, and of an unfinished round the cells that it has have a run more. Errors are
/// ErrorKind::bad_input.
Expected<std::vector<std::string>> joined_rounds(const std::vector<std::string>& times, std::size_t cells);

/// What the shadows of a light took, from its entry in a line of times and from the line itself.
compare::ShadowParts read_shadow_parts(const nlohmann::ordered_json& light,
                                       const nlohmann::ordered_json& line);

}  // namespace gnomon::studies
