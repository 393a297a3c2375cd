// The pictures of a sweep's cells, kept in DIR/cells for the page:
//   cell-000012.js    the labels of every pixel (class codes, engine.h) and which truth they are compared
//   with, as a
//                     data file of the page (report/shell.h)
//   cell-000012.png   the rasterized picture, at most drawing_width pixels wide; of cells that were drawn
//   truth-1a2b….png   the ray-traced picture, one for all cells that share it, named after its contents
// and the thumbnails in DIR/thumbnails.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "scene/expected.h"
#include "scene/image.h"

namespace gnomon::compare {

inline constexpr int thumbnail_width = 256;  ///< pixels
inline constexpr int drawing_width = 640;    ///< pixels
/// Cells of a sweep that have pictures: all of them up to this number, else that many, evenly spread.
inline constexpr std::size_t max_thumbnails = 144;
bool has_thumbnail(std::size_t cell, std::size_t cells);

std::string thumbnail_path(const std::string& folder, std::size_t cell);
std::string cells_folder(const std::string& folder);
std::string cell_name(std::size_t cell);  ///< "cell-000012"

/// "truth-1a2b3c4d5e6f": the name of a ray-traced picture.
std::string truth_name(std::string_view png);

/// Removes what an interrupted sweep left: files that were not finished, and the pictures of cells that are
/// not among `finished` (sorted). Files of other names stay. The folder must be this process's (journal.h).
void remove_strays(const std::string& folder, std::span<const std::size_t> finished);
/// Removes all that a sweep writes into the folder. Files of other names stay.
Expected<void> discard_sweep(const std::string& folder);

/// The text of a cell's data file.
std::string cell_data_file(std::size_t cell, const Image<std::uint8_t>& codes, const std::string& truth);

}  // namespace gnomon::compare
