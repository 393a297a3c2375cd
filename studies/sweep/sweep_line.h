// What the files of a sweep's folder hold: its configuration (sweep.json), and one line for each cell. Each line ends with a
// checksum of itself, so that one which was edited is not taken for a result.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "scene/base/expected.h"

namespace gnomon::studies {

/// The path of a file in a folder.
std::string path_in(const std::string& folder, std::string_view name);
/// A file's bytes; that it cannot be read is an error of `kind`, which is cannot_write for a folder that is being written.
Expected<std::string> read_as(ErrorKind kind, const std::string& path);

struct Shard {
  int part = 1, of = 1;  ///< 1 <= part <= of
};

/// What identifies a sweep, as JSON text.
struct SweepHeader {
  std::string configuration;  ///< JSON object: everything that the lines depend on, the shard apart
  std::string hash;           ///< SHA-256 of the configuration
  std::size_t cells = 0;      ///< of the whole sweep
  Shard shard;
};
SweepHeader make_header(std::string configuration, std::size_t cells, Shard shard);
std::string header_json(const SweepHeader& header);
/// The number of cells that a sweep.json names, whatever else in it was changed; none of a text that is not one.
std::optional<std::size_t> cells_of_header(std::string_view text);
/// Reads DIR/sweep.json. A file that cannot be read is an error of the kind `unreadable`, one that is no sweep's
/// bad_input.
Expected<SweepHeader> read_header(const std::string& folder, ErrorKind unreadable = ErrorKind::bad_input);

/// The line with its checksum as the last key; one that has it already stays as it is.
std::string sealed(const std::string& line);
/// Its checksum is there and fits.
bool is_sealed(std::string_view line);

/// "osmesa, llvmpipe (...)": backend and renderer of a line.
std::string drawer_of_line(const nlohmann::ordered_json& line);

/// "axes" of a line, as JSON text; empty when the line is no object or has none.
std::string axes_of_line(const nlohmann::ordered_json& line);

}  // namespace gnomon::studies
