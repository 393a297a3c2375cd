#include "scene/files/formats.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <vector>

#include "scene/base/run_apart.h"
#include "scene/files/read_file.h"

namespace gnomon {
namespace {

constexpr double longest_s = 300.0;  // on a busy machine; its processor time is limited besides

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

/// The files that X3D text shows in its own place: the url of each Inline, quotes and all. Whatever begins so counts, in comments, too:
/// parsers do not agree on where those end.
std::vector<std::string> inlined_files(std::string_view text) {
  constexpr std::string_view element = "<Inline";
  std::vector<std::string> files;
  for (std::size_t at = text.find(element); at != std::string_view::npos; at = text.find(element, at + 1)) {
    const std::string_view rest = text.substr(at + element.size());
    if (rest.empty() || std::string_view(" \t\r\n/>").find(rest.front()) == std::string_view::npos) continue;
    std::string_view tag = rest.substr(0, rest.find('>'));
    if (tag.ends_with('/')) tag.remove_suffix(1);
    const std::size_t url = tag.find("url");
    files.emplace_back(url == std::string_view::npos ? std::string_view() : tag.substr(url));
  }
  return files;
}

/// What an X3D file names is not read: only the file itself is.
Expected<void> check_stands_alone(std::string_view bytes, const std::string& file) {
  // Other encodings would be read, and not be looked through here.
  if (bytes.find('\0') != std::string_view::npos)
    return foreign_error(file, ErrorKind::bad_input,
                         "its text is not UTF-8; save it as such, or export .glb");
  const std::vector<std::string> inlined = inlined_files(bytes);
  if (inlined.empty()) return {};
  return foreign_error(
      file, ErrorKind::bad_input,
      fmt::format("shows another file in its place (Inline {}), and no file but itself is read; put all "
                  "into one file, or export .glb",
                  printable(inlined.front(), 100)));
}

/// Finds the error in what assimp says, in one line.
std::string why_not(const std::string& said) {
  constexpr std::string_view mark = "ERROR: ";
  const std::size_t at = said.find(mark);
  if (at == std::string::npos) return "assimp cannot read it";
  const std::size_t begin = at + mark.size();
  return fmt::format("assimp: {}", printable(said.substr(begin, said.find('\n', begin) - begin), 200));
}

Expected<std::string> converted(std::string_view bytes, const std::string& file) {
  ApartProgram assimp{.name = std::filesystem::path(file).filename().string(),
                      .bytes = bytes,
                      .words =
                          [](const std::string& in, const std::string& out) {
                            return std::vector<std::string>{
                                "prlimit",  "--as=4000000000", "--cpu=120", "--fsize=4000000000",
                                "--core=0", "assimp",          "export",    in,
                                out,        "-fglb2"};
                          },
                      .programs = {"prlimit", "assimp"},
                      .longest_s = longest_s};
  auto end = run_apart(assimp);
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
  return std::move(end->written);
}

}  // namespace

std::string_view foreign_hint(std::string_view extension) {
  const auto found = std::ranges::find(hints, extension, &Hint::extension);
  return found == std::end(hints) ? std::string_view() : found->text;
}

Expected<LoadedFile> read_foreign(std::string_view bytes, const std::string& file, const std::string& folder,
                                  const LoadOptions& options) {
  if (lower_extension(file) == ".x3d")
    if (auto alone = check_stands_alone(bytes, file); !alone) return fail(alone.error());
  const auto glb = converted(bytes, file);
  if (!glb) return fail(glb.error());
  auto loaded = read_gltf(*glb, file, folder, options);
  if (!loaded) return loaded;
  loaded->scene.notes.insert(loaded->scene.notes.begin(),
                             "Read by way of glTF, which assimp made of it: the file's lights are left out, "
                             "and what glTF's materials do not "
                             "know.");
  loaded->why_none = "lights of such files are not read";
  return loaded;
}

}  // namespace gnomon
