// The cells of a sweep, one after the other into its journal, while the pictures of those before are written.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include "app/console.h"
#include "app/session.h"
#include "scene/base/expected.h"
#include "studies/commands/sweep_command.h"
#include "studies/sweep/engine.h"
#include "studies/sweep/journal.h"

namespace gnomon::app {

// The pictures of a sweep's cells, written as the cells are made (studies/sweep/cell_files.h).

class CellPictureWriter {
 public:
  /// Both outlive the writer.
  CellPictureWriter(const std::string& folder, const studies::Engine& engine)
      : folder_(folder), engine_(engine) {}

  Expected<void> make_folders() const;
  /// Encodes and writes pictures: all of them are there then, or an error. May run on any thread, while the
  /// engine and other cells' jobs go on; waits for the job of the first cell with the same truth, which must
  /// run, too.
  using Job = std::function<Expected<void>()>;
  /// The pictures of the engine's last comparison.
  Job pictures(std::size_t cell, const compare::Comparison& comparison);

 private:
  struct TruthName;
  struct Pictures;
  static Expected<void> write(const Pictures& p);

  const std::string& folder_;
  const studies::Engine& engine_;
  std::uint64_t truths_ = 0;          ///< made when the last one was written
  std::shared_ptr<TruthName> truth_;  ///< of that one
};

/// Chooses the cells that have pictures: of a few cells all, else those that were drawn and some of those worked out
/// from a drawing. Those are the ones whose labels differ from the last pictured cell's by half of what is wrong there.
class PicturedCells {
 public:
  explicit PicturedCells(std::size_t cells) : cells_(cells) {}
  /// Cells are asked for in order.
  bool take(std::size_t cell, const compare::Comparison& comparison, bool derived);

 private:
  static constexpr std::size_t few = 48;
  std::size_t cells_;
  std::vector<std::uint64_t> last_;  ///< pixels by light and label of the last pictured cell
};

/// What stays the same for all cells.
struct SweepRun {
  const SweepCommand& command;
  const Plan& plan;
  const LoadedScene& loaded;
  LightSelection& selection;
  Scene given;  ///< camera and lights as loaded, less those that the last cell left out
  compare::MachineInfo machine;
  studies::Engine& engine;
  CellPictureWriter pictures;
  PicturedCells pictured;
  Console& console;
};

/// The engine judges from the views that were asked for; `given`: camera and lights of the scene.
Expected<void> look_from_views(const SweepCommand& command, const LoadedScene& loaded, const Scene& given,
                               studies::Engine& engine, Console& console);

/// All cells that the journal does not have yet, drawn once.
Expected<void> make_cells(SweepRun& run, studies::Journal& journal);
/// Draws all cells as often again as passes are run, in rounds, as far as the journal does not have them yet.
Expected<void> time_rounds(SweepRun& run, studies::Journal& journal);
/// Whether the journal has all cells and all rounds of their times.
bool has_all_rounds(const SweepCommand& command, const studies::Journal& journal, std::size_t cells);

}  // namespace gnomon::app
