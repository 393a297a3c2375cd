// A thread that gives up what it may do. What it starts then has given it up, too; nothing gives it back.
#pragma once

#include <string>
#include <vector>

namespace gnomon {

/// Gives up, for the calling thread and the programs that it starts:
/// - all files and folders but what is in memory, what programs and their libraries are (/usr and the like), and `readable`,
///   which can be read and run alone
/// - the network
/// - other processes
/// - rights that a program would bring
/// Returns whether files are out of reach: a kernel without Landlock (before 5.13, or one that leaves it out) knows no such
/// thing.
bool give_up_rights(const std::vector<std::string>& readable);

}  // namespace gnomon
