// Where the program itself lies, and what comes along with it.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace gnomon {

/// The file of the program that runs; empty where the system does not say.
std::filesystem::path own_program();

/// The project's program of that name: beside the one that runs, else where it was built.
std::string program_beside(std::string_view name);

}  // namespace gnomon
