#include "scene/files/gltf/gltf_data.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>

namespace gnomon {
namespace {

constexpr std::size_t header_size = 12;
constexpr std::size_t chunk_header_size = 8;
constexpr std::uint32_t json_type = 0x4e4f534a;
constexpr std::uint32_t binary_type = 0x004e4942;

std::uint32_t word(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i)
    value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  return value;
}

tl::unexpected<Error> container_error(const std::string& file, std::string field, std::string reason) {
  return fail(Error{ErrorKind::bad_input, std::move(reason), file, 0, 0, std::move(field)});
}

}  // namespace

bool is_glb(std::string_view bytes) {
  return bytes.starts_with("glTF");
}

Expected<GlbChunks> read_glb(std::string_view bytes, const std::string& file) {
  if (!is_glb(bytes)) return container_error(file, "magic", "not a GLB file (it must start with \"glTF\")");
  if (bytes.size() < header_size + chunk_header_size)
    return container_error(file, "header",
                           fmt::format("the file is cut off (got {} bytes, allowed {} or more)", bytes.size(),
                                       header_size + chunk_header_size));
  if (word(bytes, 4) != 2)
    return container_error(file, "version",
                           fmt::format("unknown version (got {}, allowed 2)", word(bytes, 4)));
  if (word(bytes, 8) > bytes.size())
    return container_error(
        file, "length",
        fmt::format("more than the file has (got {}, allowed up to {})", word(bytes, 8), bytes.size()));
  bytes = bytes.substr(0, std::max<std::size_t>(word(bytes, 8), header_size + chunk_header_size));
  GlbChunks chunks;
  std::size_t index = 0;
  for (std::size_t at = header_size; at < bytes.size(); ++index) {
    const std::string field = fmt::format("chunks[{}]", index);
    if (bytes.size() - at < chunk_header_size)
      return container_error(file, field, "the chunk's header is cut off");
    const std::uint32_t length = word(bytes, at);
    const std::uint32_t type = word(bytes, at + 4);
    at += chunk_header_size;
    if (length > bytes.size() - at)
      return container_error(
          file, field,
          fmt::format("the chunk is cut off (got {} bytes, allowed {})", length, bytes.size() - at));
    if (index == 0 && type != json_type) return container_error(file, field, "the first chunk is not JSON");
    if (index == 0) chunks.json = bytes.substr(at, length);
    if (index == 1 && type == binary_type) chunks.binary = bytes.substr(at, length);
    at += length;
  }
  return chunks;
}

}  // namespace gnomon
