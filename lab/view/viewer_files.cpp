// What the viewer leaves behind: screenshots, pictures, the command line, a scene file, a report; and the runs of
// this program beside the window.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/outputs/run_files.h"
#include "app/process/interrupt.h"
#include "lab/view/state/status.h"
#include "lab/view/viewer.h"
#include "lab/view/work/scene_source.h"
#include "raster/settings.h"
#include "scene/base/expected.h"
#include "scene/base/threads.h"
#include "scene/files/path_status.h"
#include "scene/files/pictures/image_io.h"

namespace gnomon::lab {

namespace {

namespace fs = std::filesystem;

constexpr const char* tuned_error = "1%";

Expected<void> save_image(const Rgb8Image& image, const std::string& path) {
  const app::OutputGuard whole_output;
  if (auto made = make_folder_for(path); !made) return made;
  return write_png(path, image);
}

}  // namespace

void Viewer::note(std::string_view text) {
  note_ = one_line(text);
  busy_frames_ = 3;
}

void Viewer::note(const Error& error) {
  note(error.message());
  app::print_error(error);
}

/// A script's: written before the next step.
Expected<void> Viewer::save_screenshot(const std::string& path) {
  const auto picture = screenshot();
  if (!picture) return fail(picture.error());
  if (auto written = save_image(*picture, path); !written) return written;
  console_.message("screenshot: " + path);
  watch_.leave_out();
  return {};
}

Expected<Rgb8Image> Viewer::screenshot() const {
  const ImageSize size = window_->framebuffer_size();
  return presenter_->read({0, 0, size.width, size.height});
}

/// What is to be said of --max-lights where the window does not have all of the scene's lights.
std::string Viewer::left_out_words() const {
  const std::size_t count = shown_->scene->lights_left_out;
  if (count == 0) return {};
  return count == 1 ? ", without one light that --max-lights leaves out"
                    : fmt::format(", without {} lights that --max-lights leaves out", count);
}

/// SCENE-KIND-001.png and so on; nothing is overwritten. `save` runs beside the window; the remark is said when it is
/// done.
void Viewer::save_numbered(const std::string& start, const std::string& extension,
                           std::function<Expected<void>(const std::string&)> save,
                           const std::string& remark) {
  if (saving_.valid()) return note("still saving " + saving_path_);
  saving_remark_ = remark;
  for (int number = 1;; ++number) {
    saving_path_ = fmt::format("{}-{:03}{}", start, number, extension);
    const auto taken = is_there(saving_path_, ErrorKind::cannot_write);
    if (!taken) return note(taken.error());
    if (!*taken) break;
  }
  saving_ = in_background([save = std::move(save), path = saving_path_] { return save(path); });
}

/// "courtyard-labels".
std::string Viewer::file_start(std::string_view kind) const {
  return fmt::format("{}-{}", fs::path(shown_->scene->argument.name).stem().string(), kind);
}

void Viewer::save_numbered_screenshot() {
  auto picture = screenshot();
  if (!picture) return note(picture.error());
  save_numbered(file_start(picture_name(state_.picture)), ".png",
                [image = std::move(*picture)](const std::string& path) { return save_image(image, path); });
}

/// Saves the picture with as many pixels as it was made with, whatever stands around it.
void Viewer::save_picture() {
  const Rgb8Image* image = picture(state_.picture);
  if (image == nullptr) return;
  save_numbered(file_start(fmt::format("{}-picture", picture_name(state_.picture))), ".png",
                [image, keeps = shown_](const std::string& path) { return save_image(*image, path); });
}

void Viewer::save_scene() {
  const app::SceneArgument& opened = shown_->scene->argument;
  save_numbered(
      folder_for_scene(opened) + file_start("scene"), ".json",
      [opened, state = state_](const std::string& path) { return write_scene(path, opened, state); },
      left_out_words());
}

void Viewer::copy_command() {
  const std::string command = compare_command(state_, options_, shown_->scene->argument);
  window_->copy(command);
  print_command();
  note("copied: " + command);
}

void Viewer::print_command() const {
  app::print_data(compare_command(state_, options_, shown_->scene->argument) + "\n");
  if (state_.setup.map_camera)
    console_.note("the map's camera is frozen; the command line lays the map for the view's own");
  for (const std::string& light : other_turned_lights(state_))
    console_.note(fmt::format(
        "light {} was turned, too, which the command line leaves out: it turns the chosen light alone",
        light));
}

/// "compare", the scene as it was opened, and the options.
std::vector<std::string> Viewer::job_words(const std::string& command, const std::vector<std::string>& fixed,
                                           const std::vector<std::string>& of_view) const {
  std::vector<std::string> words{command};
  for (const auto& part : {shown_->scene->argument.plain_words(), fixed, of_view})
    words.insert(words.end(), part.begin(), part.end());
  return words;
}

void Viewer::write_report() {
  if (job_) return note("something runs already; Esc stops it");
  const std::string name = fs::path(shown_->scene->argument.name).stem().string();
  std::string folder;
  for (int number = 1;; ++number) {
    folder = fmt::format("{}-report-{:03}", name, number);
    const auto taken = is_there(folder, ErrorKind::cannot_write);
    if (!taken) return note(taken.error());
    if (!*taken) break;
  }
  auto job = Job::start("writing the report to " + folder,
                        job_words("compare", {"-o", folder, "--quiet"},
                                  setting_words(state_, options_, shown_->scene->argument.name)));
  if (!job) return note(job.error());
  job_ = std::move(*job);
  job_tunes_ = false;
  note_.clear();
}

void Viewer::find_best() {
  if (job_) return note("something runs already; Esc stops it");
  for (const std::string& light : other_turned_lights(state_))
    console_.note(fmt::format(
        "light {} was turned, too, which the search leaves out: it turns the chosen light alone", light));
  auto job =
      Job::start("searching the cheapest setting with at most 1 % wrong",
                 job_words("tune", {"--max-error", tuned_error, "--runs", "1", "--json", "-", "--quiet"},
                           tuning_words(state_, options_)));
  if (!job) return note(job.error());
  job_ = std::move(*job);
  job_tunes_ = true;
  note_.clear();  // the status line tells of the search
}

void Viewer::look_after_job() {
  if (saving_.valid() && saving_.wait_for(std::chrono::seconds(0)) != std::future_status::timeout) {
    const Expected<void> saved = saving_.get();
    saved ? note("saved " + saving_path_ + saving_remark_) : note(saved.error());
  }
  if (!job_ || !job_->ended()) return;
  const std::unique_ptr<Job> done = std::move(job_);
  const int code = done->exit_code();
  if (code > 1) {
    std::string why = done->err();
    while (why.ends_with('\n')) why.pop_back();
    return note(fmt::format("it failed ({}): {}", code, why));
  }
  if (job_tunes_) return use_answer(*done);
  note("done: " + done->status().title);
}

/// The options of the tuner's answer, by their names on the command line.
void Viewer::use_answer(const Job& job) {
  const auto answer = nlohmann::json::parse(job.out(), nullptr, false);
  if (!answer.is_object() || !answer.contains("options")) return note("the tuner gave no answer");
  raster::MapOptions map;
  std::vector<std::string> words;
  bool biased = false, slope = false;
  for (const auto& [name, value] : answer["options"].items()) {
    const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
    const raster::MapSetting* setting = raster::find_setting(name);
    if (setting == nullptr) continue;
    if (const auto set = raster::set_setting(*setting, map, text); !set) return note(set.error());
    words.push_back(fmt::format("--{} {}", name, text));
    if (name == "slope-bias") slope = true;
    biased = biased || setting->group == raster::SettingGroup::bias;
  }
  if (!slope) map.bias.slope = biased ? 0.0 : raster::default_bias(map).slope;
  lab::carry_out(state_, SetMap{map});
  // "--technique lispsm --map-size 128: the cheapest that is good enough: 0.69 % wrong, ..."
  note(fmt::format("{}{}: {}", answer.value("feasible", true) ? "" : "nothing is good enough; ",
                   fmt::join(words, " "), answer.value("why", "")));
}

}  // namespace gnomon::lab
