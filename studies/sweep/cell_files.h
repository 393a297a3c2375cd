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
#include <vector>

#include "scene/base/expected.h"
#include "scene/image.h"
#include "studies/sweep/own_files.h"

namespace gnomon::studies {

inline constexpr int thumbnail_width = 256;  ///< pixels
inline constexpr int drawing_width = 640;    ///< pixels
/// Cells of a sweep that have pictures: all of them up to this number, else that many, evenly spread.
inline constexpr std::size_t max_thumbnails = 144;
bool has_thumbnail(std::size_t cell, std::size_t cells);

inline constexpr std::string_view thumbnails_name = sweep_folder_names[0], cells_name = sweep_folder_names[1];
/// "thumbnails/cell-000012.png", in the sweep's folder.
std::string thumbnail_name(std::size_t cell);
std::string thumbnail_path(const std::string& folder, std::size_t cell);
std::string cells_folder(const std::string& folder);
std::string cell_name(std::size_t cell);  ///< "cell-000012"

/// "truth-1a2b3c4d5e6f": the name of a ray-traced picture.
std::string truth_name(std::string_view png);

/// The names of the ray-traced pictures in the folder of a sweep's cells.
Expected<std::vector<std::string>> truths_in(const std::string& folder);

/// Whether a sweep writes pictures of that name into its two folders of pictures.
bool is_cell_picture(std::string_view name);
/// The paths of all files of such names there.
Expected<std::vector<std::string>> cell_pictures_in(const std::string& folder);

/// Removes what an interrupted sweep left. That is what a process that is no more had begun of the sweep's own files,
/// and the pictures of the cells that are still to be made (`unfinished`, sorted). All other files stay, whatever
/// their names end in. The folder must be this process's (journal.h).
Expected<void> remove_strays(const std::string& folder, std::span<const std::size_t> unfinished);
/// Removes the sweep that lies in the folder: its files (own_files.h), the pictures of as many cells as it has, and the ray-traced
/// pictures, which are named after their contents. All other files stay. ErrorKind::usage while another process is at work
/// there; cannot_write where a file is no sweep's, and nothing is removed then.
Expected<void> discard_sweep(const std::string& folder);

/// Whether a file's text is what cell_data_file() may have written for that cell, to the last byte.
bool is_cell_data(std::size_t cell, std::string_view file);
/// ErrorKind::bad_input: somebody has changed the file at `path`.
Error not_cell_data(const std::string& path);
/// The text of a cell's data file.
std::string cell_data_file(std::size_t cell, const Image<std::uint8_t>& codes, const std::string& truth);

}  // namespace gnomon::studies
