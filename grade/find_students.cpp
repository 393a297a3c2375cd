#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <set>

#include "grade/archive.h"
#include "grade/student.h"
#include "raster/programs/shader_folder.h"
#include "scene/files/path_status.h"
#include "scene/files/read_file.h"
#include "scene/files/write_file.h"

namespace gnomon::grade {

namespace {

namespace fs = std::filesystem;

/// A folder as it is read, and as it is called: one that was unpacked lies elsewhere.
struct Place {
  std::string path, shown;
  Place in(const std::string& name) const {
    return {(fs::path(path) / name).string(), (fs::path(shown) / name).string()};
  }
};

bool is_link(const std::string& path) {
  std::error_code error;
  return fs::is_symlink(fs::symlink_status(path, error));
}

/// "class/anna/" and "class/anna/." are class/anna, a link's end rather than the link.
std::string plain_path(const std::string& folder) {
  const fs::path plain = fs::path(folder).lexically_normal();
  return (plain.filename().empty() && plain.has_relative_path() ? plain.parent_path() : plain).string();
}

std::string name_of(const std::string& folder) {
  const std::string name = fs::path(plain_path(folder)).filename().string();
  if (name != "." && name != ".." && !name.empty()) return name;
  std::error_code error;
  const fs::path real = fs::canonical(folder, error);
  return error ? folder : real.filename().string();
}

/// "anna" of "anna.tar.gz".
std::string name_of_archive(const std::string& path) {
  std::string name = name_of(path);
  for (std::string stem = name; is_archive(stem);) name = stem = fs::path(stem).stem().string();
  return name.ends_with(".tar") ? name.substr(0, name.size() - 4) : name;
}

/// What lies in a folder, as far as it tells whose it is.
struct Listing {
  std::vector<std::string> folders;   ///< and links that may lead to folders, and what nobody can look at
  std::vector<std::string> archives;  ///< files
  std::vector<std::string> named;     ///< files that a platform named
  bool holds_shader = false, is_kit = false;
};

/// Folders of which no student has the name.
bool is_of_exercise(const std::string& name) {
  constexpr std::array<std::string_view, 4> names{"function", "technique", "student", "src"};
  return std::ranges::find(names, name) != names.end();
}

Expected<bool> holds_own_place(const std::string& folder) {
  for (const raster::ShaderFile& file : raster::own_shaders()) {
    const auto there = is_there((fs::path(folder) / file.name).string());
    if (!there || *there) return there;
  }
  return false;
}

void add_file(Listing& out, const std::string& name) {
  if (participant_in(name, false))
    out.named.push_back(name);
  else if (is_archive(name))
    out.archives.push_back(name);
  else
    out.holds_shader = out.holds_shader || raster::is_shader(name);
}

Expected<Listing> list(const std::string& folder) {
  const auto names = names_in(folder);
  if (!names) return fail(names.error());
  Listing out;
  for (const std::string& name : *names) {
    if (is_left_by_system(name)) continue;
    const std::string path = (fs::path(folder) / name).string();
    const auto kind = file_kind(path);
    if (!kind || *kind == FileKind::folder || (*kind == FileKind::none && is_link(path)))
      out.folders.push_back(name);
    else
      add_file(out, name);
  }
  const auto own = holds_own_place(folder);
  if (!own) return fail(own.error());
  out.holds_shader = out.holds_shader || *own;
  const auto has = [&](const char* name) { return std::ranges::find(*names, name) != names->end(); };
  out.is_kit = has("rubric.json") && has("student");
  return out;
}

/// A class as a platform packs it.
bool is_of_platform(const Listing& listing) {
  return !listing.named.empty() || std::ranges::any_of(listing.folders, [](const std::string& name) {
    return participant_in(name, true).has_value();
  });
}

bool is_of_one(const Listing& listing) {
  if (is_of_platform(listing)) return false;
  if (listing.holds_shader || listing.is_kit) return true;
  if (listing.folders.empty()) return listing.archives.size() < 2;
  return listing.folders.size() == 1 && listing.archives.empty() && is_of_exercise(listing.folders.front());
}

Student student_at(const Place& place, const std::string& name) {
  Student student{name, place.shown};
  student.places = {place.path};
  return student;
}

/// Students by participant, so that what is one's is together.
class ClassOfFolder {
 public:
  explicit ClassOfFolder(Place place) : place_(std::move(place)) {}

  void add_folder(const std::string& name) { add(name, participant_in(name, true), name); }
  void add_archive(const std::string& name) { add(name, {}, name_of_archive(name)); }
  void add_named(const std::string& name) { add(name, participant_in(name, false), name); }
  std::vector<Student> take() { return std::move(students_); }

 private:
  void add(const std::string& file, const std::optional<Participant>& participant, const std::string& name) {
    const Place place = place_.in(file);
    if (!participant) {
      students_.push_back(student_at(place, name));
      return;
    }
    const std::string key = fmt::format("{} {}", static_cast<int>(participant->platform), participant->id);
    const auto [known, is_new] = of_participant_.emplace(key, students_.size());
    if (is_new) {
      students_.push_back(student_at(place, name_of_participant(*participant)));
      students_.back().participant = *participant;
      return;
    }
    Student& student = students_[known->second];
    student.places.push_back(place.path);
    // The folder of files is the one to hand feedback back in.
    if (participant->returned_as.find("_assignsubmission_file") != std::string::npos) {
      student.participant = *participant;
      student.name = name_of_participant(*participant), student.folder = place.shown;
    }
  }

  /// Moodle's and Brightspace's folders are names by themselves; of single files the student and the number are.
  static std::string name_of_participant(const Participant& participant) {
    if (participant.platform == Platform::moodle || participant.file.empty()) return participant.returned_as;
    return participant.name == participant.id ? participant.name
                                              : fmt::format("{}_{}", participant.name, participant.id);
  }

  Place place_;
  std::vector<Student> students_;
  std::map<std::string, std::size_t> of_participant_;
};

Expected<std::vector<Student>> students_in(const Place& place, const std::string& name, bool from_archive);

/// A folder alone in another is a wrapper where it holds a platform's class, or where an archive was packed around it.
Expected<std::optional<std::vector<Student>>> students_in_wrapper(const Place& place, const Listing& listing,
                                                                  const std::string& name,
                                                                  bool from_archive) {
  using Found = std::optional<std::vector<Student>>;
  if (listing.folders.size() != 1 || !listing.archives.empty()) return Found();
  const Place inner = place.in(listing.folders.front());
  if (is_link(inner.path)) return Found();
  const auto inside = list(inner.path);
  if (!inside || !(from_archive || is_of_platform(*inside))) return Found();
  auto students = students_in(inner, name, false);
  if (!students) return fail(students.error());
  return Found(std::move(*students));
}

Expected<std::vector<Student>> students_in(const Place& place, const std::string& name, bool from_archive) {
  const auto listing = list(place.path);
  if (!listing) {
    Student lost = student_at(place, name);
    lost.unreadable = listing.error();
    return std::vector<Student>{lost};
  }
  if (is_of_one(*listing)) return std::vector<Student>{student_at(place, name)};
  auto wrapped = students_in_wrapper(place, *listing, name, from_archive);
  if (!wrapped) return fail(wrapped.error());
  if (*wrapped) return std::move(**wrapped);
  ClassOfFolder all(place);
  for (const std::string& folder : listing->folders) all.add_folder(folder);
  for (const std::string& archive : listing->archives) all.add_archive(archive);
  for (const std::string& file : listing->named) all.add_named(file);
  return all.take();
}

bool is_of_interest(const std::string& name) {
  return raster::is_shader(name) || is_archive(name) || lower_extension(name) == ".txt";
}

/// What is not asked for stands there empty, for its name says that something was handed in.
Expected<void> unpack(const std::string& path, const std::string& folder) {
  const auto archive = read_file(path);
  if (!archive) return fail(archive.error());
  UnpackLimit limit{.bytes = std::uint64_t{256} << 20};
  const auto files = open_archive(path, *archive, is_of_interest, limit);
  if (!files) return fail(files.error());
  for (const PackedFile& file : *files) {
    if (file.is_link) return fail(Error{ErrorKind::bad_input, "holds a link", path});
    const std::string place = (fs::path(folder) / file.name).string();
    if (const auto made = make_folder_for(place); !made) return made;
    if (const auto written = write_file(place, file.bytes.value_or("")); !written) return written;
  }
  return make_output_folder(folder);
}

Expected<std::vector<Student>> students_of_archive(const std::string& path, const std::string& unpacked) {
  if (const auto done = unpack(path, unpacked); !done) {
    if (done.error().kind != ErrorKind::bad_input) return fail(done.error());
    Student lost{name_of_archive(path), path};
    lost.unreadable = done.error();
    return std::vector<Student>{lost};
  }
  auto students = students_in({unpacked, path}, name_of_archive(path), true);
  // One student's archive is opened as any other that was handed in.
  if (students && students->size() == 1 && students->front().name == name_of_archive(path))
    students->front().places = {path}, students->front().folder = path;
  return students;
}

/// The students that a path of the command line stands for.
Expected<std::vector<Student>> students_at(const std::string& path, const std::string& unpacked) {
  const auto kind = file_kind(path);
  const bool is_lost_link = kind && *kind == FileKind::none && is_link(plain_path(path));
  if (kind && *kind == FileKind::file && is_archive(path)) return students_of_archive(path, unpacked);
  if (kind && *kind != FileKind::folder && !is_lost_link)
    return fail(ErrorKind::usage, fmt::format("no such folder (got {})", path));
  Student one{name_of(path), path};
  one.places = {path};
  if (!kind) one.unreadable = kind.error();
  if (!kind || is_lost_link) return std::vector<Student>{one};
  return students_in({path, path}, name_of(path), false);
}

}  // namespace

bool is_left_by_system(const std::string& name) {
  return name.starts_with('.') || name == "__MACOSX" || name == "Thumbs.db" || name == "desktop.ini";
}

Expected<std::vector<Student>> find_students(const std::vector<std::string>& paths,
                                             const std::string& unpacked) {
  std::vector<Student> students;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const auto some = students_at(paths[i], fmt::format("{}/{}", unpacked, i));
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

}  // namespace gnomon::grade
