#include "scene/files/pictures/exr_file.h"

#include "scene/files/pictures/image_library.h"

namespace gnomon {

ExrFile::ExrFile(std::string path, ImageSize size) : path_(std::move(path)), size_(size) {}
ExrFile::ExrFile(ExrFile&&) noexcept = default;
ExrFile& ExrFile::operator=(ExrFile&&) noexcept = default;
ExrFile::~ExrFile() = default;

Expected<void> ExrFile::open(std::span<const Channel> channels,
                             std::span<const std::pair<std::string, std::string>> attributes) {
  auto file = PartFile::create(path_);
  if (!file) return fail(file.error());
  std::vector<std::string> names;
  for (const Channel& channel : channels) names.push_back(channel.name);
  const auto library = image_library();
  if (!library) return fail(library.error());
  auto rows = (*library)->open_exr(file->path(), size_, names, attributes);
  if (!rows) return fail(rows.error());
  rows_ = std::move(*rows), file_ = std::move(*file);
  return {};
}

Expected<void> ExrFile::write(const PictureRows& rows, std::span<const Channel> channels,
                              std::span<const std::pair<std::string, std::string>> attributes) {
  if (!rows_)
    if (const auto opened = open(channels, attributes); !opened) return fail(opened.error());
  const std::size_t count = channels.size(), pixels = ImageSize{size_.width, rows.count}.pixels();
  std::vector<float> mixed(pixels * count);
  for (std::size_t c = 0; c < count; ++c)
    for (std::size_t i = 0; i < pixels; ++i) mixed[i * count + c] = channels[c].values[i];
  return rows_->write(rows, mixed);
}

Expected<void> ExrFile::close() {
  if (const auto closed = rows_->close(); !closed) return fail(closed.error());
  return file_->publish();
}

}  // namespace gnomon
