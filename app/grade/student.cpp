#include "app/grade/student.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "raster/shader_folder.h"
#include "scene/files/read_file.h"

namespace gnomon::app::grade {

namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t most_bytes = std::uintmax_t{4} << 20;

bool holds_shader(const fs::path& folder) {
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none))
    if (raster::is_shader(entry.path())) return true;
  const std::vector<raster::ShaderFile> own = raster::own_shaders();
  return std::any_of(own.begin(), own.end(),
                     [&](const raster::ShaderFile& file) { return fs::exists(folder / file.name, none); });
}

std::vector<fs::path> folders_in(const fs::path& folder) {
  std::vector<fs::path> list;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none))
    if (entry.is_directory(none) && !entry.path().filename().string().starts_with('.'))
      list.push_back(entry.path());
  std::sort(list.begin(), list.end());
  return list;
}

std::string name_of(const fs::path& folder) {
  const fs::path plain = folder.lexically_normal();
  const fs::path name = plain.filename().empty() ? plain.parent_path().filename() : plain.filename();
  return name == "." || name == ".." || name.empty() ? fs::weakly_canonical(folder).filename().string()
                                                     : name.string();
}

/// What lies below a student's folder.
struct Contents {
  std::string link;          ///< the first one; "": none
  std::string misnamed;      ///< a file like hard.glsl.txt or HARD.GLSL; "": none
  std::string empty;         ///< a shader without a byte; "": none
  std::uintmax_t bytes = 0;  ///< of its shaders
};

Contents look_into(const fs::path& folder) {
  Contents out;
  std::error_code error;
  for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const fs::path& path = entry->path();
    const std::string name = path.lexically_relative(folder).generic_string();
    std::error_code none;
    if (entry->is_symlink(none) && out.link.empty()) out.link = name;
    if (raster::is_shader(path)) {
      const std::uintmax_t bytes = entry->file_size(none);
      out.bytes += bytes;
      if (bytes == 0) out.empty = name;
    } else if (lower_extension(path.string()) == ".glsl" || path.stem().extension() == ".glsl") {
      out.misnamed = name;
    }
  }
  return out;
}

}  // namespace

Expected<std::vector<Student>> find_students(const std::vector<std::string>& paths) {
  std::vector<Student> students;
  for (const std::string& path : paths) {
    std::error_code none;
    if (!fs::is_directory(path, none))
      return fail(ErrorKind::usage, fmt::format("no such folder (got {})", path));
    const std::vector<fs::path> inner = folders_in(path);
    if (holds_shader(path) || inner.empty()) {
      students.push_back({name_of(path), path});
    } else {
      for (const fs::path& folder : inner) students.push_back({name_of(folder), folder.string()});
    }
  }
  std::set<std::string> names;
  for (const Student& student : students)
    if (!names.insert(student.name).second)
      return fail(ErrorKind::usage,
                  fmt::format("two students have one name, that of their folders (got {})", student.name));
  return students;
}

std::string refusal(const Student& student, const Rubric& rubric) {
  const Contents contents = look_into(student.folder);
  if (!contents.link.empty())
    return fmt::format("{} is a link; only files of the folder itself are read", contents.link);
  if (contents.bytes > most_bytes)
    return fmt::format("holds {} MiB of shaders (allowed 4)", contents.bytes >> 20);
  if (contents.bytes == 0 && !contents.misnamed.empty())
    return fmt::format("nothing was handed in: {} does not end in .glsl", contents.misnamed);
  if (contents.bytes == 0 && !contents.empty.empty())
    return fmt::format("nothing was handed in: {} is empty", contents.empty);
  const std::string nothing = fmt::format("nothing was handed in: no {} that differs from the program's own",
                                          fmt::join(rubric.hand_in, " or "));
  if (contents.bytes == 0) return nothing;
  const auto folder = raster::ShaderFolder::read(student.folder);
  if (!folder) return folder.error().message();
  bool any = false;
  const std::vector<raster::ShaderFile> own = raster::own_shaders();
  for (const raster::ReplacedShader& file : folder->replaced()) {
    const bool is_own =
        std::any_of(own.begin(), own.end(), [&](const auto& o) { return o.name == file.name; });
    const bool asked =
        std::find(rubric.hand_in.begin(), rubric.hand_in.end(), file.name) != rubric.hand_in.end();
    any = any || asked;
    if (is_own && !asked)
      return fmt::format("{} is not to be handed in (allowed {})", file.name,
                         fmt::join(rubric.hand_in, ", "));
  }
  return any ? std::string() : nothing;
}

}  // namespace gnomon::app::grade
