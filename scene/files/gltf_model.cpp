#include "scene/files/gltf_model.h"

#include <algorithm>
#include <array>

#include "scene/files/gltf_data.h"

namespace gnomon {
namespace {

constexpr std::array<std::string_view, 4> read_elsewhere{"buffers", "images", "skins", "animations"};

std::string one_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text.empty() ? "unknown reason" : text;
}

/// Bytes [begin, end) of the JSON text become `text`.
struct Edit {
  std::size_t begin, end;
  std::string_view text;
};

/// 3.0 becomes 3, which tinygltf insists on where glTF asks for an integer, and which JSON does not tell apart.
void write_whole(const JsonDocument& document, const JsonValue& value, std::vector<Edit>& edits) {
  for (const JsonValue& item : value.items) write_whole(document, item, edits);
  for (const JsonMember& member : value.members) write_whole(document, member.value, edits);
  if (value.type != JsonValue::Type::number || value.whole) return;
  const std::string_view written =
      std::string_view(document.text).substr(value.begin, value.end - value.begin);
  const std::size_t point = written.find('.');
  if (point != std::string_view::npos && written.find_first_not_of('0', point + 1) == std::string_view::npos)
    edits.push_back({value.begin, value.end, written.substr(0, point)});
}

bool has_no_view(const JsonValue& accessor) {
  return accessor.type == JsonValue::Type::object && accessor.find("bufferView") == nullptr;
}

/// Those lists are empty, whole numbers have no point, and every accessor has a view: tinygltf insists on that for indices, which Draco
/// brings without one.
std::string outline(const JsonDocument& document) {
  std::vector<Edit> edits;
  for (const JsonMember& member : document.root.members)
    if (std::find(read_elsewhere.begin(), read_elsewhere.end(), member.key) != read_elsewhere.end())
      edits.push_back({member.value.begin, member.value.end, "[]"});
    else
      write_whole(document, member.value, edits);
  if (!gltf_list(document.root, "bufferViews").empty())
    for (const JsonValue& accessor : gltf_list(document.root, "accessors"))
      if (has_no_view(accessor))
        edits.push_back({accessor.begin + 1, accessor.begin + 1, "\"bufferView\":0,"});
  std::sort(edits.begin(), edits.end(), [](const Edit& a, const Edit& b) { return a.begin < b.begin; });
  std::string text;
  std::size_t at = 0;
  for (const Edit& edit : edits) {
    text.append(document.text, at, edit.begin - at).append(edit.text);
    at = edit.end;
  }
  return text.append(document.text, at);
}

}  // namespace

Expected<tinygltf::Model> parse_gltf(const CheckedGltf& checked) {
  const std::string text = outline(checked.document);
  tinygltf::Model model;
  tinygltf::TinyGLTF loader;
  std::string errors, warnings;
  const auto length = static_cast<unsigned int>(text.size());
  const bool done = loader.LoadASCIIFromString(&model, &errors, &warnings, text.data(), length, "");
  if (!done || !errors.empty())
    return fail(Error{ErrorKind::bad_input, one_line(errors), checked.document.file, 0, 0, ""});
  const std::vector<JsonValue>& accessors = gltf_list(checked.document.root, "accessors");
  for (std::size_t i = 0; i < model.accessors.size(); ++i)
    if (has_no_view(accessors[i])) model.accessors[i].bufferView = -1;
  return model;
}

}  // namespace gnomon
