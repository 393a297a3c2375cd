#include "grade/handed_in.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <optional>
#include <regex>
#include <set>

#include "grade/archive.h"
#include "grade/shader_rules.h"
#include "raster/programs/shader_folder.h"
#include "scene/files/path_status.h"
#include "scene/files/read_file.h"
#include "scene/files/write_file.h"

namespace gnomon::grade {

namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t most_bytes = std::uint64_t{4} << 20;

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

std::string name_in(const std::string& place) {
  return place.substr(place.rfind('/') + 1);
}

// ---- what lies there ----

/// A file whose text may count.
struct Found {
  std::string place;  ///< from the student's folder: "homework.zip/function/ray_box.glsl"
  std::string text;
};

/// All that a student handed in.
struct Contents {
  std::vector<Found> files;
  std::vector<std::string> others;  ///< places of what is no text, and is none of the system's
  std::string link;                 ///< the first one; "": none
  std::string odd;          ///< "technique/hard.glsl is a folder, not a file"; "": nothing of the kind
  std::uint64_t bytes = 0;  ///< of shaders
  UnpackLimit limit{};
};

/// What lies at the path itself, a link not followed.
Expected<mode_t> mode_of(const std::string& path) {
  struct stat found {};
  if (lstat(path.c_str(), &found) == 0) return found.st_mode & S_IFMT;
  return fail(
      Error{ErrorKind::bad_input, fmt::format("cannot be looked at: {}", std::strerror(errno)), path});
}

/// "a folder", for what a shader cannot be; empty for a plain file.
std::string_view kind_words(mode_t mode) {
  if (mode == S_IFDIR) return "a folder";
  if (mode == S_IFIFO) return "a pipe";
  if (mode == S_IFSOCK) return "a socket";
  return mode == S_IFREG ? "" : "a device";
}

/// Windows hides the ending that it adds: "hard.glsl.txt".
bool may_be_text(const std::string& name) {
  const std::string small = lower_case(name);
  return raster::is_shader(small) || small.ends_with(".txt");
}

bool is_worth_reading(const std::string& name) {
  return may_be_text(name) || is_archive(name);
}

bool is_systems(const std::string& place) {
  for (const fs::path& part : fs::path(place))
    if (is_left_by_system(part.string())) return true;
  return false;
}

/// `where`: what messages call it.
Expected<void> add_archive(const std::string& place, const std::string& where, std::string_view bytes,
                           Contents& out) {
  if (out.limit.depth-- == 0)
    return fail(Error{ErrorKind::bad_input, "is an archive in an archive in an archive", where});
  const auto files = open_archive(where, bytes, is_worth_reading, out.limit);
  if (!files) return fail(files.error());
  for (const PackedFile& file : *files) {
    const std::string inner = place + "/" + file.name;
    if (is_systems(file.name)) continue;
    if (file.is_link) {
      if (out.link.empty()) out.link = inner;
    } else if (file.bytes && is_archive(file.name)) {
      if (const auto added = add_archive(inner, where + "/" + file.name, *file.bytes, out); !added)
        return added;
    } else if (file.bytes) {
      out.bytes += raster::is_shader(file.name) ? file.bytes->size() : 0;
      out.files.push_back({inner, *file.bytes});
    } else {
      out.others.push_back(inner);
    }
  }
  ++out.limit.depth;
  return {};
}

Expected<void> add_plain_file(const std::string& path, const std::string& place, const std::string& where,
                              Contents& out) {
  constexpr std::uint64_t largest_archive = std::uint64_t{256} << 20, largest_note = std::uint64_t{1} << 20;
  const auto bytes = size_of_file(path);
  if (!bytes) return fail(bytes.error());
  const bool is_shader = raster::is_shader(place);
  if (is_shader) out.bytes += *bytes;
  if (out.bytes > most_bytes) return {};
  if (is_archive(place) && *bytes > largest_archive)
    return fail(
        Error{ErrorKind::bad_input, fmt::format("is too large ({} MiB, allowed 256)", *bytes >> 20), where});
  if (!is_worth_reading(place) || (!is_shader && !is_archive(place) && *bytes > largest_note)) {
    out.others.push_back(place);
    return {};
  }
  auto text = read_file(path);
  if (!text) return fail(text.error());
  if (is_archive(place)) return add_archive(place, where, *text, out);
  out.files.push_back({place, std::move(*text)});
  return {};
}

/// `path` is where it lies, `place` what it is called in the student's folder.
Expected<void> add_file(const std::string& path, const std::string& place, const std::string& where,
                        Contents& out) {
  const auto mode = mode_of(path);
  if (!mode) return fail(mode.error());
  if (*mode == S_IFLNK) {
    if (out.link.empty()) out.link = place;
  } else if (*mode != S_IFREG) {
    if (raster::is_shader(place)) out.odd = fmt::format("{} is {}, not a file", place, kind_words(*mode));
  } else {
    return add_plain_file(path, place, where, out);
  }
  return {};
}

Expected<void> add_folder(const std::string& folder, const std::string& prefix, const std::string& where,
                          Contents& out) {
  const auto names = files_below(folder);
  if (!names) return fail(names.error());
  for (const std::string& name : *names) {
    if (is_systems(name)) continue;
    const auto added =
        add_file(fmt::format("{}/{}", folder, name), prefix + name, fmt::format("{}/{}", where, name), out);
    if (!added) return added;
  }
  for (const raster::ShaderFile& file : raster::own_shaders())
    if (const auto mode = mode_of((fs::path(folder) / file.name).string()); mode && *mode == S_IFDIR)
      out.odd = fmt::format("{} is a folder, not a file", file.name);
  return {};
}

Expected<Contents> look_into(const Student& student) {
  Contents out;
  const std::vector<std::string> places =
      student.places.empty() ? std::vector{student.folder} : student.places;
  for (const std::string& path : places) {
    const auto mode = mode_of(path);
    if (!mode) return fail(mode.error());
    const bool several = places.size() > 1;
    // The folder's own name counts where messages would not say which one is meant.
    const std::string own = name_in(path), prefix = several ? own + "/" : "";
    const std::string where =
        several ? fs::path(student.folder).replace_filename(own).string() : student.folder;
    const auto added =
        *mode == S_IFDIR ? add_folder(path, prefix, where, out) : add_file(path, own, where, out);
    if (!added) return fail(added.error());
  }
  return out;
}

// ---- which of them is the one that is asked for ----

/// How surely a file's name is the one that is asked for.
enum class Likeness : std::uint8_t { same, decorated, similar, none };

/// "ray_box", ".glsl" of "function/ray_box.glsl".
struct AskedName {
  std::string stem, ending;
  explicit AskedName(const std::string& name)
      : stem(lower_case(fs::path(name).stem().string())),
        ending(lower_case(fs::path(name).extension().string())) {}
};

/// What stands behind the stem: nothing, or what systems, browsers and people add when there are several.
Likeness likeness_of_rest(std::string rest, const std::string& ending) {
  static const std::regex copy(
      R"re(([ _.\-]*(\(\d+\)|\[\d+\]|\d+|copy|copie|kopie|copia|final|new|neu|v\d+|version \d+|late))*\)?)re");
  static const std::regex behind(R"re((\.txt)?([ _.\-]*\(?\d+\)?)?(\.txt)?)re");
  const std::size_t at = rest.rfind(ending);
  if (at == std::string::npos || rest.size() > 200) return Likeness::none;
  const std::string after = rest.substr(at + ending.size());
  rest.resize(at);
  if (!std::regex_match(after, behind)) return Likeness::none;
  if (rest.empty()) return after.empty() ? Likeness::same : Likeness::decorated;
  if (std::isalnum(static_cast<unsigned char>(rest.front())) != 0) return Likeness::none;
  return std::regex_match(rest, copy) ? Likeness::decorated : Likeness::similar;
}

Likeness likeness(const std::string& place, const AskedName& asked) {
  std::string name = name_in(place);
  const auto participant = participant_in(name, false);
  name = lower_case(participant ? participant->file : name);
  const std::size_t at = name.rfind(asked.stem);
  if (at == std::string::npos) return Likeness::none;
  if (at > 0 && std::isalnum(static_cast<unsigned char>(name[at - 1])) != 0) return Likeness::none;
  const Likeness like = likeness_of_rest(name.substr(at + asked.stem.size()), asked.ending);
  return at == 0 || like == Likeness::none ? like : Likeness::similar;
}

/// As it is compared with what students begin with: editors change how lines end.
std::string plain_text(const std::string& text) {
  std::string plain(without_byte_order_mark(text));
  std::erase(plain, '\r');
  while (plain.ends_with('\n') || plain.ends_with(' ')) plain.pop_back();
  return plain;
}

bool is_begun(const std::string& name, const std::string& text, const Rubric& rubric) {
  const std::string plain = plain_text(text);
  for (const raster::ShaderFile& file : raster::own_shaders())
    if (file.name == name && plain_text(std::string(file.text)) == plain) return true;
  return std::ranges::any_of(rubric.begun,
                             [&](const std::string& begun) { return plain_text(begun) == plain; });
}

/// The names that a text includes, as they stand there.
std::vector<std::string> includes_of(const std::string& text) {
  static const std::regex form(R"re(^#include "([^"]+)")re");
  std::vector<std::string> names;
  for (const LogicalLine& line : logical_lines(text))
    if (std::smatch found; line.text.size() < 4096 && std::regex_search(line.text, found, form))
      names.push_back(found[1]);
  return names;
}

using Candidates = std::vector<std::pair<const Found*, Likeness>>;

/// Leaves those out for which the test holds, unless it holds for all.
template <class Test>
void prefer_others(Candidates& candidates, const Test& test) {
  const bool all = std::ranges::all_of(candidates, test);
  if (!all) std::erase_if(candidates, test);
}

bool is_included(const Found& file, const Contents& contents) {
  return std::ranges::any_of(contents.files, [&](const Found& other) {
    const auto names = includes_of(other.text);
    return &other != &file && std::ranges::any_of(names, [&](const std::string& name) {
      return file.place == name || file.place.ends_with("/" + name);
    });
  });
}

/// Null: nothing may be it. Error: several may.
Expected<const Found*> find_asked(const std::string& name, const Contents& contents, const Rubric& rubric) {
  const AskedName asked(name);
  Candidates candidates;
  for (const Found& file : contents.files)
    if (const Likeness like = likeness(file.place, asked); like != Likeness::none)
      candidates.emplace_back(&file, like);
  prefer_others(candidates, [&](const auto& one) { return is_begun(name, one.first->text, rubric); });
  prefer_others(candidates, [&](const auto& one) { return is_included(*one.first, contents); });
  if (candidates.empty()) return nullptr;
  const auto by_name = [](const auto& one) { return one.second == Likeness::similar; };
  prefer_others(candidates, by_name);
  std::ranges::stable_sort(candidates, {}, [](const auto& one) { return one.second; });
  const Found& first = *candidates.front().first;
  for (const auto& [file, like] : candidates)
    if (plain_text(file->text) != plain_text(first.text))
      return fail(ErrorKind::bad_input, fmt::format("two files may be {}: {} and {}; leave one of them", name,
                                                    one_line(first.place), one_line(file->place)));
  return &first;
}

/// "homework.zip/" of "homework.zip/function/ray_box.glsl", which is asked for as "function/ray_box.glsl".
std::string root_of(const std::string& place, const std::string& asked) {
  const std::string folder = place.substr(0, place.size() - name_in(place).size());
  const std::string of_asked = asked.substr(0, asked.size() - name_in(asked).size());
  const bool in_its_folder = !of_asked.empty() && (folder == of_asked || folder.ends_with("/" + of_asked));
  return in_its_folder ? folder.substr(0, folder.size() - of_asked.size()) : folder;
}

class Taking {
 public:
  Taking(const Student& student, const Rubric& rubric, const Contents& contents)
      : student_(student), rubric_(rubric), contents_(contents) {}

  Expected<HandIn> take() {
    for (const std::string& name : rubric_.hand_in) {
      const auto found = find_asked(name, contents_, rubric_);
      if (!found) return lost(found.error());
      if (*found != nullptr) add(name, **found);
    }
    add_includes();
    if (const auto whole = nothing_is_overlooked(); !whole) return fail(whole.error());
    HandIn out{why_not(), {}};
    if (out.refused.empty()) out.refused = refuse_functions();
    if (out.refused.empty()) out.files = std::move(files_);
    return out;
  }

 private:
  tl::unexpected<Error> lost(Error error) const {
    error.file = student_.folder;
    return fail(std::move(error));
  }
  void add(const std::string& name, const Found& file) {
    files_.push_back({name, fmt::format("{}/{}", student_.folder, file.place), file.text});
    roots_.insert(root_of(file.place, name));
    used_.insert(&file);
  }
  bool is_taken(const std::string& name) const {
    return std::ranges::any_of(files_, [&](const HandedFile& file) { return file.name == name; });
  }

  /// A student's own files beside those that are asked for; what is not found, the compiler will miss.
  void add_includes() {
    for (std::size_t i = 0; i < files_.size(); ++i)
      for (const std::string& name : includes_of(files_[i].text)) {
        const bool leads_out = name.starts_with('/') || name.find("..") != std::string::npos;
        if (leads_out || is_taken(name) || is_own(name)) continue;
        for (const Found& file : contents_.files)
          if (file.place == name || file.place.ends_with("/" + name)) {
            add(name, file);
            break;
          }
      }
  }

  static bool is_own(const std::string& name) {
    const auto own = raster::own_shaders();
    return std::ranges::any_of(own, [&](const auto& file) { return file.name == name; });
  }

  /// Who handed in something by another name is not one who handed in nothing.
  Expected<void> nothing_is_overlooked() const {
    if (files_.empty()) {
      std::vector<std::string> there = contents_.others;
      for (const Found& file : contents_.files) there.push_back(file.place);
      std::erase_if(there, is_of_kit);
      if (there.empty()) return {};
      return lost(
          {ErrorKind::bad_input, fmt::format("holds no {}, but {}{}", fmt::join(rubric_.hand_in, " or "),
                                             one_line(there.front()), there.size() > 1 ? " and more" : "")});
    }
    for (const std::string& name : rubric_.hand_in)
      if (!is_taken(name))
        if (const Found* file = one_that_holds(fs::path(name).stem().string()))
          return lost(
              {ErrorKind::bad_input, fmt::format("{} holds what {} is asked to hold; give it that name",
                                                 one_line(file->place), name)});
    return {};
  }
  /// What comes with an exercise besides its shaders.
  static bool is_of_kit(const std::string& place) {
    return place.ends_with(".json") || name_in(place) == "README.md" || place.ends_with("onlinetext.html");
  }
  /// A file that nobody asked for, with a function of that name.
  const Found* one_that_holds(const std::string& function) const {
    if (!rubric_.technique.empty()) return nullptr;
    const std::regex definition("\\b" + function + "\\s*\\(");
    for (const Found& file : contents_.files)
      if (!used_.contains(&file) && file.text.size() < (1 << 16) && std::regex_search(file.text, definition))
        return &file;
    return nullptr;
  }

  std::string why_not() const {
    const std::string asked = fmt::format("{}", fmt::join(rubric_.hand_in, " or "));
    if (files_.empty())
      return fmt::format("nothing was handed in: no {} that differs from the program's own", asked);
    for (const HandedFile& file : files_)
      if (file.text.empty()) return fmt::format("nothing was handed in: {} is empty", one_line(shown(file)));
    if (std::string extra = one_too_many(); !extra.empty()) return extra;
    return {};
  }
  /// A function with a macro that it may not have costs its own points, all else those of everything.
  std::string refuse_functions() {
    for (HandedFile& file : files_) {
      bool of_macro = false;
      std::string reason = why_refused(one_line(shown(file)), file.text, rubric_, &of_macro);
      const bool is_asked = std::ranges::find(rubric_.hand_in, file.name) != rubric_.hand_in.end();
      if (!reason.empty() && !(of_macro && is_asked && rubric_.technique.empty())) return reason;
      file.refused = std::move(reason);
    }
    return {};
  }
  /// Its place in the student's folder.
  std::string shown(const HandedFile& file) const { return file.place.substr(student_.folder.size() + 1); }

  /// A shader of the program's own that was changed though the exercise does not ask for it.
  std::string one_too_many() const {
    for (const Found& file : contents_.files)
      for (const std::string& root : roots_) {
        if (used_.contains(&file) || !file.place.starts_with(root)) continue;
        const std::string name = file.place.substr(root.size());
        const auto is_given = [&](const GivenFile& given) { return given.name == name; };
        const bool is_asked = std::ranges::find(rubric_.hand_in, name) != rubric_.hand_in.end();
        if (!is_own(name) || is_asked || std::ranges::any_of(rubric_.given, is_given)) continue;
        if (rubric_.given.empty() && !is_begun(name, file.text, rubric_))
          return fmt::format("{} is not to be handed in (allowed {})", name,
                             fmt::join(rubric_.hand_in, ", "));
      }
    return {};
  }

  const Student& student_;
  const Rubric& rubric_;
  const Contents& contents_;
  std::vector<HandedFile> files_;
  std::set<std::string> roots_;
  std::set<const Found*> used_;
};

/// Why nothing is drawn with, as far as what lies there tells.
std::string why_not(const Contents& contents) {
  if (!contents.link.empty())
    return fmt::format("{} is a link; only files of the folder itself are read", one_line(contents.link));
  if (!contents.odd.empty()) return one_line(contents.odd);
  if (contents.bytes > most_bytes)
    return fmt::format("holds {} MiB of shaders (allowed 4)", contents.bytes >> 20);
  return {};
}

bool leads_elsewhere(const std::string& folder) {
  const fs::path plain = fs::path(folder).lexically_normal();
  const fs::path place = plain.filename().empty() && plain.has_relative_path() ? plain.parent_path() : plain;
  const auto mode = mode_of(place.string());
  return mode && *mode == S_IFLNK;
}

}  // namespace

Expected<HandIn> take_in(const Student& student, const Rubric& rubric) {
  if (student.unreadable) return fail(*student.unreadable);
  const std::vector<std::string> places =
      student.places.empty() ? std::vector{student.folder} : student.places;
  if (std::ranges::any_of(places, leads_elsewhere))
    return HandIn{"the folder is a link; name the folder itself, for a link may lead to another student's",
                  {}};
  const auto contents = look_into(student);
  if (!contents) return fail(contents.error());
  if (std::string reason = why_not(*contents); !reason.empty()) return HandIn{reason, {}};
  auto taken = Taking(student, rubric, *contents).take();
  if (!taken || !taken->refused.empty()) return taken;
  // A technique's first steps may be a teacher's own, which have points; the program's own file has none.
  const auto own = raster::own_shaders();
  const bool any = std::ranges::any_of(taken->files, [&](const HandedFile& file) {
    return std::ranges::none_of(own, [&](const auto& o) {
      return o.name == file.name && plain_text(std::string(o.text)) == plain_text(file.text);
    });
  });
  if (any) return taken;
  return HandIn{fmt::format("nothing was handed in: no {} that differs from the program's own",
                            fmt::join(rubric.hand_in, " or ")),
                {}};
}

std::string answer_of(const HandIn& handed_in) {
  std::string text;
  for (const HandedFile& file : handed_in.files) text += file.text;
  return text;
}

Expected<void> write_with_given(const HandIn& handed_in, const Rubric& rubric, const std::string& folder) {
  std::vector<std::pair<std::string, std::string>> files;
  for (const HandedFile& file : handed_in.files) {
    if (!file.refused.empty()) continue;
    const bool is_asked = std::ranges::find(rubric.hand_in, file.name) != rubric.hand_in.end();
    files.emplace_back(file.name, file.text);
    if (!is_asked) continue;
    std::string all;
    for (const HandedFile& any : handed_in.files) all += any.text + "\n";
    files.back().second += ending_macros(all);
  }
  for (const GivenFile& given : rubric.given) files.emplace_back(given.name, given.text);
  for (const auto& [name, text] : files) {
    const std::string path = fmt::format("{}/{}", folder, name);
    if (const auto made = make_folder_for(path); !made) return made;
    if (const auto written = write_file(path, text); !written) return written;
  }
  return {};
}

}  // namespace gnomon::grade
