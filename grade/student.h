// Who is in a class, and where what each one handed in lies.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grade/participant.h"
#include "scene/base/expected.h"

namespace gnomon::grade {

struct Student {
  std::string name;                   ///< the folder's own: any bytes
  std::string folder;                 ///< as given; what messages begin with
  std::optional<Error> unreadable{};  ///< why nobody can say what the folder holds
  Participant participant{};          ///< as a platform knows the student
  /// Where all of it lies: folders, archives and single files. Empty: `folder` alone.
  std::vector<std::string> places{};
};

/// Each path is a student's folder, or a folder of a class, or an archive of either. In a class' folder each folder and each archive is a
/// student's (links among them, which take_in() names), and so are files that a platform named (participant.h). What is one
/// participant's is one student's. A folder with a shader in it, or with nothing of the kind, is a student's own, and so is
/// one that cannot be read. Archives that hold a class are unpacked below `unpacked`.
/// Errors: no such folder, two students of one name (usage); none of the folders can be read (bad_input).
Expected<std::vector<Student>> find_students(const std::vector<std::string>& paths,
                                             const std::string& unpacked);

/// What systems leave in folders and nobody handed in: "__MACOSX", "._a.glsl", ".DS_Store", "Thumbs.db", and all that is hidden.
bool is_left_by_system(const std::string& name);

}  // namespace gnomon::grade
