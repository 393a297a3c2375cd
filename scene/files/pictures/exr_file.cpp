#include "scene/files/pictures/exr_file.h"

namespace gnomon {

ExrFile::ExrFile(std::string path, ImageSize size) : path_(std::move(path)), size_(size) {}

Expected<void> ExrFile::write(const PictureRows& rows, std::span<const Channel> channels,
                              std::span<const std::pair<std::string, std::string>> attributes) {
  if (!file_) {
    auto file = PartFile::create(path_);
    if (!file) return fail(file.error());
    file_ = std::move(*file);
    encoder_.emplace(size_, channels, attributes);
    if (const auto begun = file_->append(encoder_->begin()); !begun) return begun;
  }
  return file_->append(encoder_->add(rows.count, channels));
}

Expected<void> ExrFile::close(const std::string& place) {
  if (const auto written = file_->write_over_begin(encoder_->begin()); !written) return written;
  return place == path_ ? file_->publish() : file_->publish_at(place);
}

}  // namespace gnomon
