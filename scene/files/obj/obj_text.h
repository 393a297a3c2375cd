// The text of an OBJ file, read strictly: every number and index is checked where it stands, so that a mistake has a
// line and a column. Material libraries are the caller's.
#pragma once

#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "scene/base/expected.h"
#include "scene/files/polygon.h"

namespace gnomon {

/// Indices into ObjText, from 0; -1: the corner has none.
struct ObjCorner {
  int position = -1, texcoord = -1, normal = -1;
};

struct ObjFace {
  std::size_t first = 0;    ///< its first corner, of ObjText::corners
  std::size_t corners = 0;  ///< 3 to max_polygon_corners
  int material = -1;        ///< as MaterialLibraries::find says; -1: none
};

/// What follows one `o` or `g`, with at least one face.
struct ObjShape {
  std::string name;
  std::size_t first_face = 0, faces = 0;
};

struct ObjText {
  std::vector<Vec3> positions;
  std::vector<Vec3f>
      colors;  ///< behind the positions, as they stand: white without; empty where no vertex has one
  std::vector<glm::dvec2> texcoords;
  std::vector<Vec3f> normals;
  std::vector<ObjCorner> corners;
  std::vector<ObjFace> faces;
  std::vector<ObjShape> shapes;
  std::set<std::string> warnings;  ///< once each
  // What is skipped
  std::size_t small_faces = 0;  ///< faces with fewer than three corners
  int first_small_face_line = 0;
  std::size_t points = 0, lines = 0;
};

struct MaterialLibraries {
  /// Reads a library: nothing, or why it cannot be used. Errors end the reading of the text.
  std::function<Expected<std::string>(const std::string& name)> read;
  /// The number of a material that was read; -1: there is none of that name.
  std::function<int(const std::string& name)> find;
};

/// The text of an OBJ or MTL file: where a backslash ends a line, it and the break become spaces, so that the line goes
/// on and offsets stay.
std::string join_continued_lines(std::string_view bytes);

/// Errors: a byte of 0, a coordinate that is not a finite number, an index that is 0 or out of range, a face
/// of too many corners. Those of the libraries are errors, too.
Expected<ObjText> parse_obj(std::string_view bytes, const std::string& file,
                            const MaterialLibraries& libraries);

}  // namespace gnomon
