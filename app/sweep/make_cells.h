// The cells of a sweep, one after the other into its journal, while the pictures of those before are written.
#pragma once

#include "app/console.h"
#include "app/session.h"
#include "app/sweep/cell_pictures.h"
#include "app/sweep/command.h"
#include "studies/sweep/engine.h"
#include "studies/sweep/journal.h"

namespace gnomon::app {

/// What stays the same for all cells.
struct Workshop {
  const SweepCommand& command;
  const Plan& plan;
  const LoadedScene& loaded;
  LightKeeper& keeper;
  Scene given;  ///< camera and lights as loaded, less those that the last cell left out
  compare::MachineInfo machine;
  compare::Engine& engine;
  CellPictureWriter pictures;
  Console& console;
};

/// All cells that the journal does not have yet.
Expected<void> make_cells(Workshop& shop, compare::Journal& journal);

}  // namespace gnomon::app
