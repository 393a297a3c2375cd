// The files of the students' pages.
#pragma once

#include <string>
#include <vector>

namespace gnomon::app::grade {

/// For each student's name, which may hold any bytes, a file's name of at most 96 bytes, "anna.html": ASCII letters,
/// digits, '-', '.' and '_' alone, not hidden. No two of them, nor one and "index.html", differ in nothing but case: they
/// stay apart where a folder of pages is copied to.
std::vector<std::string> page_names(const std::vector<std::string>& students);

}  // namespace gnomon::app::grade
