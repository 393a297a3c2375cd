// Where the program itself lies, and what comes along with it.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace gnomon {

/// The file of the program that runs; empty where the system does not say.
std::filesystem::path own_program();

/// The project's program of that name: beside the one that runs. One of the build's own, such as a test, finds it where it was
/// built; what is installed never starts what lies there.
std::string program_beside(std::string_view name);

}  // namespace gnomon
