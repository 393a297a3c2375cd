#include "scene/files/formats.h"

#include <fmt/core.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "scene/base/run_program.h"
#include "scene/files/read_file.h"
#include "scene/files/write_file.h"

namespace gnomon {
namespace {

constexpr double longest_s = 300.0;  // on a busy machine; its processor time is limited besides
constexpr std::array foreign{".stl", ".fbx", ".dae", ".3ds", ".x3d", ".3mf"};

struct Hint {
  std::string_view extension, text;
};
constexpr Hint hints[] = {
    {".blend", "Blender exports it: File, Export, glTF 2.0 (.glb)"},
    {".ifc", "IfcConvert of IfcOpenShell makes a .glb of it"},
    {".usd", "Blender imports it and exports .glb"},
    {".usda", "Blender imports it and exports .glb"},
    {".usdc", "Blender imports it and exports .glb"},
    {".usdz", "Blender imports it and exports .glb"},
    {".abc", "Blender imports it and exports .glb"},
    {".vtk", "ParaView exports what it shows as .gltf"},
    {".vtp", "ParaView exports what it shows as .gltf"},
    {".b3dm", "the 3D Tiles tools unpack the .glb in it: 3d-tiles-tools b3dmToGlb"},
    {".step", "FreeCAD exports it as .glb"},
    {".stp", "FreeCAD exports it as .glb"},
};

tl::unexpected<Error> foreign_error(const std::string& file, ErrorKind kind, std::string reason) {
  Error error{kind, std::move(reason)};
  error.file = file;
  return fail(std::move(error));
}

/// A file in memory, which a child inherits.
class MemoryFile {
 public:
  explicit MemoryFile(const char* name) : file_(memfd_create(name, 0)) {}

  bool is_open() const { return file_.number() >= 0; }
  int number() const { return file_.number(); }
  std::string path() const { return fmt::format("/proc/self/fd/{}", number()); }
  Expected<std::string> bytes() const { return read_file(path()); }

 private:
  Descriptor file_;
};

/// Finds the error in what assimp says, in one line.
std::string why_not(const std::string& said) {
  constexpr std::string_view mark = "ERROR: ";
  const std::size_t at = said.find(mark);
  if (at == std::string::npos) return "assimp cannot read it";
  const std::size_t begin = at + mark.size();
  return fmt::format("assimp: {}", printable(said.substr(begin, said.find('\n', begin) - begin), 200));
}

Expected<std::string> converted(const std::string& file) {
  const MemoryFile glb("gnomon-glb");
  if (!glb.is_open())
    return foreign_error(file, ErrorKind::graphics,
                         fmt::format("cannot make a file in memory: {}", std::strerror(errno)));
  const std::string path = (file.starts_with('-') ? "./" : "") + file;
  const auto end = run_and_listen(
      {"prlimit", "--as=4000000000", "--cpu=120", "assimp", "export", path, glb.path(), "-fglb2"}, longest_s);
  if (!end) return foreign_error(file, end.error().kind, end.error().reason);
  constexpr int not_found = 127, not_started = 1;  // prlimit's own ends
  const bool is_missing =
      end->code == not_found ||
      (end->code == not_started && end->said.find("failed to execute") != std::string::npos);
  if (is_missing)
    return foreign_error(
        file, ErrorKind::bad_input,
        "this format is read by the program assimp, which is not there (Debian: assimp-utils)");
  if (end->code != 0) return foreign_error(file, ErrorKind::bad_input, why_not(end->said));
  return glb.bytes();
}

}  // namespace

bool is_foreign(std::string_view extension) {
  return std::ranges::find(foreign, extension) != foreign.end();
}

std::string_view foreign_hint(std::string_view extension) {
  const auto found = std::ranges::find(hints, extension, &Hint::extension);
  return found == std::end(hints) ? std::string_view() : found->text;
}

Expected<LoadedFile> read_foreign(const std::string& file, const std::string& folder,
                                  const LoadOptions& options) {
  const auto glb = converted(file);
  if (!glb) return fail(glb.error());
  auto loaded = read_gltf(*glb, file, folder, options);
  if (!loaded) return loaded;
  loaded->scene.notes.insert(loaded->scene.notes.begin(),
                             "Read by way of glTF, which assimp made of it: the file's lights are left out, "
                             "and what glTF's materials do not "
                             "know.");
  return loaded;
}

}  // namespace gnomon
