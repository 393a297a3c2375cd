#include "scene/files/gltf/gltf_data.h"

#include <fmt/core.h>
#include <meshoptimizer.h>

#include <cmath>
#include <cstdint>
#include <optional>

#include "scene/files/gltf/gltf_value.h"
#include "scene/files/read_file.h"

namespace gnomon {
namespace {

enum class Mode : std::uint8_t { attributes, triangles, indices };
enum class Filter : std::uint8_t { none, octahedral, quaternion, exponential };

struct Packed {
  Mode mode = Mode::attributes;
  Filter filter = Filter::none;
  std::size_t stride = 0, count = 0;
  std::string_view bytes;
};

tl::unexpected<Error> refuse(std::string reason) {
  return fail(ErrorKind::bad_input, std::move(reason));
}

/// A whole number from 0 to 2^32; none where it is something else.
std::optional<std::size_t> whole(const JsonValue& object, std::string_view key, double otherwise) {
  const double value = number_of(&object, key, otherwise);
  if (!(value >= 0.0 && value <= 4294967296.0) || value != std::floor(value)) return std::nullopt;
  return static_cast<std::size_t>(value);
}

template <class Choice>
std::optional<Choice> choice(const JsonValue& object, std::string_view key,
                             std::initializer_list<std::string_view> names, std::string_view otherwise) {
  const JsonValue* value = member(&object, key);
  const std::string_view name = value == nullptr ? otherwise : std::string_view(value->text);
  std::uint8_t index = 0;
  for (const std::string_view known : names) {
    if (known == name) return static_cast<Choice>(index);
    ++index;
  }
  return std::nullopt;
}

Expected<Packed> read(const JsonValue& extension, std::span<const std::string_view> buffers) {
  const auto mode = choice<Mode>(extension, "mode", {"ATTRIBUTES", "TRIANGLES", "INDICES"}, "");
  if (!mode) return refuse("mode is missing or unknown (allowed ATTRIBUTES, TRIANGLES, INDICES)");
  const auto filter =
      choice<Filter>(extension, "filter", {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"}, "NONE");
  if (!filter) return refuse("filter is unknown (allowed NONE, OCTAHEDRAL, QUATERNION, EXPONENTIAL)");
  const auto buffer = whole(extension, "buffer", -1.0);
  if (!buffer || *buffer >= buffers.size())
    return refuse(fmt::format("there is no such buffer (allowed 0 to {})", buffers.size()));
  const auto offset = whole(extension, "byteOffset", 0.0), length = whole(extension, "byteLength", -1.0);
  const auto stride = whole(extension, "byteStride", -1.0), count = whole(extension, "count", -1.0);
  if (!offset || !length || !stride || !count)
    return refuse("byteOffset, byteLength, byteStride and count must be whole numbers up to 2^32");
  if (*offset + *length > buffers[*buffer].size())
    return refuse(fmt::format("reaches past its buffer (got bytes up to {}, allowed up to {})",
                              *offset + *length, buffers[*buffer].size()));
  return Packed{*mode, *filter, *stride, *count, buffers[*buffer].substr(*offset, *length)};
}

/// The extension's own rules, which the decoder relies on.
Expected<void> check(const Packed& packed, double byte_length) {
  const std::size_t stride = packed.stride;
  const bool attributes = packed.mode == Mode::attributes;
  const bool fits = attributes ? stride % 4 == 0 && stride >= 4 && stride <= 256 : stride == 2 || stride == 4;
  if (!fits)
    return refuse(fmt::format("byteStride (got {}, allowed {})", stride,
                              attributes ? "multiples of 4 from 4 to 256" : "2 and 4"));
  if (packed.mode == Mode::triangles && packed.count % 3 != 0)
    return refuse(fmt::format("count (got {}, allowed multiples of 3)", packed.count));
  const bool filtered =
      packed.filter == Filter::none || (attributes && (packed.filter == Filter::exponential || stride == 8 ||
                                                       (packed.filter == Filter::octahedral && stride == 4)));
  if (!filtered) return refuse(fmt::format("the filter does not go with a byteStride of {}", stride));
  const std::size_t size = packed.count * stride;
  if (static_cast<double>(size) != byte_length)
    return refuse(fmt::format("count times byteStride is not the view's byteLength (got {}, allowed {:.0f})",
                              size, byte_length));
  // Attributes take two bits for sixteen bytes that do not change; a triangle and an index take a byte.
  constexpr std::size_t most_per_byte = 64;
  if (size / most_per_byte > packed.bytes.size())
    return refuse(fmt::format("{} bytes cannot hold {}", packed.bytes.size(), size));
  return {};
}

int decode(const Packed& packed, char* out) {
  const auto* from = reinterpret_cast<const unsigned char*>(packed.bytes.data());
  const std::size_t size = packed.bytes.size();
  if (packed.mode == Mode::attributes)
    return meshopt_decodeVertexBuffer(out, packed.count, packed.stride, from, size);
  if (packed.mode == Mode::triangles)
    return meshopt_decodeIndexBuffer(out, packed.count, packed.stride, from, size);
  return meshopt_decodeIndexSequence(out, packed.count, packed.stride, from, size);
}

void undo_filter(const Packed& packed, char* out) {
  if (packed.filter == Filter::octahedral) meshopt_decodeFilterOct(out, packed.count, packed.stride);
  if (packed.filter == Filter::quaternion) meshopt_decodeFilterQuat(out, packed.count, packed.stride);
  if (packed.filter == Filter::exponential) meshopt_decodeFilterExp(out, packed.count, packed.stride);
}

}  // namespace

Expected<std::vector<char>> unpack_meshopt(const JsonValue& extension,
                                           std::span<const std::string_view> buffers, double byte_length) {
  const auto packed = read(extension, buffers);
  if (!packed) return fail(packed.error());
  if (const auto sound = check(*packed, byte_length); !sound) return fail(sound.error());
  std::vector<char> out(packed->count * packed->stride);
  if (packed->count == 0) return out;
  if (decode(*packed, out.data()) != 0) return refuse("the packed data is damaged");
  undo_filter(*packed, out.data());
  return out;
}

}  // namespace gnomon
