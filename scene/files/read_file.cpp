#include "scene/files/read_file.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "scene/base/expected.h"
#include "scene/base/interrupted.h"
#include "scene/files/path_status.h"
#include "scene/files/write_file.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;

tl::unexpected<Error> cannot_read(const std::string& path, std::string reason) {
  Error error{ErrorKind::bad_input, std::move(reason)};
  error.file = path;
  return fail(std::move(error));
}

}  // namespace

Expected<std::string> read_file(const std::string& path) {
  const auto size = size_of_file(path);
  if (!size) return fail(size.error());
  const Descriptor file(
      uninterrupted([&] { return ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK); }));
  if (file.number() < 0) return failed_call(ErrorKind::bad_input, path, "cannot be opened", errno);
  std::string bytes(*size, '\0');
  std::size_t count = 0;
  while (count < bytes.size()) {
    const ssize_t got =
        uninterrupted([&] { return ::read(file.number(), bytes.data() + count, bytes.size() - count); });
    if (got <= 0)
      return cannot_read(path, fmt::format("could be read only up to byte {} of {}", count, *size));
    count += static_cast<std::size_t>(got);
  }
  return bytes;
}

std::string lower_extension(const std::string& path) {
  std::string extension = fs::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

std::string folder_of(const std::string& path) {
  const std::string folder = fs::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

Expected<std::string> resolve_path(const std::string& folder, const std::string& named,
                                   const LoadOptions& options) {
  const fs::path joined = (fs::path(folder) / named).lexically_normal();
  if (options.files != nullptr) options.files->push_back(joined.string());
  if (!options.confine_paths) return joined.string();
  std::error_code error;
  // A file that is not there has a canonical path only from its absolute one.
  const auto real = [&](const fs::path& path) {
    return fs::weakly_canonical(fs::absolute(path, error), error);
  };
  const std::string& top = options.root.empty() ? folder : options.root;
  const fs::path relative = real(joined).lexically_relative(real(top.empty() ? "." : top));
  if (error || relative.empty() || *relative.begin() == "..")
    return fail(ErrorKind::bad_input,
                fmt::format("the file is outside the scene's folder (got \"{}\", allowed "
                            "paths inside the folder, or any with --allow-outside)",
                            printable(named)));
  return joined.string();
}

std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view mark = "\xef\xbb\xbf";
  return text.starts_with(mark) ? text.substr(mark.size()) : text;
}

LineColumn line_column(std::string_view text, std::size_t offset) {
  LineColumn at;
  offset = std::min(offset, text.size());
  std::size_t line_start = 0;
  for (std::size_t i = 0; i < offset; ++i) {
    if (text[i] != '\n') continue;
    ++at.line;
    line_start = i + 1;
  }
  for (std::size_t i = line_start; i < offset; ++i)
    if ((static_cast<unsigned char>(text[i]) & 0xc0u) != 0x80u) ++at.column;  // not a continuation byte
  return at;
}

std::optional<double> parse_decimal(std::string_view word) {
  if (word.starts_with('+')) {
    word.remove_prefix(1);
    if (word.starts_with('-')) return std::nullopt;
  }
  double value = 0.0;
  const char* const last = word.data() + word.size();
  const auto [end, status] = std::from_chars(word.data(), last, value);
  if (end != last || word.empty()) return std::nullopt;
  if (status == std::errc() && std::isfinite(value)) return value;
  if (status != std::errc::result_out_of_range) return std::nullopt;
  // from_chars does not say on which side: only a negative exponent, or a fraction alone, is too small.
  const std::size_t exponent = word.find_first_of("eE");
  if (exponent != std::string_view::npos)
    return word[exponent + 1] == '-' ? std::optional(0.0) : std::nullopt;
  return word.find_first_of("123456789") > word.find('.') ? std::optional(0.0) : std::nullopt;
}

std::string printable(std::string_view text) {
  return printable(text, 40);
}

std::string printable(std::string_view text, std::size_t longest) {
  if (text.size() <= longest) return one_line(text);
  while (longest > 0 && (static_cast<unsigned char>(text[longest]) & 0xc0u) == 0x80u)
    --longest;  // inside a character
  return one_line(text.substr(0, longest)) + "...";
}

}  // namespace gnomon
