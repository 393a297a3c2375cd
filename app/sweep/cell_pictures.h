// The pictures of a sweep's cells, written as the cells are made (compare/sweep/cell_files.h).
#pragma once

#include <cstddef>
#include <string>

#include "compare/sweep/engine.h"
#include "scene/expected.h"

namespace gnomon::app {

class CellPictureWriter {
 public:
  /// Both outlive the writer.
  CellPictureWriter(const std::string& folder, const compare::Engine& engine)
      : folder_(folder), engine_(engine) {}

  Expected<void> make_folders() const;
  /// Writes the pictures of the engine's last comparison; all of them are there, or an error.
  Expected<void> write(std::size_t cell, const compare::Comparison& comparison);

 private:
  Expected<void> write_truth(const compare::Comparison& comparison);

  const std::string& folder_;
  const compare::Engine& engine_;
  std::uint64_t truths_ = 0;  ///< made when the last one was written
  std::string truth_;         ///< its name
};

}  // namespace gnomon::app
