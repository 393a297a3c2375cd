#include "grade/archive.h"

#include <archive.h>
#include <archive_entry.h>
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <memory>

#include "scene/files/read_file.h"

namespace gnomon::grade {

namespace {

struct Closing {
  void operator()(::archive* opened) const { archive_read_free(opened); }
};
using Reader = std::unique_ptr<::archive, Closing>;

/// Formats that are common at home, and no others: each reader is a surface of its own.
Reader make_reader() {
  Reader reader(archive_read_new());
  archive_read_support_format_zip_seekable(reader.get());
  archive_read_support_format_tar(reader.get());
  archive_read_support_format_7zip(reader.get());
  archive_read_support_filter_gzip(reader.get());
  archive_read_support_filter_bzip2(reader.get());
  archive_read_support_filter_xz(reader.get());
  archive_read_support_filter_zstd(reader.get());
  return reader;
}

/// Zip files of Windows name files in bytes of no declared encoding.
std::string name_of(::archive_entry* entry) {
  const char* name = archive_entry_pathname_utf8(entry);
  if (name == nullptr) name = archive_entry_pathname(entry);
  std::string text = name != nullptr ? name : "?";
  std::ranges::replace(text, '\\', '/');
  while (text.starts_with("./")) text.erase(0, 2);
  return text;
}

bool leads_out(const std::string& name) {
  return name.starts_with('/') || (name.size() > 1 && name[1] == ':') || name == ".." ||
         name.starts_with("../") || name.find("/../") != std::string::npos || name.ends_with("/..");
}

class Opened {
 public:
  Opened(const std::string& place, UnpackLimit& limit)
      : place_(place), limit_(limit), reader_(make_reader()) {}

  Expected<std::vector<PackedFile>> files(std::string_view archive, bool (*keeps)(const std::string&)) {
    if (archive_read_open_memory(reader_.get(), archive.data(), archive.size()) != ARCHIVE_OK)
      return broken();
    std::vector<PackedFile> files;
    for (;;) {
      ::archive_entry* entry = nullptr;
      const int status = archive_read_next_header(reader_.get(), &entry);
      if (status == ARCHIVE_EOF) return files;
      if (status != ARCHIVE_OK && status != ARCHIVE_WARN) return broken();
      PackedFile file{name_of(entry), {}};
      if (leads_out(file.name))
        return wrong(fmt::format("has a file whose name leads out of it ({})", printable(file.name)));
      if (archive_entry_filetype(entry) == AE_IFDIR) continue;
      file.is_link = archive_entry_filetype(entry) == AE_IFLNK || archive_entry_hardlink(entry) != nullptr;
      if (limit_.files-- == 0) return wrong("holds too many files");
      const auto bytes = static_cast<std::uint64_t>(std::max<la_int64_t>(archive_entry_size(entry), 0));
      if (bytes > limit_.passed) return wrong("holds too much");
      limit_.passed -= bytes;
      if (!file.is_link && keeps(file.name)) {
        auto read = bytes_of_entry(entry);
        if (!read) return fail(read.error());
        file.bytes = std::move(*read);
      }
      files.push_back(std::move(file));
    }
  }

 private:
  /// Whatever the header says, no more is read than is allowed.
  Expected<std::string> bytes_of_entry(::archive_entry* entry) {
    if (archive_entry_is_encrypted(entry) != 0) return wrong("is locked by a password");
    std::string bytes;
    std::array<char, 65536> block;
    for (;;) {
      const la_ssize_t count = archive_read_data(reader_.get(), block.data(), block.size());
      if (count < 0) return broken();
      if (count == 0) return bytes;
      if (static_cast<std::uint64_t>(count) > limit_.bytes) return wrong("holds too much");
      limit_.bytes -= static_cast<std::uint64_t>(count);
      bytes.append(block.data(), static_cast<std::size_t>(count));
    }
  }

  tl::unexpected<Error> wrong(std::string reason) const {
    return fail(Error{ErrorKind::bad_input, std::move(reason), place_});
  }
  tl::unexpected<Error> broken() const {
    const char* said = archive_error_string(reader_.get());
    return wrong(
        fmt::format("cannot be opened ({})", said != nullptr ? printable(said, 120) : "no reason told"));
  }

  const std::string& place_;
  UnpackLimit& limit_;
  Reader reader_;
};

}  // namespace

bool is_archive(const std::string& name) {
  std::string small = name;
  for (char& c : small) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  constexpr std::array<std::string_view, 13> endings{".zip",     ".7z",      ".tar",  ".tgz",    ".tbz",
                                                     ".txz",     ".tbz2",    ".tzst", ".tar.gz", ".tar.xz",
                                                     ".tar.bz2", ".tar.zst", ".zipx"};
  return std::ranges::any_of(endings, [&](std::string_view ending) { return small.ends_with(ending); });
}

Expected<std::vector<PackedFile>> open_archive(const std::string& place, std::string_view archive,
                                               bool (*keeps)(const std::string& name), UnpackLimit& limit) {
  return Opened(place, limit).files(archive, keeps);
}

}  // namespace gnomon::grade
