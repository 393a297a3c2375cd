// Who may include and link whom (CONTRIBUTING.md, "The house"): the rooms' arrows, held by reading every
// source file and CMake file. OpenGL is private to raster (and to the viewer, which owns a window); no raster
// header that shows OpenGL is seen from outside, not even through another header.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/places.h"

namespace {

namespace fs = std::filesystem;

/// Path from the project's root -> text.
using Files = std::map<std::string, std::string>;

const std::map<std::string, std::set<std::string>, std::less<>> arrows = {
    {"scene", {}},
    {"shaders", {}},
    {"raster", {"scene", "shaders"}},
    {"raytrace", {"scene"}},
    {"hybrid", {"scene", "raster", "raytrace"}},
    {"rays", {"scene", "raster", "raytrace"}},
    {"compare", {"scene", "raster", "raytrace", "rays"}},
    {"report", {"scene", "compare"}},
    {"functions", {"scene", "raster", "raytrace", "compare", "report"}},
    {"app", {"scene", "raster", "raytrace", "hybrid", "rays", "compare", "report", "functions"}},
    {"studies", {"scene", "raster", "raytrace", "compare", "report", "app"}},
    {"verify", {"scene", "raster", "raytrace", "app"}},
    {"judge", {"scene", "raster", "raytrace", "compare", "report", "app"}},
    {"grade", {"scene", "raster", "raytrace", "compare", "report", "functions", "app"}},
    {"lab", {"scene", "raster", "raytrace", "hybrid", "compare", "report", "app"}},
    {"benchmark", {"scene", "raster", "raytrace", "hybrid", "compare", "studies", "verify", "app"}},
    {"platform", {"scene", "shaders", "raster", "app", "lab"}},
    {"tests",
     {"scene", "shaders", "raster", "raytrace", "hybrid", "rays", "compare", "report", "functions", "studies",
      "verify", "app", "judge", "grade", "lab", "benchmark", "platform"}},
};

bool is_room(std::string_view name) {
  return arrows.find(name) != arrows.end();
}

std::string room_of(std::string_view path) {
  return std::string(path.substr(0, path.find('/')));
}

bool allowed(const std::string& from, const std::string& to) {
  return from == to || arrows.find(from)->second.contains(to);
}

/// The command line is seen by commands alone, and by the lab, whose states are command lines.
bool may_see_app(std::string_view path) {
  return path.starts_with("app/") || path.starts_with("lab/") || path.starts_with("platform/") ||
         path.starts_with("tests/") || path.find("/commands/") != std::string_view::npos;
}

bool may_use_opengl(std::string_view path) {
  return path.starts_with("raster/") || path.starts_with("lab/view/") ||
         path.starts_with("platform/web/webgl/") || path.starts_with("tests/");
}

/// Loops over all threads are those of scene/base/parallel.h: oneTBB's headers take seconds to compile. What else there is of it,
/// a sort, a limit and an observer of threads, is used where it is needed.
bool may_use_tbb(std::string_view path) {
  constexpr std::string_view files[] = {"scene/base/parallel.cpp", "lab/view/work/priority.cpp"};
  return path.starts_with("tests/") || std::find(std::begin(files), std::end(files), path) != std::end(files);
}

bool is_opengl_header(std::string_view include) {
  constexpr std::string_view prefixes[] = {"glad/", "GL/", "GLES2/", "GLES3/", "EGL/", "KHR/", "GLFW/"};
  return std::any_of(std::begin(prefixes), std::end(prefixes),
                     [&](std::string_view prefix) { return include.starts_with(prefix); });
}

struct Include {
  std::string path;
  bool quoted = false;
};

/// The file named by an #include line, or an empty path.
Include parse_include(std::string_view line) {
  const auto skip_blanks = [&] { line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size())); };
  skip_blanks();
  if (!line.starts_with('#')) return {};
  line.remove_prefix(1);
  skip_blanks();
  if (!line.starts_with("include")) return {};
  line.remove_prefix(7);
  skip_blanks();
  if (line.empty() || (line[0] != '"' && line[0] != '<')) return {};
  const bool quoted = line[0] == '"';
  const std::size_t end = line.find(quoted ? '"' : '>', 1);
  if (end == std::string_view::npos) return {};
  return {std::string(line.substr(1, end - 1)), quoted};
}

std::vector<Include> includes_of(const std::string& text) {
  std::vector<Include> includes;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (Include include = parse_include(line); !include.path.empty()) includes.push_back(std::move(include));
  }
  return includes;
}

bool is_cpp(std::string_view path) {
  return path.ends_with(".h") || path.ends_with(".cpp");
}

/// The raster headers that show OpenGL to whoever includes them, directly or through another header.
std::set<std::string> opengl_headers(const Files& files) {
  std::set<std::string> found;
  for (bool grew = true; grew;) {
    grew = false;
    for (const auto& [path, text] : files) {
      if (!path.starts_with("raster/") || !path.ends_with(".h") || found.contains(path)) continue;
      const std::vector<Include> includes = includes_of(text);
      const bool shows = std::any_of(includes.begin(), includes.end(), [&](const Include& include) {
        return is_opengl_header(include.path) || found.contains(include.path);
      });
      if (shows) grew = found.insert(path).second;
    }
  }
  return found;
}

/// The tests include their own helpers from beside them, from tests/ or from tests/support/.
bool is_test_helper(const std::string& file, const std::string& include, const Files& files) {
  if (!file.starts_with("tests/")) return false;
  const std::string folder = file.substr(0, file.rfind('/') + 1);
  return files.contains(folder + include) || files.contains("tests/" + include) ||
         files.contains("tests/support/" + include);
}

std::string check_include(const std::string& file, const Include& include,
                          const std::set<std::string>& opengl, const Files& files) {
  const std::string from = room_of(file);
  if (is_opengl_header(include.path) && !may_use_opengl(file)) return "OpenGL is private to raster";
  if (include.path.starts_with("tbb/") && !may_use_tbb(file))
    return "loops are those of scene/base/parallel.h";
  if (opengl.contains(include.path) && !may_use_opengl(file)) return "that raster header shows OpenGL";
  if (include.path.starts_with("embedded/shaders") && !allowed(from, "shaders")) {
    return from + " may not see the shaders";
  }
  if (!include.quoted || is_test_helper(file, include.path, files)) return {};
  const std::string to = room_of(include.path);
  if (!is_room(to)) return "own headers are included by their path from the root";
  if (!allowed(from, to)) return from + " may not include " + to;
  if (to == "app" && !may_see_app(file)) return "the command line is for commands";
  if (include.path.starts_with("raytrace/packets/") && from != "raytrace" && from != "tests")
    return "packets/ is the tracer's own: raytrace/receiver_tiles.h is what others have of it";
  return {};
}

/// Every `gnomon::ROOM` in a room's CMake files is a link arrow.
std::vector<std::string> linked_rooms(const std::string& text) {
  std::vector<std::string> rooms;
  constexpr std::string_view marker = "gnomon::";
  for (std::size_t at = text.find(marker); at != std::string::npos; at = text.find(marker, at + 1)) {
    const std::size_t begin = at + marker.size();
    rooms.push_back(text.substr(begin, text.find_first_not_of("abcdefghijklmnopqrstuvwxyz_", begin) - begin));
  }
  return rooms;
}

/// "file: what it names: why not".
std::string arrow_line(const std::string& file, const std::string& named, const std::string& why) {
  return file + ": " + named + ": " + why;
}

/// One line per forbidden arrow.
std::vector<std::string> broken_arrows(const Files& files) {
  std::vector<std::string> broken;
  const std::set<std::string> opengl = opengl_headers(files);
  for (const auto& [file, text] : files) {
    if (is_cpp(file)) {
      for (const Include& include : includes_of(text)) {
        const std::string why = check_include(file, include, opengl, files);
        if (!why.empty()) broken.push_back(arrow_line(file, include.path, why));
      }
    } else {
      for (const std::string& to : linked_rooms(text)) {
        if (is_room(to) && !allowed(room_of(file), to)) {
          broken.push_back(arrow_line(file, "gnomon::" + to, room_of(file) + " may not link it"));
        }
      }
    }
  }
  return broken;
}

bool is_read(const fs::path& path) {
  const std::string name = path.filename().string();
  return is_cpp(name) || name == "CMakeLists.txt" || path.extension() == ".cmake";
}

Files project_files() {
  Files files;
  const fs::path root = gnomon::test::source_dir();
  for (const auto& [room, unused] : arrows) {
    for (auto entry = fs::recursive_directory_iterator(root / room);
         entry != fs::recursive_directory_iterator(); ++entry) {
      if (entry->path().filename() == "node_modules") entry.disable_recursion_pending();
      if (!entry->is_regular_file() || !is_read(entry->path())) continue;
      std::ifstream stream(entry->path(), std::ios::binary);
      files[fs::relative(entry->path(), root).generic_string()] =
          std::string(std::istreambuf_iterator<char>(stream), {});
    }
  }
  return files;
}

/// Files whose kernels for one instruction set are not in a namespace of their own: the linker would be free
/// to take one file's inline function for another's of the same name.
std::vector<std::string> shared_kernel_names(const Files& files) {
  std::vector<std::string> found;
  for (const auto& [file, text] : files) {
    constexpr std::string_view marker = "::HWY_NAMESPACE {\n";
    if (!file.ends_with(".cpp") || file.starts_with("tests/")) continue;
    const std::size_t at = text.find(marker);
    if (at != std::string::npos && text.compare(at + marker.size(), 11, "namespace {") != 0)
      found.push_back(file);
  }
  return found;
}

TEST(Kernels, HaveTheirNamesToThemselves) {
  for (const std::string& file : shared_kernel_names(project_files())) ADD_FAILURE() << file;
  EXPECT_EQ(
      shared_kernel_names({{"raytrace/a.cpp", "namespace gnomon::HWY_NAMESPACE {\nint all();\n"}}).size(),
      1u);
}

const std::string reach = std::string(".structures") + "()";  // in two parts: this file is read, too

/// What a tracer has built is raytrace's own: other rooms, and tests, go through its functions.
std::vector<std::string> reaching_into_tracers(const Files& files) {
  std::vector<std::string> found;
  for (const auto& [file, text] : files)
    if (is_cpp(file) && !file.starts_with("raytrace/") && text.find(reach) != std::string::npos)
      found.push_back(file);
  return found;
}

TEST(Arrows, NobodyReachesIntoTracers) {
  for (const std::string& file : reaching_into_tracers(project_files())) ADD_FAILURE() << file;
  EXPECT_EQ(reaching_into_tracers({{"hybrid/a.cpp", "tracer" + reach + ".bvh"}}).size(), 1u);
}

/// These functions of std::filesystem say "no" where nobody could look, or need their error looked at.
const std::vector<std::string> dropped_errors{"exists(",
                                              "is_directory(",
                                              "is_regular_file(",
                                              "is_empty(",
                                              "equivalent(",
                                              "file_size(",
                                              "status(",
                                              "remove(",
                                              "remove_all(",
                                              "copy_file(",
                                              "directory_iterator",
                                              "recursive_directory_iterator"};

/// May ask std::filesystem itself: the file that others ask, and lists that leave out on purpose what cannot be read (an
/// error is said where the files themselves are read, or there is nobody to be told).
bool may_ask_about_paths(std::string_view path) {
  constexpr std::string_view files[] = {"scene/files/path_status.cpp", "app/outputs/run_files.cpp",
                                        "lab/view/work/file_watch.cpp", "raster/programs/shader_folder.cpp"};
  return path.starts_with("tests/") || std::find(std::begin(files), std::end(files), path) != std::end(files);
}

/// "file: std::filesystem's exists(": "nothing is there" and "nobody could look" are told apart in one file.
std::vector<std::string> questions_about_paths(const Files& files) {
  std::vector<std::string> found;
  for (const auto& [file, text] : files) {
    if (!is_cpp(file) || may_ask_about_paths(file)) continue;
    for (const std::string& question : dropped_errors)
      for (const char* space : {"fs::", "std::filesystem::"})
        if (text.find(space + question) != std::string::npos)
          found.push_back(arrow_line(file, space + question, "is for scene/files/path_status.h to ask"));
  }
  return found;
}

TEST(Arrows, WhetherSomethingIsThereIsAskedInOneFile) {
  for (const std::string& line : questions_about_paths(project_files())) ADD_FAILURE() << line;
  EXPECT_EQ(questions_about_paths({{"app/a.cpp", "if (fs::exists(path, none)) {\n"},
                                   {"compare/a.cpp", "std::filesystem::remove_all(path);\n"},
                                   {"scene/a.cpp", "is_there(path);\n"}})
                .size(),
            2u);
}

/// The namespace of what a room declares, where it is not called as the room is.
const std::map<std::string, std::string, std::less<>> other_namespaces = {
    {"scene", "gnomon"}, {"benchmark", "gnomon::bench"}, {"platform", "gnomon::web"}};

std::string namespace_of(const std::string& room) {
  const auto other = other_namespaces.find(room);
  return other != other_namespaces.end() ? other->second : "gnomon::" + room;
}

bool lies_in(std::string_view inner, std::string_view outer) {
  return inner == outer || (inner.starts_with(outer) && inner.substr(outer.size()).starts_with("::"));
}

/// A room declares in its own namespace; a command, which is a part of the command line, in app's. A file of platform takes the
/// place of one of another room.
bool may_declare(const std::string& file, const std::string& space) {
  const std::string room = room_of(file);
  if (file.find("/commands/") != std::string::npos) return lies_in(space, namespace_of("app"));
  const auto is_of = [&](const auto& other) {
    return other.first != "scene" && lies_in(space, namespace_of(other.first));
  };
  if (room == "scene") return lies_in(space, "gnomon") && std::none_of(arrows.begin(), arrows.end(), is_of);
  if (lies_in(space, namespace_of(room))) return true;
  return room == "platform" && std::any_of(arrows.begin(), arrows.end(), [&](const auto& other) {
           return allowed(room, other.first) && space == namespace_of(other.first);
         });
}

/// Whether a namespace of which `lines` says the rest ends after declarations of classes alone, which any room may name.
bool declares_names_alone(std::istringstream lines) {
  std::string line;
  while (std::getline(lines, line) && !line.starts_with('}'))
    if (!(line.starts_with("struct ") || line.starts_with("class ")) || line.find(';') == std::string::npos ||
        line.find('{') != std::string::npos)
      return false;
  return true;
}

/// "gnomon::raster" where a line at the margin opens it; a namespace of scene's may stand within gnomon.
std::string opened_namespace(const std::string& line, const std::string& room) {
  constexpr std::string_view marker = "namespace ";
  const std::size_t end = line.find(" {");
  if (!line.starts_with(marker) || end == std::string::npos || end <= marker.size()) return {};
  const std::string name = line.substr(marker.size(), end - marker.size());
  if (name == "std") return {};
  if (lies_in(name, "gnomon")) return name;
  return namespace_of(room) + "::" + name;
}

/// "file: gnomon::raster: not its namespace".
std::vector<std::string> strange_namespaces(const Files& files) {
  std::vector<std::string> found;
  for (const auto& [file, text] : files) {
    if (!is_cpp(file) || file.starts_with("tests/")) continue;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      const std::string space = opened_namespace(line, room_of(file));
      if (space.empty() || may_declare(file, space)) continue;
      if (!declares_names_alone(std::istringstream(text.substr(static_cast<std::size_t>(lines.tellg())))))
        found.push_back(arrow_line(file, space, "not its namespace"));
    }
  }
  return found;
}

TEST(Arrows, NamespacesFollowFolders) {
  for (const std::string& line : strange_namespaces(project_files())) ADD_FAILURE() << line;
  const auto strange = [](const char* file, const std::string& text) {
    return strange_namespaces({{file, text}}).size();
  };
  EXPECT_EQ(strange("judge/a.h", "namespace gnomon::compare {\nint f();\n}\n"), 1u);
  EXPECT_EQ(strange("judge/a.h", "namespace gnomon::compare {\nstruct Figure;\n}\n"), 0u);
  EXPECT_EQ(strange("judge/a.h", "namespace gnomon::compare {\nstruct Figure {\n  int a;\n};\n}\n"), 1u);
  EXPECT_EQ(strange("judge/a.h", "namespace gnomon {\nnamespace judge {\nint f();\n}\n}\n"), 1u);
  EXPECT_EQ(strange("judge/commands/a.cpp", "namespace gnomon::judge {\nint f();\n}\n"), 1u);
  EXPECT_EQ(strange("judge/commands/a.cpp", "namespace gnomon::app {\nint f();\n}\n"), 0u);
  EXPECT_EQ(strange("lab/lessons/a.h", "namespace gnomon::lab::lessons {\nint f();\n}\n"), 0u);
  EXPECT_EQ(strange("lab/lessons/a.h", "namespace gnomon::laboratory {\nint f();\n}\n"), 1u);
  EXPECT_EQ(strange("scene/a.h", "namespace gnomon::gltf {\nint f();\n}\n"), 0u);
  EXPECT_EQ(strange("scene/a.h", "namespace gnomon {\nnamespace raster {\nint f();\n}\n}\n"), 1u);
  EXPECT_EQ(strange("platform/web/a.cpp", "namespace gnomon::raster {\nint f();\n}\n"), 0u);
  EXPECT_EQ(strange("platform/web/a.cpp", "namespace gnomon::judge {\nint f();\n}\n"), 1u);
}

TEST(Arrows, HoldInTheWholeProject) {
  const Files files = project_files();
  EXPECT_GE(files.size(), 40u) << "the sources were not found";
  for (const std::string& line : broken_arrows(files)) ADD_FAILURE() << line;
}

// The checks below show that each rule can fail.
std::vector<std::string> broken_by(const std::string& path, const std::string& text) {
  return broken_arrows({{path, text},
                        {"raster/gl/gl.h", "#include <glad/gl.h>\n"},
                        {"raster/object.h", "#pragma once\n#include \"raster/gl/gl.h\"\n"}});
}

TEST(Arrows, RenderersDoNotKnowEachOther) {
  EXPECT_EQ(broken_by("raster/a.cpp", "#include \"raytrace/tracer.h\"\n").size(), 1u);
  EXPECT_EQ(broken_by("raytrace/a.h", "#  include \"raster/frame.h\"\n").size(), 1u);
  EXPECT_EQ(broken_by("raytrace/CMakeLists.txt", "gnomon_library(raytrace DEPENDS gnomon::raster)").size(),
            1u);
}

TEST(Arrows, NobodyIncludesAppAndSceneIncludesNobody) {
  EXPECT_EQ(broken_by("compare/a.cpp", "#include \"app/options/options.h\"\n").size(), 1u);
  EXPECT_EQ(broken_by("scene/a.cpp", "#include \"compare/compare.h\"\n").size(), 1u);
  EXPECT_EQ(broken_by("app/a.cpp", "#include \"judge/judge.h\"\n").size(), 1u);
  EXPECT_EQ(broken_by("judge/a.cpp", "#include \"app/console.h\"\n").size(), 1u);
  EXPECT_TRUE(broken_by("judge/commands/a.cpp", "#include \"app/console.h\"\n").empty());
  EXPECT_TRUE(broken_by("tests/a.cpp", "#include \"app/options/options.h\"\n").empty());
}

TEST(Arrows, OpenGlStaysInRaster) {
  EXPECT_EQ(broken_by("compare/a.cpp", "#include <GL/gl.h>\n").size(), 1u);
  EXPECT_EQ(broken_by("compare/a.cpp", "#include \"raster/object.h\"\n").size(), 1u);
  EXPECT_EQ(broken_by("compare/a.cpp", "#include <embedded/shaders.h>\n").size(), 1u);
  EXPECT_TRUE(broken_by("raster/a.cpp", "#include <GL/gl.h>\n#include <embedded/shaders.h>\n").empty());
}

TEST(Arrows, LoopsAreThoseOfOneHeader) {
  EXPECT_EQ(broken_by("compare/a.cpp", "#include <tbb/parallel_for.h>\n").size(), 1u);
  EXPECT_TRUE(broken_by("scene/base/parallel.cpp", "#include <tbb/parallel_for.h>\n").empty());
  EXPECT_TRUE(broken_by("tests/a.cpp", "#include <tbb/global_control.h>\n").empty());
}

TEST(Arrows, OwnHeadersAreNamedFromTheRoot) {
  EXPECT_EQ(broken_by("scene/a.cpp", "#include \"light.h\"\n").size(), 1u);
  EXPECT_TRUE(broken_by("scene/a.cpp", "#include \"scene/light.h\"\n#include <vector>\n").empty());
}

}  // namespace
