// Whether somebody looks on while the program writes.
#pragma once

namespace gnomon {

/// Whether what is written to the descriptor shows at once, on a terminal.
bool is_terminal(int descriptor);

}  // namespace gnomon
