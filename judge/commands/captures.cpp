#include "judge/commands/captures.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <optional>
#include <set>
#include <utility>

#include "app/process/interrupt.h"
#include "judge/recorded_frame.h"
#include "scene/files/path_status.h"
#include "scene/files/read_file.h"
#include "scene/files/staged_folder.h"
#include "scene/files/write_file.h"

namespace gnomon::app {
namespace {

/// A page's frame belongs to its capture.
Expected<void> keep_frame(const std::string& frame, const std::string& folder) {
  const auto bytes = read_file(frame);
  if (!bytes) return fail(bytes.error());
  return write_file_in(folder, "frame.rdc", *bytes);
}

/// Makes a capture of a recorded frame in `folder` and puts its capture.json in the frame's place.
/// `page`: of which it was recorded, or none.
Expected<void> make_capture(std::string& path, const PageFrame* page, const std::string& light,
                            const std::string& folder, Console& console) {
  const OutputGuard whole_outputs;
  auto staged = StagedFolder::open(folder);
  if (!staged) return fail(staged.error());
  console.progress("replaying the frame", 0.0);
  const auto found =
      judge::capture_recorded_frame(path, staged->path(), light, page != nullptr ? page->renderer : "");
  if (!found) return fail(found.error());
  if (page != nullptr)
    if (const auto kept = keep_frame(path, staged->path()); !kept) return kept;
  if (const auto sealed = staged->seal(std::vector{path}); !sealed) return sealed;
  if (const auto published = staged->publish("capture.json"); !published) return published;
  for (const std::string& finding : *found) console.note(finding);
  path = folder + "/capture.json";
  return {};
}

std::string unused_name(const std::string& base, std::set<std::string>& taken) {
  std::string name = base;
  for (int count = 2; !taken.insert(name).second; ++count) name = fmt::format("{}-{}", base, count);
  return name;
}

/// A letter, digit, dot, dash or underscore stays; what else a name has becomes a dash.
std::string file_name_of(std::string name) {
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '.' && c != '_') c = '-';
  return name;
}

/// "town" of http://localhost:8000/games/town.html?fog=1, "localhost-8000" of http://localhost:8000/.
std::string name_of_page(const std::string& address) {
  const std::string whole = address.substr(address.find("://") + 3);
  const std::filesystem::path place(whole.substr(0, whole.find_first_of("?#")));
  const std::filesystem::path last = place.has_filename() ? place : place.parent_path();
  return file_name_of(place.has_parent_path() && place.has_filename() ? last.stem().string()
                                                                      : last.filename().string());
}

}  // namespace

Expected<std::vector<judge::Capture>> lights_of(const CaptureOptions& options, const std::string& path) {
  std::vector<judge::Capture> lights(1);
  CaptureOptions parts = options;
  if (!path.empty()) {
    auto read = judge::read_captures(path);
    if (!read) return fail(read.error());
    lights = std::move(*read);
  }
  if (!lights.front().within.empty() && !parts.given.light.empty()) {
    auto chosen = judge::read_capture(path, parts.given.light);
    if (!chosen) return fail(chosen.error());
    lights = {std::move(*chosen)}, parts.given.light.clear();
  }
  for (judge::Capture& light : lights) {
    auto whole = with_options(std::move(light), parts);
    if (!whole) return fail(whole.error());
    light = std::move(*whole);
    if (const auto sound = judge::check_capture(light); !sound)
      return fail(light.path.empty() ? usage_error(sound.error(), parts) : sound.error());
  }
  return lights;
}

RunFiles inputs_of(const judge::Capture& capture) {
  RunFiles files;
  files.reads(capture.path);
  files.reads(SceneArgument{capture.scene});
  for (const std::string* picture :
       {&capture.visibility, &capture.shadowed, &capture.unshadowed, &capture.also, &capture.position})
    files.reads(*picture);
  if (capture.depth) files.reads(capture.depth->file);
  for (const judge::CapturedLayer& layer : capture.map) files.reads(layer.depth);
  return files;
}

Expected<void> record_frame(const std::string& page, PageFrame& frame, Console& console) {
  console.progress("recording the page", 0.0);
  const auto engine =
      judge::record_page(page, frame.path(), [&](const std::string& said) { console.note(said); });
  if (!engine) return fail(engine.error());
  frame.renderer = engine->empty() ? name_of(page) : *engine;
  return {};
}

std::string name_of(const std::string& path) {
  if (path.find("://") != std::string::npos) return name_of_page(path);
  const std::filesystem::path file(path);
  if (file.stem() != "capture" || !file.parent_path().has_filename()) return file.stem().string();
  std::error_code unknown;  // the current folder: then the path as it was given
  const auto whole = std::filesystem::absolute(file, unknown);
  return (unknown ? file : whole).lexically_normal().parent_path().filename().string();
}

Expected<void> make_captures(std::vector<std::string>& captures, bool alone, CaptureOptions& options,
                             std::string& folder, Console& console) {
  const auto is_to_be_made = [](const std::string& word) {
    return judge::is_recorded_frame(word) || judge::is_page(word);
  };
  if (std::ranges::none_of(captures, is_to_be_made)) return {};
  const std::string light = std::exchange(options.given.light, "");
  const bool single = captures.size() == 1 && alone;
  if (folder.empty()) folder = single ? "out/" + name_of(captures.front()) : "out/judge";
  for (std::string& path : captures) {
    if (!is_to_be_made(path)) continue;
    const std::string place = single ? folder + "-capture" : folder + "-captures/" + name_of(path);
    std::optional<PageFrame> frame;
    if (judge::is_page(path)) {
      frame.emplace();
      if (const auto recorded = record_frame(path, *frame, console); !recorded) return recorded;
      path = frame->path();
    }
    if (const auto made = make_capture(path, frame ? &*frame : nullptr, light, place, console); !made)
      return made;
  }
  return {};
}

std::vector<NamedCapture> all_lights(const std::vector<std::string>& captures,
                                     const CaptureOptions& options) {
  std::vector<NamedCapture> out;
  std::set<std::string> taken;
  for (const std::string& path : captures) {
    const std::string base = name_of(path);
    auto lights = lights_of(options, path);
    if (!lights) out.push_back({unused_name(base, taken), fail(lights.error())});
    if (!lights) continue;
    for (judge::Capture& light : *lights) {
      const bool alone = lights->size() == 1;
      const std::string name = alone ? base : base + "-" + file_name_of(light.light);
      out.push_back({unused_name(name, taken), std::move(light)});
    }
  }
  return out;
}

Expected<std::vector<std::string>> captures_below(const std::string& folder) {
  std::vector<std::string> found;
  const auto add = [&](const std::filesystem::path& file) -> Expected<void> {
    const auto kind = file_kind(file.string());
    if (!kind) return fail(kind.error());
    if (*kind != FileKind::none && *kind != FileKind::folder) found.push_back(file.string());
    return {};
  };
  if (auto added = add(std::filesystem::path(folder) / "capture.json"); !added) return fail(added.error());
  const auto names = names_if_there(folder);
  if (!names) return fail(names.error());
  for (const std::string& name : *names) {
    const std::filesystem::path below = std::filesystem::path(folder) / name;
    if (file_kind_or_none(below.string()) != FileKind::folder) continue;  // a link in a circle is none either
    if (auto added = add(below / "capture.json"); !added) return fail(added.error());
  }
  if (found.empty())
    return fail(ErrorKind::bad_input, fmt::format("--suite: no capture.json in {} or its folders", folder));
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace gnomon::app
