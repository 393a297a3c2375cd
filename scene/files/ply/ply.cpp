// PLY models (Turk 1994), text and both binary encodings. They have vertices with positions, and normals and texture
// coordinates where they have them (v is turned over), colours, and faces of any number of corners.
#include <fmt/core.h>

#include <array>
#include <filesystem>

#include "scene/files/formats.h"
#include "scene/files/ply/ply_header.h"
#include "scene/files/ply/ply_regular.h"
#include "scene/files/polygon.h"
#include "scene/files/read_file.h"
#include "scene/files/validate.h"

namespace gnomon {
namespace {

// Reads one number after the other. What goes wrong is kept, with the place of the last number.
class NumberStream {
 public:
  NumberStream(std::string_view bytes, std::size_t begin, PlyEncoding encoding)
      : bytes_(bytes), at_(begin), encoding_(encoding) {}

  /// The next number; none at the end of the data or when it is not one (see `problem`).
  std::optional<double> next(PlyType type) {
    return encoding_ == PlyEncoding::ascii ? next_text() : next_binary(type);
  }
  const std::string& problem() const { return problem_; }
  std::size_t remaining() const { return bytes_.size() - at_; }
  std::string_view rest() const { return bytes_.substr(at_); }
  void skip(std::size_t bytes) { at_ += bytes; }

  /// Line and column of the last number; no line in binary data.
  LineColumn place() const {
    return encoding_ == PlyEncoding::ascii ? line_column(bytes_, last_) : LineColumn{0, 0};
  }

 private:
  std::optional<double> next_text() {
    const std::size_t begin = bytes_.find_first_not_of(" \t\r\n", at_);
    last_ = std::min(begin, bytes_.size());
    if (begin == std::string_view::npos) return missing();
    const std::size_t end = std::min(bytes_.find_first_of(" \t\r\n", begin), bytes_.size());
    const std::string_view word = bytes_.substr(begin, end - begin);
    at_ = end;
    if (const auto value = parse_decimal(word)) return value;
    problem_ = fmt::format("not a finite number (got {})", printable(word));
    return std::nullopt;
  }

  std::optional<double> next_binary(PlyType type) {
    const std::size_t size = byte_size(type);
    if (remaining() < size) return missing();
    const double value = ply_number(type, bytes_.data() + at_, bytes_reversed(encoding_));
    at_ += size;
    return value;
  }

  std::optional<double> missing() {
    problem_ = "the data ends in the middle";
    return std::nullopt;
  }

  std::string_view bytes_;
  std::size_t at_, last_ = 0;
  PlyEncoding encoding_;
  std::string problem_;
};

VertexSlot slot_of(std::string_view name) {
  if (name == "x") return VertexSlot::x;
  if (name == "y") return VertexSlot::y;
  if (name == "z") return VertexSlot::z;
  if (name == "nx") return VertexSlot::nx;
  if (name == "ny") return VertexSlot::ny;
  if (name == "nz") return VertexSlot::nz;
  if (name == "u" || name == "s" || name == "texture_u") return VertexSlot::u;
  if (name == "v" || name == "t" || name == "texture_v") return VertexSlot::v;
  if (name == "red" || name == "diffuse_red") return VertexSlot::red;
  if (name == "green" || name == "diffuse_green") return VertexSlot::green;
  if (name == "blue" || name == "diffuse_blue") return VertexSlot::blue;
  if (name == "alpha") return VertexSlot::alpha;
  return VertexSlot::other;
}

/// What full strength is stored as: 1 of floats; of whole numbers 255, but for those of 16 bits.
double full_strength(PlyType type) {
  if (type == PlyType::float32 || type == PlyType::float64) return 1.0;
  return type == PlyType::uint16 || type == PlyType::int16 ? 65535.0 : 255.0;
}

class PlyReader {
 public:
  PlyReader(std::string_view bytes, const std::string& file, const PlyHeader& header)
      : file_(file), header_(header), numbers_(bytes, header.data_begin, header.encoding) {}

  Expected<LoadedFile> run() {
    for (const PlyElement& element : header_.elements) {
      Expected<void> done;
      if (element.name == "vertex")
        done = read_vertices(element);
      else if (element.name == "face")
        done = read_faces(element);
      else if (element.name == "tristrips")
        done = read_strips(element);
      else
        done = skip(element);
      if (!done) return fail(done.error());
    }
    if (const auto checked = check_indices(); !checked) return fail(checked.error());
    if (faces_.empty() && mesh_.triangles.empty())
      return fail(Error{ErrorKind::bad_input, "the file has no triangles", file_});
    triangulate();
    if (numbers_.remaining() > 0 && header_.encoding != PlyEncoding::ascii)
      loaded_.scene.notes.push_back(
          fmt::format("{} byte(s) after the last element were not read.", numbers_.remaining()));
    return finish();
  }

 private:
  tl::unexpected<Error> error(std::string reason, std::string field) const {
    const LineColumn at = numbers_.place();
    return fail(Error{ErrorKind::bad_input, std::move(reason), file_, at.line, at.column, std::move(field)});
  }

  Expected<double> number(PlyType type, const PlyElement& element, std::uint64_t index,
                          const PlyProperty& property) {
    const auto value = numbers_.next(type);
    if (value) return *value;
    return error(numbers_.problem(), fmt::format("{}[{}].{}", element.name, index, property.name));
  }

  Expected<void> read_vertices(const PlyElement& element) {
    if (!mesh_.positions.empty()) return error("a second vertex element", "vertex");
    VertexLayout layout;
    for (const PlyProperty& p : element.properties)
      layout.slots.push_back(p.is_list ? VertexSlot::other : slot_of(p.name));
    const auto has = [&](VertexSlot slot) {
      return std::find(layout.slots.begin(), layout.slots.end(), slot) != layout.slots.end();
    };
    if (!has(VertexSlot::x) || !has(VertexSlot::y) || !has(VertexSlot::z))
      return fail(Error{ErrorKind::bad_input, "vertices need the properties x, y and z", file_, element.line,
                        1, "vertex"});
    layout.has_normals = has(VertexSlot::nx) && has(VertexSlot::ny) && has(VertexSlot::nz);
    layout.has_uvs = has(VertexSlot::u) && has(VertexSlot::v);
    layout.has_colors = has(VertexSlot::red) && has(VertexSlot::green) && has(VertexSlot::blue);
    if (!has(VertexSlot::alpha)) layout.color_scale[3] = 0.0;
    for (std::size_t p = 0; p < layout.slots.size(); ++p)
      if (layout.slots[p] >= VertexSlot::red && layout.slots[p] <= VertexSlot::alpha)
        layout.color_scale[static_cast<std::size_t>(layout.slots[p]) - 8] =
            full_strength(element.properties[p].type);
    if (const std::size_t read =
            read_regular_vertices(numbers_.rest(), element, header_.encoding, layout, mesh_);
        read > 0) {
      numbers_.skip(read);
      return {};
    }
    size_vertices(mesh_, layout, element.count);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      VertexNumbers numbers{};
      if (auto read = read_vertex(element, i, layout.slots, numbers); !read) return read;
      store_vertex(mesh_, layout, i, numbers);
    }
    return {};
  }

  Expected<void> read_vertex(const PlyElement& element, std::uint64_t index,
                             const std::vector<VertexSlot>& slots, VertexNumbers& values) {
    for (std::size_t p = 0; p < slots.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      if (property.is_list) {
        if (auto skipped = skip_list(element, index, property); !skipped) return skipped;
        continue;
      }
      const auto value = number(property.type, element, index, property);
      if (!value) return fail(value.error());
      if (!is_vertex_number(slots[p], *value))
        return error(
            fmt::format("coordinate (got {:g}, allowed up to {:g} in magnitude)", *value, max_coordinate),
            fmt::format("{}[{}].{}", element.name, index, property.name));
      values[static_cast<std::size_t>(slots[p])] = *value;
    }
    return {};
  }

  Expected<std::uint64_t> list_length(const PlyElement& element, std::uint64_t index,
                                      const PlyProperty& property) {
    const auto value = number(property.length_type, element, index, property);
    if (!value) return fail(value.error());
    const std::size_t each = header_.encoding == PlyEncoding::ascii ? 2 : byte_size(property.type);
    const auto fit = (numbers_.remaining() + 1) / each;
    const auto most = static_cast<double>(fit);
    if (!(*value >= 0.0) || *value > most || std::trunc(*value) != *value)
      return error(
          fmt::format("list length (got {:g}, allowed 0 to the {:g} that the data holds)", *value, most),
          fmt::format("{}[{}].{}", element.name, index, property.name));
    return static_cast<std::uint64_t>(*value);
  }

  Expected<void> skip_list(const PlyElement& element, std::uint64_t index, const PlyProperty& property) {
    const auto length = list_length(element, index, property);
    if (!length) return fail(length.error());
    for (std::uint64_t i = 0; i < *length; ++i)
      if (const auto value = number(property.type, element, index, property); !value)
        return fail(value.error());
    return {};
  }

  Expected<void> skip_property(const PlyElement& element, std::uint64_t index, const PlyProperty& property) {
    if (property.is_list) return skip_list(element, index, property);
    const auto value = number(property.type, element, index, property);
    if (!value) return fail(value.error());
    return {};
  }

  Expected<void> skip(const PlyElement& element) {
    loaded_.scene.notes.push_back(
        fmt::format("{} element(s) '{}' were skipped.", element.count, printable(element.name)));
    for (std::uint64_t i = 0; i < element.count; ++i)
      for (const PlyProperty& property : element.properties)
        if (auto skipped = skip_property(element, i, property); !skipped) return skipped;
    return {};
  }

  static bool is_corner_list(const PlyProperty& p) {
    return p.is_list && (p.name == "vertex_indices" || p.name == "vertex_index");
  }

  Expected<void> read_faces(const PlyElement& element) {
    if (std::none_of(element.properties.begin(), element.properties.end(), is_corner_list))
      return fail(
          Error{ErrorKind::bad_input, "faces need the list vertex_indices", file_, element.line, 1, "face"});
    if (faces_.empty() && small_faces_ == 0 && mesh_.triangles.empty())
      if (const std::size_t read = read_regular_faces(numbers_.rest(), element, header_.encoding, mesh_);
          read > 0) {
        numbers_.skip(read);
        return {};
      }
    for (std::uint64_t i = 0; i < element.count; ++i) {
      for (const PlyProperty& property : element.properties) {
        auto read = is_corner_list(property) ? read_corners(element, i, property)
                                             : skip_property(element, i, property);
        if (!read) return read;
      }
    }
    return {};
  }

  Expected<std::uint32_t> corner_of(double value, const PlyElement& element, std::uint64_t index,
                                    const PlyProperty& property) const {
    if (!(value >= 0.0) || value > 4294967295.0 || std::trunc(value) != value)
      return error(fmt::format("vertex index (got {:g}, allowed a whole number from 0)", value),
                   fmt::format("{}[{}].{}", element.name, index, property.name));
    return static_cast<std::uint32_t>(value);
  }

  Expected<void> read_corners(const PlyElement& element, std::uint64_t index, const PlyProperty& property) {
    const auto length = list_length(element, index, property);
    if (!length) return fail(length.error());
    if (*length > max_polygon_corners)
      return error(fmt::format("too many corners (got {}, allowed 3 to {})", *length, max_polygon_corners),
                   fmt::format("{}[{}].{}", element.name, index, property.name));
    Face face{corners_.size(), *length, index};
    for (std::uint64_t i = 0; i < *length; ++i) {
      const auto value = number(property.type, element, index, property);
      if (!value) return fail(value.error());
      const auto corner = corner_of(*value, element, index, property);
      if (!corner) return fail(corner.error());
      corners_.push_back(*corner);
    }
    if (*length < 3)
      ++small_faces_;
    else
      faces_.push_back(face);
    return {};
  }

  /// Strips of triangles, in one list or in several; -1 ends a strip.
  Expected<void> read_strips(const PlyElement& element) {
    for (std::uint64_t i = 0; i < element.count; ++i)
      for (const PlyProperty& property : element.properties) {
        auto read =
            is_corner_list(property) ? read_strip(element, i, property) : skip_property(element, i, property);
        if (!read) return read;
      }
    return {};
  }

  Expected<void> read_strip(const PlyElement& element, std::uint64_t index, const PlyProperty& property) {
    const auto length = list_length(element, index, property);
    if (!length) return fail(length.error());
    std::array<std::uint32_t, 2> before{};
    std::size_t known = 0;  // corners of this strip
    for (std::uint64_t i = 0; i < *length; ++i) {
      const auto value = number(property.type, element, index, property);
      if (!value) return fail(value.error());
      if (*value == -1.0) {
        known = 0;
        continue;
      }
      const auto corner = corner_of(*value, element, index, property);
      if (!corner) return fail(corner.error());
      const auto [a, b] = before;
      if (known++ >= 2 && a != b && b != *corner && a != *corner) {
        faces_.push_back({corners_.size(), 3, index});
        // Every other one runs the other way round.
        corners_.insert(corners_.end(), {known % 2 != 0 ? a : b, known % 2 != 0 ? b : a, *corner});
      }
      before = {b, *corner};
    }
    return {};
  }

  // Faces may come before the vertices, so their indices are checked at the end.
  Expected<void> check_indices() const {
    for (const Face& face : faces_) {
      for (std::size_t i = 0; i < face.corners; ++i) {
        const std::uint32_t corner = corners_[face.begin + i];
        if (corner >= mesh_.positions.size())
          return fail(Error{ErrorKind::bad_input,
                            fmt::format("vertex index out of range (got {}, allowed 0 to {})", corner,
                                        static_cast<std::int64_t>(mesh_.positions.size()) - 1),
                            file_, 0, 0, fmt::format("face[{}]", face.number)});
      }
    }
    return {};
  }

  void triangulate() {
    std::vector<Vec3> positions;
    for (const Face& face : faces_) {
      const std::span<const std::uint32_t> corners(&corners_[face.begin], face.corners);
      positions.clear();
      for (const std::uint32_t c : corners) positions.push_back(mesh_.positions[c]);
      for (const auto& t : triangulate_polygon(positions))
        mesh_.triangles.push_back({corners[t[0]], corners[t[1]], corners[t[2]]});
    }
  }

  LoadedFile finish() {
    Scene& scene = loaded_.scene;
    if (small_faces_ > 0)
      scene.notes.push_back(
          fmt::format("{} face(s) with fewer than three corners were skipped.", small_faces_));
    if (!header_.texture.empty())
      scene.notes.push_back(fmt::format("The texture {} is not read; the model's plain colour is used.",
                                        printable(header_.texture, 80)));
    loaded_.is_model = true;
    mesh_.name = std::filesystem::path(file_).stem().string();
    scene.materials.push_back(model_material("default", !mesh_.colors.empty()));
    scene.instances.push_back({mesh_.name, 0, Mat4(1.0), 0});
    scene.meshes.push_back(std::move(mesh_));
    return std::move(loaded_);
  }

  struct Face {
    std::size_t begin;
    std::uint64_t corners;
    std::uint64_t number;
  };

  const std::string& file_;
  const PlyHeader& header_;
  NumberStream numbers_;
  LoadedFile loaded_;
  Mesh mesh_;
  std::vector<std::uint32_t> corners_;
  std::vector<Face> faces_;
  std::size_t small_faces_ = 0;
};

}  // namespace

Expected<LoadedFile> read_ply(std::string_view bytes, const std::string& file) {
  bytes = without_byte_order_mark(bytes);
  const auto header = read_ply_header(bytes, file);
  if (!header) return fail(header.error());
  return PlyReader(bytes, file, *header).run();
}

}  // namespace gnomon
