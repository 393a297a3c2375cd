#include "scene/files/gltf/gltf_data.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstdint>

#include "scene/base/parallel.h"
#include "scene/files/encodings.h"
#include "scene/files/gltf/gltf_value.h"
#include "scene/files/path_status.h"
#include "scene/files/read_file.h"

namespace gnomon {
namespace {

/// RFC 3986, section 2.1.
std::string decode_percent(std::string_view uri) {
  std::string out;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const int high = uri[i] == '%' && i + 2 < uri.size() ? hex_digit(uri[i + 1]) : -1;
    const int low = high >= 0 ? hex_digit(uri[i + 2]) : -1;
    out += low >= 0 ? static_cast<char>(high * 16 + low) : uri[i];
    if (low >= 0) i += 2;
  }
  return out;
}

/// Data URIs' contents are not for messages.
std::string shown(const std::string& uri) {
  return uri.starts_with("data:") ? "data:..." : printable(uri);
}

/// Two extensions of one format, but for the newer one's later versions of it, which are refused.
constexpr std::array<std::string_view, 2> meshopt_names{"EXT_meshopt_compression", "KHR_meshopt_compression"};

std::string_view meshopt_name_of(const JsonValue& object) {
  const JsonValue* extensions = member(&object, "extensions");
  const auto found = std::find_if(meshopt_names.begin(), meshopt_names.end(),
                                  [&](std::string_view name) { return member(extensions, name) != nullptr; });
  return found == meshopt_names.end() ? std::string_view() : *found;
}
const JsonValue* meshopt_of(const JsonValue& object) {
  return member(member(&object, "extensions"), meshopt_name_of(object));
}

}  // namespace

Expected<GltfData> GltfData::open(const GltfDocument& document, std::string_view bytes,
                                  const std::string& folder, const LoadOptions& options) {
  GltfData out(document, bytes, folder, options);
  out.images_.resize(gltf_list(document.json.root, "images").size());
  if (const auto opened = out.open_buffers(); !opened) return fail(opened.error());
  if (const auto opened = out.open_views(); !opened) return fail(opened.error());
  return out;
}

tl::unexpected<Error> GltfData::error(std::string field, std::string reason) const {
  return fail(Error{ErrorKind::bad_input, std::move(reason), document_->json.file, 0, 0, std::move(field)});
}

Expected<std::string_view> GltfData::open_uri(const std::string& uri, const std::string& field) {
  if (uri.starts_with("data:")) {
    const std::size_t comma = uri.find(";base64,");
    auto bytes =
        comma == std::string::npos ? std::nullopt : from_base64(std::string_view(uri).substr(comma + 8));
    if (!bytes) return error(field, "the data URI is not base64");
    const std::vector<char>& kept = decoded_.emplace_back(std::move(*bytes));
    return std::string_view(kept.data(), kept.size());
  }
  const auto path = resolve_path(folder_, decode_percent(uri), *options_);
  if (!path) return error(field, path.error().reason);
  auto file = MappedFile::open(*path);
  if (!file) return error(field, fmt::format("{} (got \"{}\")", file.error().reason, shown(uri)));
  return files_.emplace_back(std::move(*file)).bytes();
}

/// Empty for one whose data an extension brings.
Expected<std::string_view> GltfData::open_buffer(std::size_t index) {
  const JsonValue& buffer = gltf_list(document_->json.root, "buffers")[index];
  const std::string field = fmt::format("buffers[{}]", index);
  const auto length = static_cast<std::size_t>(number_of(&buffer, "byteLength", 0.0));
  const std::string uri = text_of(&buffer, "uri");
  std::string_view bytes;
  if (!uri.empty()) {
    const auto opened = open_uri(uri, field + ".uri");
    if (!opened) return fail(opened.error());
    bytes = *opened;
  } else if (index == 0 && document_->is_binary) {
    const auto chunks = read_glb(bytes_, document_->json.file);
    if (!chunks) return fail(chunks.error());
    bytes = chunks->binary.value_or(std::string_view());
  } else {  // glTF 2.0, 3.6.1.1: an extension may bring its data
    return std::string_view();
  }
  if (bytes.size() < length)
    return error(field, fmt::format("holds fewer bytes than it says (got {}, allowed {} or more)",
                                    bytes.size(), length));
  return bytes.substr(0, length);
}

Expected<void> GltfData::open_buffers() {
  const std::size_t count = gltf_list(document_->json.root, "buffers").size();
  for (std::size_t i = 0; i < count; ++i) {
    const auto buffer = open_buffer(i);
    if (!buffer) return fail(buffer.error());
    buffers_.push_back(*buffer);
  }
  return {};
}

Expected<void> GltfData::open_views() {
  const std::vector<JsonValue>& views = gltf_list(document_->json.root, "bufferViews");
  std::vector<Expected<std::vector<char>>> unpacked(views.size());
  parallel_for(views.size(), [&](std::size_t i) {
    if (const JsonValue* packed = meshopt_of(views[i]); packed != nullptr)
      unpacked[i] = unpack_meshopt(*packed, buffers_, number_of(&views[i], "byteLength", 0.0));
  });
  for (std::size_t i = 0; i < views.size(); ++i) {
    const std::string field = fmt::format("bufferViews[{}]", i);
    if (!unpacked[i])
      return error(fmt::format("{}.extensions.{}", field, meshopt_name_of(views[i])),
                   unpacked[i].error().reason);
    const auto stride = static_cast<std::size_t>(number_of(&views[i], "byteStride", 0.0));
    if (meshopt_of(views[i]) != nullptr) {
      const std::vector<char>& kept = decoded_.emplace_back(std::move(*unpacked[i]));
      views_.push_back({std::string_view(kept.data(), kept.size()), stride});
      continue;
    }
    const auto from = static_cast<std::size_t>(number_of(&views[i], "buffer", 0.0));
    const auto length = static_cast<std::size_t>(number_of(&views[i], "byteLength", 0.0));
    const auto offset = static_cast<std::size_t>(number_of(&views[i], "byteOffset", 0.0));
    if (length > 0 && buffers_[from].empty()) return error(field, "its buffer has no data");
    views_.push_back({length == 0 ? std::string_view() : buffers_[from].substr(offset, length), stride});
  }
  return {};
}

Expected<GltfImage> GltfData::image(std::size_t index) {
  std::optional<GltfImage>& known = images_[index];
  if (known) return *known;
  const JsonValue& image = gltf_list(document_->json.root, "images")[index];
  const std::string field = fmt::format("images[{}]", index);
  GltfImage out{index, text_of(&image, "name"), text_of(&image, "uri")};
  const bool inside = out.uri.starts_with("data:");
  if (const double from = number_of(&image, "bufferView", -1.0); from >= 0.0) {
    out.bytes = view(static_cast<std::size_t>(from));
  } else if (inside) {
    const auto bytes = open_uri(out.uri, field + ".uri");
    if (!bytes) return fail(bytes.error());
    out.bytes = *bytes;
    out.uri.clear();
  } else if (!out.uri.empty()) {
    const auto path = resolve_path(folder_, decode_percent(out.uri), *options_);
    if (!path) return error(field + ".uri", path.error().reason);
    const auto plain = is_plain_file(*path);
    if (!plain) return error(field + ".uri", plain.error().reason);
    if (*plain) {
      auto file = MappedFile::open(*path);
      if (!file) return error(field + ".uri", file.error().reason);
      out.bytes = files_.emplace_back(std::move(*file)).bytes();
    }
  }
  if (out.name.empty()) out.name = out.uri.empty() ? field : out.uri;
  return known.emplace(std::move(out));
}

std::size_t GltfData::add_view(std::vector<char> bytes) {
  const std::vector<char>& kept = decoded_.emplace_back(std::move(bytes));
  views_.push_back({std::string_view(kept.data(), kept.size())});
  return views_.size() - 1;
}

}  // namespace gnomon
