// A strict look at an OBJ file before the lenient parser reads it: every number and index is checked where it
// stands, so that a mistake has a line and a column.
#pragma once

#include <string>
#include <string_view>

#include "scene/expected.h"

namespace gnomon {

struct ObjSurvey {
  std::size_t small_faces = 0;  ///< faces with fewer than three corners
  int first_small_face_line = 0;
  std::size_t points = 0, lines = 0;
  bool has_vertex_colors = false;
};

inline constexpr std::size_t max_polygon_corners = 255;  ///< tinyobjloader counts them in a byte

/// Joins lines that a backslash continues, and removes comments behind data, both by spaces in place: offsets
/// stay.
void blank_continuations_and_comments(std::string& text);

/// Errors: a byte of 0, a coordinate that is not a finite number, an index that is 0 or out of range, a face
/// of too many corners.
Expected<ObjSurvey> check_obj(std::string_view text, const std::string& file);

}  // namespace gnomon
