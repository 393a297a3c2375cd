#include "studies/commands/make_cells.h"

#include <algorithm>
#include <future>
#include <optional>
#include <vector>

#include "app/process/interrupt.h"
#include "compare/result/outputs.h"
#include "scene/base/stages.h"
#include "scene/files/pictures/image_io.h"
#include "scene/files/write_file.h"
#include "studies/sweep/cell_files.h"

namespace gnomon::app {

bool PicturedCells::take(std::size_t cell, const compare::Comparison& comparison, bool derived) {
  if (!studies::has_thumbnail(cell, cells_)) return false;
  std::vector<std::uint64_t> now;
  for (const compare::LightComparison& light : comparison.lights)
    now.insert(now.end(), light.classes.begin(), light.classes.end());
  std::uint64_t moved = 0, wrong = 0;
  for (std::size_t k = 0; k < now.size() && k < last_.size(); ++k)
    moved += std::max(now[k], last_[k]) - std::min(now[k], last_[k]), wrong += last_[k];
  if (cells_ > few && derived && now.size() == last_.size() && moved * 2 <= wrong) return false;
  last_ = std::move(now);
  return true;
}

Expected<void> CellPictureWriter::make_folders() const {
  for (const std::string_view name : studies::sweep_folder_names)
    if (auto made = make_output_subfolder(folder_, std::string(name)); !made) return made;
  return {};
}

/// The name of a truth's picture, empty if it could not be encoded. The job of the truth's first cell tells;
/// the others, on other threads, wait for it.
struct CellPictureWriter::TruthName {
  std::promise<std::string> told;
  std::shared_future<std::string> name = told.get_future().share();
};

struct CellPictureWriter::Pictures {
  std::string folder;
  std::size_t cell = 0;
  std::shared_ptr<TruthName> truth_name;
  std::optional<Rgb8Image> truth, drawing;  ///< empty: written before, not drawn
  Image<std::uint8_t> codes;
  Rgb8Image thumbnail;
};

Expected<void> CellPictureWriter::write(const Pictures& p) {
  const std::string cells = std::string(studies::cells_name) + "/";
  std::vector<std::pair<std::string, std::string>> files;  // name in the folder, bytes
  const auto add = [&files](const std::string& path, const Rgb8Image& image) -> Expected<void> {
    auto png = encode_png(image);
    if (!png) return fail(png.error());
    files.emplace_back(path, std::move(*png));
    return {};
  };
  if (p.truth) {
    Expected<void> added;
    try {
      added = add({}, *p.truth);
    } catch (...) {  // others wait for the name
      p.truth_name->told.set_exception(std::current_exception());
      throw;
    }
    p.truth_name->told.set_value(added ? studies::truth_name(files.back().second) : "");
    if (!added) return added;
    files.back().first = cells + p.truth_name->name.get() + ".png";
  }
  const std::string name = cells + studies::cell_name(p.cell);
  files.emplace_back(name + ".js", studies::cell_data_file(p.cell, p.codes, p.truth_name->name.get()));
  if (p.drawing)
    if (auto added = add(name + ".png", *p.drawing); !added) return added;
  if (auto added = add(studies::thumbnail_name(p.cell), p.thumbnail); !added) return added;
  const OutputGuard whole_files;
  for (const auto& [path, bytes] : files)
    if (auto written = write_file_in(p.folder, path, bytes); !written) return written;
  return {};
}

CellPictureWriter::Job CellPictureWriter::pictures(std::size_t cell, const compare::Comparison& comparison) {
  const TimedStage stage("cell pictures");
  auto pictures = std::make_shared<Pictures>();
  pictures->folder = folder_;
  pictures->cell = cell;
  if (truths_ != engine_.work().truths) {
    truths_ = engine_.work().truths;
    truth_ = std::make_shared<TruthName>();
    pictures->truth = compare::raytraced_picture(comparison);
  }
  pictures->truth_name = truth_;
  pictures->codes = engine_.class_codes();
  pictures->thumbnail = engine_.thumbnail(studies::thumbnail_width);
  if (!engine_.last_was_derived()) pictures->drawing = engine_.drawing(studies::drawing_width);
  return [pictures] { return write(*pictures); };
}

}  // namespace gnomon::app
