#include "grade/rubric.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <regex>
#include <set>

#include "raster/programs/shader_folder.h"
#include "scene/base/expected.h"
#include "scene/files/path_status.h"
#include "scene/files/read_file.h"
#include "scene/files/write_file.h"

namespace gnomon::grade {

namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t most_bytes = std::uint64_t{4} << 20;

/// What lies at the path itself, a link not followed.
Expected<mode_t> mode_of(const std::string& path) {
  struct stat found {};
  if (lstat(path.c_str(), &found) == 0) return found.st_mode & S_IFMT;
  return fail(
      Error{ErrorKind::bad_input, fmt::format("cannot be looked at: {}", std::strerror(errno)), path});
}

bool is_link(const std::string& path) {
  const auto mode = mode_of(path);
  return mode && *mode == S_IFLNK;
}

/// "a folder", for what a shader cannot be; empty for a plain file.
std::string_view kind_words(mode_t mode) {
  if (mode == S_IFDIR) return "a folder";
  if (mode == S_IFIFO) return "a pipe";
  if (mode == S_IFSOCK) return "a socket";
  return mode == S_IFREG ? "" : "a device";
}

/// "class/anna/" and "class/anna/." lead to class/anna, a link's end rather than the link.
std::string place_of(const std::string& folder) {
  const fs::path plain = fs::path(folder).lexically_normal();
  return (plain.filename().empty() && plain.has_relative_path() ? plain.parent_path() : plain).string();
}

Expected<bool> holds_shader(const std::string& folder) {
  const auto names = names_in(folder);
  if (!names) return fail(names.error());
  if (std::any_of(names->begin(), names->end(), [](const auto& name) { return raster::is_shader(name); }))
    return true;
  for (const raster::ShaderFile& file : raster::own_shaders()) {
    const auto there = is_there((fs::path(folder) / file.name).string());
    if (!there || *there) return there;
  }
  return false;
}

/// Folders, links that may lead to folders, and what nobody can look at; hidden ones left out.
Expected<std::vector<std::string>> folders_in(const std::string& folder) {
  const auto names = names_in(folder);
  if (!names) return fail(names.error());
  std::vector<std::string> list;
  for (const std::string& name : *names) {
    if (name.starts_with('.')) continue;
    const std::string path = (fs::path(folder) / name).string();
    const auto kind = file_kind(path);
    if (!kind || *kind == FileKind::folder || (*kind == FileKind::none && is_link(path)))
      list.push_back(path);
  }
  return list;
}

std::string name_of(const std::string& folder) {
  const std::string name = fs::path(place_of(folder)).filename().string();
  if (name != "." && name != ".." && !name.empty()) return name;
  std::error_code error;
  const fs::path real = fs::canonical(folder, error);
  return error ? folder : real.filename().string();
}

/// The students that a path of the command line stands for.
Expected<std::vector<Student>> students_at(const std::string& path) {
  const auto kind = file_kind(path);
  const bool is_lost_link = kind && *kind == FileKind::none && is_link(place_of(path));
  if (kind && *kind != FileKind::folder && !is_lost_link)
    return fail(ErrorKind::usage, fmt::format("no such folder (got {})", path));
  const auto unreadable = [&](const Error& error) {
    return std::vector<Student>{{name_of(path), path, error}};
  };
  const std::vector<Student> one{{name_of(path), path}};
  if (!kind) return unreadable(kind.error());
  if (is_lost_link) return one;
  const auto inner = folders_in(path);
  if (!inner) return unreadable(inner.error());
  const auto own = holds_shader(path);
  if (!own) return unreadable(own.error());
  if (*own || inner->empty()) return one;
  std::vector<Student> students;
  for (const std::string& folder : *inner) students.push_back({name_of(folder), folder});
  return students;
}

/// What lies below a student's folder.
struct Contents {
  std::string link;         ///< the first one; "": none
  std::string odd;          ///< "technique/hard.glsl is a folder, not a file"; "": nothing of the kind
  std::string misnamed;     ///< a file like hard.glsl.txt or HARD.GLSL; "": none
  std::string empty;        ///< a shader without a byte; "": none
  std::uint64_t bytes = 0;  ///< of its shaders
};

Expected<void> look_at(const std::string& folder, const std::string& name, Contents& out) {
  const std::string path = folder + "/" + name;
  const auto mode = mode_of(path);
  if (!mode) return fail(mode.error());
  if (*mode == S_IFLNK) {
    if (out.link.empty()) out.link = name;
  } else if (!raster::is_shader(name)) {
    if (lower_extension(name) == ".glsl" || fs::path(name).stem().extension() == ".glsl") out.misnamed = name;
  } else if (*mode != S_IFREG) {
    out.odd = fmt::format("{} is {}, not a file", name, kind_words(*mode));
  } else {
    const auto bytes = size_of_file(path);
    if (!bytes) return fail(bytes.error());
    out.bytes += *bytes;
    if (*bytes == 0) out.empty = name;
  }
  return {};
}

Expected<Contents> look_into(const std::string& folder) {
  Contents out;
  const auto names = files_below(folder);
  if (!names) return fail(names.error());
  for (const std::string& name : *names)
    if (const auto looked = look_at(folder, name, out); !looked) return fail(looked.error());
  for (const raster::ShaderFile& file : raster::own_shaders())
    if (const auto mode = mode_of((fs::path(folder) / file.name).string()); mode && *mode == S_IFDIR)
      out.odd = fmt::format("{} is a folder, not a file", file.name);
  return out;
}

/// Why nothing of the files is drawn with, as far as their names and sizes tell.
std::string refusal_of(const Contents& contents, const std::string& nothing) {
  if (!contents.link.empty())
    return fmt::format("{} is a link; only files of the folder itself are read", one_line(contents.link));
  if (!contents.odd.empty()) return one_line(contents.odd);
  if (contents.bytes > most_bytes)
    return fmt::format("holds {} MiB of shaders (allowed 4)", contents.bytes >> 20);
  if (contents.bytes > 0) return {};
  if (!contents.misnamed.empty())
    return fmt::format("nothing was handed in: {} does not end in .glsl", one_line(contents.misnamed));
  if (!contents.empty.empty())
    return fmt::format("nothing was handed in: {} is empty", one_line(contents.empty));
  return nothing;
}

/// A shader that cannot be read is no shader that is wrong.
Expected<void> read_all(const std::string& folder) {
  const auto names = files_below(folder);
  if (!names) return fail(names.error());
  for (const std::string& name : *names) {
    if (!raster::is_shader(name)) continue;
    if (const auto read = read_file(fmt::format("{}/{}", folder, name)); !read) return fail(read.error());
  }
  return {};
}

/// Returns the refusal as far as the files' contents tell.
std::string refusal_of(const raster::ShaderFolder& folder, const Rubric& rubric, const std::string& nothing) {
  bool any = false;
  const std::vector<raster::ShaderFile> own = raster::own_shaders();
  for (const raster::ReplacedShader& file : folder.replaced()) {
    const bool is_own =
        std::any_of(own.begin(), own.end(), [&](const auto& o) { return o.name == file.name; });
    const bool asked =
        std::find(rubric.hand_in.begin(), rubric.hand_in.end(), file.name) != rubric.hand_in.end();
    any = any || asked;
    const bool is_given = std::any_of(rubric.given.begin(), rubric.given.end(),
                                      [&](const GivenFile& given) { return given.name == file.name; });
    if (is_own && !asked && !is_given)
      return fmt::format("{} is not to be handed in (allowed {})", file.name,
                         fmt::join(rubric.hand_in, ", "));
  }
  return any ? std::string() : nothing;
}

/// The text with blanks in place of comments and of line ends that a backslash takes away (GLSL 4.50, 3.1 and 3.4).
std::string without_comments(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const std::string_view rest = std::string_view(text).substr(i);
    std::size_t length = 0;
    if (rest.starts_with("//")) length = std::min(rest.find('\n'), rest.size());
    if (rest.starts_with("/*")) length = std::min(rest.find("*/", 2), rest.size() - 2) + 2;
    if (rest.starts_with("\\\n")) length = 2;
    if (length == 0)
      out += text[i++];
    else
      out += ' ', i += length;
  }
  return out;
}

/// Beside given files: why the text may reach what these keep to themselves; empty where it does not.
std::string refusal_beside_given(const std::string& name, const std::string& text) {
  static const std::regex directive(R"re((^|\n)[ \t]*#[ \t]*(undef|include)[ \t]*("([^"\n]*)")?)re");
  const std::string bare = without_comments(text);
  const std::vector<raster::ShaderFile> own = raster::own_shaders();
  for (std::sregex_iterator at(bare.begin(), bare.end(), directive), end; at != end; ++at) {
    if ((*at)[2] == "undef") return fmt::format("{} has an #undef, which this exercise does not allow", name);
    const std::string included = (*at)[4];
    if (std::any_of(own.begin(), own.end(), [&](const auto& o) { return o.name == included; }))
      return fmt::format("{} includes the program's {}, which does what the exercise asks for", name,
                         included);
  }
  static const std::regex input(R"re(\b(uniform|buffer|layout)\b)re");
  if (std::smatch found; name.starts_with("function/") && std::regex_search(bare, found, input))
    return fmt::format(
        "{} has the word {}, which this exercise does not allow: a function is handed what it needs", name,
        found.str());
  return {};
}

/// What was handed in, by name; `beside_given`: but for files of the program's names, in whose place given ones stand.
Expected<std::vector<std::pair<std::string, std::string>>> handed_in(const Student& student,
                                                                     bool beside_given) {
  const auto names = files_below(student.folder);
  if (!names) return fail(names.error());
  std::vector<std::pair<std::string, std::string>> files;
  const std::vector<raster::ShaderFile> own = raster::own_shaders();
  for (const std::string& name : *names) {
    const bool is_given =
        beside_given && std::any_of(own.begin(), own.end(), [&](const auto& o) { return o.name == name; });
    if (!raster::is_shader(name) || is_given) continue;
    auto text = read_file(fmt::format("{}/{}", student.folder, name));
    if (!text) return fail(text.error());
    files.emplace_back(name, std::move(*text));
  }
  return files;
}

Expected<std::string> refusal_beside_given(const Student& student, const Rubric& rubric) {
  const auto files = handed_in(student, true);
  if (!files) return fail(files.error());
  bool any = false;
  for (const auto& [name, text] : *files) {
    any = any || std::find(rubric.hand_in.begin(), rubric.hand_in.end(), name) != rubric.hand_in.end();
    if (std::string why_not = refusal_beside_given(name, text); !why_not.empty()) return why_not;
  }
  return any ? std::string()
             : fmt::format("nothing was handed in: there is no {}", fmt::join(rubric.hand_in, " or "));
}

/// Of functions, which are written without the program's own.
Expected<std::string> refusal_of_includes(const Student& student) {
  const auto files = handed_in(student, false);
  if (!files) return fail(files.error());
  for (const auto& [name, text] : *files)
    if (std::string why_not = refusal_beside_given(name, text); !why_not.empty()) return why_not;
  return std::string();
}

}  // namespace

Expected<void> write_with_given(const Student& student, const Rubric& rubric, const std::string& folder) {
  auto files = handed_in(student, true);
  if (!files) return fail(files.error());
  for (const GivenFile& given : rubric.given) files->emplace_back(given.name, given.text);
  for (const auto& [name, text] : *files) {
    const std::string path = fmt::format("{}/{}", folder, name);
    if (const auto made = make_folder_for(path); !made) return made;
    if (const auto written = write_file(path, text); !written) return written;
  }
  return {};
}

Expected<std::vector<Student>> find_students(const std::vector<std::string>& paths) {
  std::vector<Student> students;
  for (const std::string& path : paths) {
    const auto some = students_at(path);
    if (!some) return fail(some.error());
    students.insert(students.end(), some->begin(), some->end());
  }
  if (!students.empty() &&
      std::ranges::all_of(students, [](const Student& s) { return s.unreadable.has_value(); }))
    return fail(*students.front().unreadable);
  std::set<std::string> names;
  for (const Student& student : students)
    if (!names.insert(student.name).second)
      return fail(
          ErrorKind::usage,
          fmt::format("two folders have the same name, which is the student's (got {})", student.name));
  return students;
}

Expected<std::string> refusal(const Student& student, const Rubric& rubric) {
  if (student.unreadable) return fail(*student.unreadable);
  if (is_link(place_of(student.folder)))
    return std::string(
        "the folder is a link; name the folder itself, for a link may lead to another student's");
  const auto contents = look_into(student.folder);
  if (!contents) return fail(contents.error());
  const std::string nothing = fmt::format("nothing was handed in: no {} that differs from the program's own",
                                          fmt::join(rubric.hand_in, " or "));
  if (std::string why_not = refusal_of(*contents, nothing); !why_not.empty()) return why_not;
  if (const auto read = read_all(student.folder); !read) return fail(read.error());
  if (!rubric.given.empty()) return refusal_beside_given(student, rubric);
  const auto folder = raster::ShaderFolder::read(student.folder);
  if (!folder) return folder.error().message();
  std::string why_not = refusal_of(*folder, rubric, nothing);
  return why_not.empty() && rubric.technique.empty() ? refusal_of_includes(student)
                                                     : Expected<std::string>(why_not);
}

Expected<std::string> answer_of(const Student& student, const Rubric& rubric) {
  const auto why_not = refusal(student, rubric);
  if (!why_not) return fail(why_not.error());
  if (!why_not->empty()) return std::string();
  const auto files = handed_in(student, !rubric.given.empty());
  if (!files) return fail(files.error());
  std::string text;
  for (const auto& [name, shader] : *files) text += shader;
  return text;
}

}  // namespace gnomon::grade
