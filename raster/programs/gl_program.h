// GLSL programs linked from the embedded sources of shaders/ (or from the files of the same names in the
// context's shader folder, Gl::shader_folder()), with #include lines resolved (each file once;
// $NAME in a file's name stands for the value of that define) and a permutation's names defined. Private to
// raster.
#pragma once

#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "raster/gl/gl_objects.h"

namespace gnomon::raster {

struct Expansion;

class Program : public GlObject<GlKind::program> {
 public:
  Program() = default;
  /// `fragment` may be empty: depth only. Error: the compiler's log: ErrorKind::internal where the shaders
  /// are the program's own, ErrorKind::bad_input with file and line where one of the shader folder is at
  /// fault.
  static Expected<Program> link(const Gl& gl, std::string_view vertex, std::string_view fragment,
                                std::span<const std::string_view> defines);
  /// A compute program from source text that may include files of shaders/ (tests use it).
  static Expected<Program> link_compute(const Gl& gl, std::string_view source);
  /// The shader folder's files among its sources count as used from here on (ShaderFolder::used).
  void use() const;
  /// Whether it was made of one of these files.
  bool reads(const std::set<std::string>& names) const;

 protected:
  using GlObject::GlObject;

 private:
  void note_sources(const Expansion& text);
  std::vector<std::string> sources_;
  std::vector<std::string> replaced_;  ///< sources from the shader folder
};

/// The text of a stage as the compiler gets it.
std::string expand_shader(std::string_view file, std::span<const std::string_view> defines);

}  // namespace gnomon::raster
