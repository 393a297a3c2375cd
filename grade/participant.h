// Whose a file or a folder is, as learning platforms name what one downloads from them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace gnomon::grade {

enum class Platform : std::uint8_t { none, moodle, canvas, blackboard, brightspace };

/// A student as a platform knows one.
struct Participant {
  Platform platform = Platform::none;
  std::string name;  ///< "Ada Lovelace"; Canvas' is "lovelaceada"
  std::string id;  ///< what the platform's table of grades goes by: "12345"; Blackboard's is the user's name
  /// What a file or a folder is called that the platform takes back for this student: its own name, unchanged.
  std::string returned_as;
  std::string file;  ///< what the student called the file, "reflection.glsl"; empty: it is a folder's name
};

/// The student whom a name belongs to; none where no platform names files and folders so:
/// - Moodle: "Ada Lovelace_12345_assignsubmission_file", with a file's name behind it where there are no folders
/// - Canvas: "lovelaceada_12345_67890_reflection.glsl", with "LATE_" before the numbers where it came late
/// - Blackboard: "Homework 3_alovelace_attempt_2026-11-30-09-16-02_reflection.glsl"
/// - Brightspace: "12345-67890 - Ada Lovelace - Nov 30, 2026 916 AM - reflection.glsl", or a folder without the last part
std::optional<Participant> participant_in(const std::string& name, bool is_folder);

}  // namespace gnomon::grade
