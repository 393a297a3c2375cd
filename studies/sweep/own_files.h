// Which files of a folder are a sweep's own. A sweep cuts, replaces and removes files by their names, so it first looks
// whether they are what it writes. Each must be a plain file of the folder itself, no link, that begins as the sweep's do.
// What is not is left as it is. Every error here is ErrorKind::cannot_write.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "scene/base/expected.h"

namespace gnomon::studies {

/// Files that a sweep's folder has. They are removed in this order: whoever finds the last one knows that a sweep lies there.
inline constexpr std::array<std::string_view, 6> sweep_file_names{
    "report.html", "ray_tracer.json", "sweep.csv", "sweep_times.jsonl", "sweep.jsonl", "sweep.json"};
/// Its folders of pictures.
inline constexpr std::array<std::string_view, 2> sweep_folder_names{"thumbnails", "cells"};

/// Whether the text begins as a sweep's file of that name (one of sweep_file_names, all but sweep.json); a text cut short
/// anywhere does, too. Lines that follow the first one of the two .jsonl files begin as the first one does.
bool begins_as_own(std::string_view name, std::string_view text);

/// A file of a sweep that is open, for as long as this lives. It is the folder's own plain file.
class OwnFile {
 public:
  /// Opens it for reading and writing, and makes it where it is not there if `make`; else is_open() is false then. A file that has
  /// other names (hard links) is copied first, so that they keep what they hold.
  static Expected<OwnFile> open(const std::string& folder, std::string_view name, bool make);
  OwnFile(OwnFile&& other) noexcept
      : path_(std::move(other.path_)),
        name_(other.name_),
        descriptor_(std::exchange(other.descriptor_, -1)) {}
  OwnFile& operator=(OwnFile&&) = delete;
  ~OwnFile();

  bool is_open() const { return descriptor_ >= 0; }
  int descriptor() const { return descriptor_; }
  const std::string& path() const { return path_; }
  /// Reads all of it; what is not there is empty. Error also where it does not begin as a sweep's.
  Expected<std::string> text() const;

 private:
  OwnFile() = default;
  std::string path_;
  std::string_view name_;
  int descriptor_ = -1;
};

/// Looks whether all that a sweep would write over, cut or remove in the folder is a sweep's. No link may lie in the place of one
/// of its files, folders or pictures, and the files that it cuts must begin as its own do. `has_sweep`: there is a sweep.json of
/// one. Where there is none nor a line with its checksum, as a kill between two renames can leave it, those files are empty and
/// no pictures are there.
Expected<void> check_own_files(const std::string& folder, bool has_sweep);

/// The number of cells of the sweep that lies in the folder; none where none does. What it was asked for may have been changed
/// by hand, for it is not read on.
Expected<std::optional<std::size_t>> cells_of_sweep(const std::string& folder);

/// Reads all of an open plain file; `path` is its name for messages.
Expected<std::string> text_of_open(int descriptor, const std::string& path, ErrorKind error);

/// Refuses the path: "it is left as it is, and a sweep needs another folder".
tl::unexpected<Error> not_a_sweeps(const std::string& path, std::string_view what);

}  // namespace gnomon::studies
