#include "app/sweep/cell_pictures.h"

#include "app/interrupt.h"
#include "compare/outputs.h"
#include "compare/sweep/cell_files.h"
#include "scene/files/image_io.h"
#include "scene/files/write_file.h"

namespace gnomon::app {

Expected<void> CellPictureWriter::make_folders() const {
  if (auto made = make_output_folder(folder_ + "/thumbnails"); !made) return made;
  return make_output_folder(compare::cells_folder(folder_));
}

Expected<void> CellPictureWriter::write_truth(const compare::Comparison& comparison) {
  if (truths_ == engine_.work().truths) return {};
  const auto png = encode_png(compare::raytraced_picture(comparison));
  if (!png) return fail(png.error());
  truth_ = compare::truth_name(*png);
  truths_ = engine_.work().truths;
  return write_file(compare::cells_folder(folder_) + "/" + truth_ + ".png", *png);
}

Expected<void> CellPictureWriter::write(std::size_t cell, const compare::Comparison& comparison) {
  const OutputGuard whole_files;
  if (auto written = write_truth(comparison); !written) return written;
  const std::string name = compare::cells_folder(folder_) + "/" + compare::cell_name(cell);
  if (auto written = write_file(name + ".js", compare::cell_data_file(cell, engine_.class_codes(), truth_));
      !written)
    return written;
  if (!engine_.last_was_derived()) {
    const auto drawing = encode_png(engine_.drawing(compare::drawing_width));
    if (!drawing) return fail(drawing.error());
    if (auto written = write_file(name + ".png", *drawing); !written) return written;
  }
  const auto thumbnail = encode_png(engine_.thumbnail(compare::thumbnail_width));
  if (!thumbnail) return fail(thumbnail.error());
  return write_file(compare::thumbnail_path(folder_, cell), *thumbnail);
}

}  // namespace gnomon::app
