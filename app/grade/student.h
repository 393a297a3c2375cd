// What was handed in: one folder for each student.
#pragma once

#include <string>
#include <vector>

#include "app/grade/rubric.h"
#include "scene/expected.h"

namespace gnomon::app::grade {

struct Student {
  std::string name;    ///< the folder's own: any bytes
  std::string folder;  ///< as given
};

/// Each path is a student's folder, or a folder of such folders (those in it, by name, links among them, which refusal()
/// names). A folder with a shader in it, or with no folder in it, is a student's own, and so is one that cannot be read.
/// Errors (usage): no such folder; two students of one name.
Expected<std::vector<Student>> find_students(const std::vector<std::string>& paths);

/// Why nothing of the folder is drawn with; empty where all is well: the folder or something in it is a link (which could
/// name what is somebody else's), a shader is a folder, a pipe or a device, more than 4 MiB of shaders, a shader that is
/// not to be handed in, or none that differs from the program's own.
/// Error (bad input): what lies there cannot be read, so that nobody can tell what was handed in.
Expected<std::string> refusal(const Student& student, const Rubric& rubric);

}  // namespace gnomon::app::grade
