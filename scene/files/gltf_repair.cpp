#include "scene/files/gltf_repair.h"

#include <algorithm>
#include <filesystem>
#include <vector>

#include "scene/files/gltf_container.h"
#include "scene/files/read_file.h"

namespace gnomon {
namespace {

/// Bytes [begin, end) of the JSON text become `text`.
struct Edit {
  std::size_t begin, end;
  std::string text;
};

/// Of a data URI, when it is base64; its last characters may be padding.
std::optional<double> data_uri_bytes(std::string_view uri) {
  const std::size_t comma = uri.find(";base64,");
  if (!uri.starts_with("data:") || comma == std::string_view::npos) return std::nullopt;
  const std::string_view code = uri.substr(comma + 8);
  const auto padding = static_cast<std::size_t>(
      std::count(code.end() - std::min<std::ptrdiff_t>(2, std::ssize(code)), code.end(), '='));
  return static_cast<double>(code.size() / 4 * 3 - std::min(padding, code.size()));
}

std::optional<double> buffer_bytes(const JsonValue& buffer, const std::string& folder,
                                   const LoadOptions& options) {
  const JsonMember* uri = buffer.find("uri");
  if (uri == nullptr || uri->value.type != JsonValue::Type::string) return std::nullopt;
  if (uri->value.text.starts_with("data:")) return data_uri_bytes(uri->value.text);
  const auto path = resolve_path(folder, uri->value.text, options);
  std::error_code error;
  const auto size = path ? std::filesystem::file_size(*path, error) : 0;
  return path && !error ? std::optional(static_cast<double>(size)) : std::nullopt;
}

const std::vector<JsonValue>& list(const JsonValue& root, std::string_view key) {
  static const std::vector<JsonValue> none;
  const JsonMember* found = root.find(key);
  return found == nullptr ? none : found->value.items;
}

std::vector<Edit> edits_of(const JsonValue& root, const std::string& folder, const LoadOptions& options) {
  std::vector<Edit> edits;
  for (const JsonValue& buffer : list(root, "buffers")) {
    const JsonMember* length = buffer.find("byteLength");
    const auto bytes = buffer_bytes(buffer, folder, options);
    if (length != nullptr && bytes && *bytes > length->value.number)
      edits.push_back(
          {length->value.begin, length->value.end, std::to_string(static_cast<std::uint64_t>(*bytes))});
  }
  if (list(root, "accessors").empty()) return edits;
  for (const JsonValue& skin : list(root, "skins"))
    if (skin.type == JsonValue::Type::object && !skin.members.empty() && !skin.find("inverseBindMatrices"))
      edits.push_back({skin.begin + 1, skin.begin + 1, "\"inverseBindMatrices\":0,"});
  std::sort(edits.begin(), edits.end(), [](const Edit& a, const Edit& b) { return a.begin > b.begin; });
  return edits;
}

}  // namespace

std::optional<std::string> repaired_gltf(const CheckedGltf& checked, std::string_view bytes,
                                         const std::string& folder, const LoadOptions& options) {
  LoadOptions unlogged = options;  // tinygltf asks for the files again
  unlogged.files = nullptr;
  const std::vector<Edit> edits = edits_of(checked.document.root, folder, unlogged);
  if (edits.empty()) return std::nullopt;
  std::string text = checked.document.text;
  for (const Edit& edit : edits) text.replace(edit.begin, edit.end - edit.begin, edit.text);
  return checked.is_binary ? with_json(bytes, text) : text;
}

}  // namespace gnomon
