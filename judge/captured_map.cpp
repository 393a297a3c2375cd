#include "judge/captured_map.h"

#include <fmt/core.h>

#include <algorithm>

#include "judge/capture_pictures.h"
#include "scene/light.h"

namespace gnomon::judge {
namespace {

/// Engines keep matrices as floats: 2^-24 of each entry, some of them sums of a few.
constexpr double matrix_slack = 1e-4;
/// The light's direction, which engines keep in floats and work out again from a target: radians.
constexpr double direction_slack = 2e-3;
constexpr double farthest = 1e12;  ///< of the near depth; what an endless far plane counts for

Vec4 row(const Mat4& m, int i) {
  return {m[0][i], m[1][i], m[2][i], m[3][i]};
}

/// Returns the row as stored: z/w or (z/w + 1)/2, so that both run over [0, 1].
Vec4 stored_row(const Vec4& z, const Vec4& w, StoredDepth convention) {
  return convention_of(convention).halves ? 0.5 * (z + w) : z;
}

bool square(const Vec3& a, const Vec3& b) {
  return std::abs(glm::dot(glm::normalize(a), glm::normalize(b))) < matrix_slack;
}

/// right and up as the matrix has them, forward square to both, and right x up = -forward.
void set_axes(const Vec3& x, const Vec3& y, const Vec3& along, MatrixFace& out) {
  LightFace& face = out.face;
  face.right = glm::normalize(x);
  face.up = glm::normalize(glm::normalize(y) - glm::dot(glm::normalize(y), face.right) * face.right);
  face.forward = glm::cross(face.up, face.right);
  out.mirrored = glm::dot(face.forward, along) < 0.0;
  if (out.mirrored) face.right = -face.right, face.forward = -face.forward;
}

tl::expected<MatrixFace, std::string> orthographic(const Vec4& x, const Vec4& y, const Vec4& s,
                                                   bool reversed) {
  const Vec3 along = reversed ? -Vec3(s) : Vec3(s);
  if (!square(Vec3(x), Vec3(y)) || !square(Vec3(x), along) || !square(Vec3(y), along))
    return tl::unexpected<std::string>("shears: its axes are not square to each other");
  MatrixFace out;
  set_axes(Vec3(x), Vec3(y), along, out);
  LightFace& face = out.face;
  const double a = glm::length(Vec3(x)), b = glm::length(Vec3(y)), c = glm::length(Vec3(s));
  face.half_extent = {1.0 / a, 1.0 / b};
  face.center = {(out.mirrored ? x.w : -x.w) / a, -y.w / b};
  face.near_depth = (reversed ? s.w - 1.0 : -s.w) / c;
  face.far_depth = (reversed ? s.w : 1.0 - s.w) / c;
  return out;
}

tl::expected<MatrixFace, std::string> perspective(const Vec4& x, const Vec4& y, const Vec4& s, const Vec4& w,
                                                  bool reversed) {
  if (!square(Vec3(x), Vec3(y)) || !square(Vec3(x), Vec3(w)) || !square(Vec3(y), Vec3(w)))
    return tl::unexpected<std::string>(
        "is no perspective that is symmetric about its axis; of an atlas the light's own matrix belongs "
        "here, "
        "and map[].rect says which part of the file it fills");
  MatrixFace out;
  out.projection = LightProjection::perspective;
  set_axes(Vec3(x), Vec3(y), Vec3(w), out);
  const Mat3 axes = glm::transpose(Mat3(Vec3(x), Vec3(y), Vec3(w)));
  out.origin = glm::inverse(axes) * -Vec3(x.w, y.w, w.w);
  LightFace& face = out.face;
  const double k = glm::length(Vec3(w));
  face.half_extent = {k / glm::length(Vec3(x)), k / glm::length(Vec3(y))};
  // Stored is a + b / depth.
  const double a = glm::dot(Vec3(s), face.forward) / k;
  const double b = (glm::dot(Vec3(s), out.origin) + s.w) / k;
  if (b == 0.0) return tl::unexpected<std::string>("makes one depth of all places");
  const double at_zero = -b / a, at_one = b / (1.0 - a);
  face.near_depth = reversed ? at_one : at_zero;
  face.far_depth = reversed ? at_zero : at_one;
  const double limit = farthest * face.near_depth;
  if (!(face.near_depth > 0.0)) return tl::unexpected<std::string>("has no near plane before its eye");
  if (!(face.far_depth > 0.0 && face.far_depth < limit)) face.far_depth = limit;
  return out;
}

std::string direction_text(const Vec3& v) {
  return fmt::format("({:.3f}, {:.3f}, {:.3f})", v.x, v.y, v.z);
}

}  // namespace

std::optional<std::string> not_of_light(const MatrixFace& face, std::size_t faces, const Light& light,
                                        const World& world) {
  const bool orthographic = face.projection == LightProjection::orthographic;
  if (orthographic != (light.type == LightType::directional))
    return fmt::format("is {} where light \"{}\" needs {}", orthographic ? "orthographic" : "a perspective",
                       light.name, orthographic ? "a perspective" : "an orthographic one");
  if (orthographic) {
    const double cosine = glm::dot(face.face.forward, light.direction);
    if (std::acos(std::clamp(cosine, -1.0, 1.0)) < direction_slack) return std::nullopt;
    const bool turned = std::acos(std::clamp(-cosine, -1.0, 1.0)) < direction_slack;
    return fmt::format("looks along {}{}, light \"{}\" shines along {}", direction_text(face.face.forward),
                       turned ? " (against the light: the sign of its direction, or of z)" : "", light.name,
                       direction_text(light.direction));
  }
  const Aabb& bounds = world.finite_bounds;
  const double size = bounds.min.x < bounds.max.x ? glm::length(bounds.max - bounds.min) : 1.0;
  if (glm::length(face.origin - light.position) > 1e-3 * std::max(size, glm::length(light.position)))
    return fmt::format("looks from {}, light \"{}\" stands at {}", direction_text(face.origin), light.name,
                       direction_text(light.position));
  if (light.type == LightType::spot && faces == 1 && glm::dot(face.face.forward, light.direction) < 0.99)
    return fmt::format("looks along {}, light \"{}\" shines along {}", direction_text(face.face.forward),
                       light.name, direction_text(light.direction));
  return std::nullopt;
}

namespace {

/// The matrix of the layer alone, whose own runs over the whole picture.
Mat4 clip_of_rect(const CapturedLayer& layer, ImageSize picture) {
  const CapturedRect& rect = *layer.rect;
  const double below = *layer.rows == RowOrder::top_down ? picture.height - rect.y - rect.height : rect.y;
  const Vec2 scale(double(picture.width) / rect.width, double(picture.height) / rect.height);
  const Vec2 middle(2.0 * (rect.x + 0.5 * rect.width) / picture.width - 1.0,
                    2.0 * (below + 0.5 * rect.height) / picture.height - 1.0);
  Mat4 rect_from_picture(1.0);
  rect_from_picture[0][0] = scale.x, rect_from_picture[1][1] = scale.y;
  rect_from_picture[3][0] = -scale.x * middle.x, rect_from_picture[3][1] = -scale.y * middle.y;
  return rect_from_picture * *layer.clip_from_world;
}

Expected<void> read_texels(const Capture& capture, std::size_t i, bool mirrored, int face, CapturedMap& out) {
  const CapturedLayer& layer = capture.map[i];
  const std::string field = fmt::format("map[{}].depth", i);
  auto numbers = out.test->read_layer(capture, i);
  if (!numbers) return fail(numbers.error());
  const ImageSize size = numbers->size;
  const auto wrong = [&](std::string reason) { return capture_error(capture, field, std::move(reason)); };
  raster::ShadowMap& map = out.map;
  const CapturedTest::Part& part = out.test->parts[static_cast<std::size_t>(face)];
  const LayerTexels texels{
      layer.rect.value_or(CapturedRect{0, 0, size.width, size.height}), *layer.rows, mirrored, size, {}};
  const bool linear = is_linear(out.stored);
  const std::size_t step = std::max<std::size_t>(1, map.depth.size() / 65536);
  std::size_t bad = 0, beyond = 0;
  for (int v = 0; v < part.height; ++v)
    for (int u = 0; u < part.width; ++u) {
      const std::size_t at = texels.at(u, v);
      const float value = numbers->values[at];
      bad += std::isnan(value) || (!linear && !std::isfinite(value)) ? 1 : 0;
      beyond += !linear && (value < 0.0f || value > 1.0f) ? 1 : 0;
      const int column = part.column + u, row = part.row + v;
      const std::size_t index = map.texel_index(face, column, row);
      out.test->take(*numbers, at, index, map.depth.size());
      map.depth[index] = linear ? stored_of_linear(map.view, out.stored, face, column, row,
                                                   linear_world(layer.range, double{value}))
                                : value;
      if (index % step == 0 && holds_caster(map.view, double{map.depth[index]}))
        out.captured_numbers.push_back(value);
    }
  if (layer.rect && numbers->averages.empty()) out.atlas.resize(capture.map.size());
  if (!out.atlas.empty())
    out.atlas[static_cast<std::size_t>(face)] = texels,
    out.atlas[static_cast<std::size_t>(face)].numbers = std::move(numbers->values);
  if (bad > 0) return wrong(fmt::format("{} texels are not finite numbers", bad));
  if (beyond > 0)
    return wrong(fmt::format("{} texels lie beyond 0 to 1; minus_one_to_one stores (z/w + 1)/2", beyond));
  return {};
}

/// Each layer in the middle of a square face of the largest side, texels alike.
Expected<void> lay_out(const Capture& capture, const std::vector<int>& order, CapturedMap& out) {
  LightView& view = out.map.view;
  std::vector<ImageSize> sizes;
  view.size = 0;
  for (std::size_t i = 0; i < capture.map.size(); ++i) {
    const auto picture = layer_size(capture, i);
    if (!picture) return fail(picture.error());
    sizes.push_back(*picture);
    view.size = std::max({view.size, picture->width, picture->height});
  }
  std::vector<CapturedTest::Part>& parts = out.test->parts;
  parts.resize(sizes.size());
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const auto face = static_cast<std::size_t>(order[i]);
    const int left = view.size - sizes[i].width, below = view.size - sizes[i].height;
    parts[face] = {left / 2, below / 2, sizes[i].width, sizes[i].height};
    if (view.projection == LightProjection::perspective && (left % 2 != 0 || below % 2 != 0 || view.seamless))
      if (left != 0 || below != 0)
        return capture_error(capture, fmt::format("map[{}].depth", i),
                             view.seamless ? "is not as large as the other faces of the cube, or not square"
                                           : "has sides of which one is even and one odd");
    LightFace& f = view.faces[face];
    const Vec2 texel = 2.0 * f.half_extent / Vec2(sizes[i].width, sizes[i].height);
    f.half_extent = 0.5 * double(view.size) * texel;
    f.center += 0.5 * Vec2(left % 2, below % 2) * texel;
  }
  const float nothing = view.reversed ? 0.0f : 1.0f;
  out.map.depth.assign(static_cast<std::size_t>(view.face_count) * static_cast<std::size_t>(view.size) *
                           static_cast<std::size_t>(view.size),
                       nothing);
  return {};
}

/// The faces of a cube in the order of cube_face(), whatever order the layers have.
Expected<std::vector<int>> order_faces(const Capture& capture, const std::vector<MatrixFace>& faces) {
  std::vector<int> order(faces.size());
  const bool cube = faces.front().projection == LightProjection::perspective && faces.size() == 6;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    order[i] = cube ? cube_face(faces[i].face.forward) : static_cast<int>(i);
    if (!cube) continue;
    const std::string field = fmt::format("map[{}].clip_from_world", i);
    const LightFace& face = faces[i].face;
    if (std::find(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(i), order[i]) !=
        order.begin() + static_cast<std::ptrdiff_t>(i))
      return capture_error(capture, field, "looks the same way as a face before");
    const Vec3 a = glm::abs(face.forward);
    const double along = std::max({a.x, a.y, a.z});
    if (along < 1.0 - matrix_slack || std::abs(face.half_extent.x - 1.0) > 1e-2)
      return capture_error(capture, field,
                           "is not the face of a cube: it looks along an axis, 90 degrees wide");
  }
  return order;
}

}  // namespace

std::size_t LayerTexels::at(int u, int v) const {
  const int y = rect.y + (rows == RowOrder::top_down ? rect.height - 1 - v : v);
  const int x = rect.x + (mirrored ? rect.width - 1 - u : u);
  if (x < 0 || y < 0 || x >= picture.width || y >= picture.height) return none;
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) + static_cast<std::size_t>(x);
}

float stored_of_linear(const LightView& view, StoredDepth stored, int face, int u, int v, double value) {
  const float nothing = view.reversed ? 0.0f : 1.0f;
  if (!(value > 0.0) || !std::isfinite(value)) return nothing;
  const bool distance = convention_of(stored).stores == Stores::distances;
  const double to_depth =
      distance ? glm::dot(texel_ray(view, face, u + 0.5, v + 0.5).direction, view.face(face).forward) : 1.0;
  // A cube's corner lies that much farther than its far plane; a number that is kept may round beyond it.
  if (value > view.face(face).far_depth * (distance ? 1.7321 : 1.0)) return nothing;
  return static_cast<float>(stored_from_depth(view, face, v + 0.5, value * to_depth));
}

double linear_world(const std::optional<Vec2>& range, double stored) {
  if (!range) return stored;
  const bool empty = range->y > range->x ? stored >= 1.0 : stored <= 0.0;
  return empty ? 0.0 : range->x + stored * (range->y - range->x);
}

tl::expected<MatrixFace, std::string> take_apart(const Mat4& m, StoredDepth convention) {
  for (int i = 0; i < 16; ++i)
    if (!std::isfinite(m[i / 4][i % 4]))
      return tl::unexpected<std::string>("has numbers that are not finite");
  const Vec4 x = row(m, 0), y = row(m, 1), w = row(m, 3);
  const Vec4 s = stored_row(row(m, 2), w, convention);
  const bool reversed = convention_of(convention).reversed;
  const bool parallel = glm::length(Vec3(w)) < 1e-12 * std::max(1.0, std::abs(w.w));
  // The way along the light: of a perspective whose far plane is infinitely far the depth's row has none.
  const Vec3 along(parallel ? row(m, 2) : w);
  const double lengths = glm::length(Vec3(x)) * glm::length(Vec3(y)) * glm::length(along);
  const double volume = std::abs(glm::determinant(Mat3(Vec3(x), Vec3(y), along)));
  if (!(lengths > 0.0) || !(volume > 1e-9 * lengths)) return tl::unexpected<std::string>("is singular");
  if (!parallel) return perspective(x, y, s, w, reversed);
  if (!(w.w > 0.0)) return tl::unexpected<std::string>("is singular");
  return orthographic(x / w.w, y / w.w, s / w.w, reversed);
}

namespace {

Expected<Mat4> layer_matrix(const Capture& capture, std::size_t i) {
  const CapturedLayer& layer = capture.map[i];
  if (!layer.rect) return *layer.clip_from_world;
  const auto picture = layer_picture_size(capture, i);
  if (!picture) return fail(picture.error());
  return clip_of_rect(layer, *picture);
}

Expected<std::vector<MatrixFace>> read_faces(const Capture& capture, const Light& light, const World& world) {
  std::vector<MatrixFace> faces;
  for (std::size_t i = 0; i < capture.map.size(); ++i) {
    const std::string field = fmt::format("map[{}].clip_from_world", i);
    const auto matrix = layer_matrix(capture, i);
    if (!matrix) return fail(matrix.error());
    const auto face = take_apart(*matrix, *capture.map.front().convention);
    if (!face)
      return capture_error(
          capture, field,
          face.error() + (capture.map[i].rect ? "; with rect the matrix is that into the whole picture, and "
                                                "`rows` says at which end its y begins"
                                              : ""));
    if (const auto reason = not_of_light(*face, capture.map.size(), light, world))
      return capture_error(capture, field, *reason);
    faces.push_back(*face);
  }
  return faces;
}

}  // namespace

Capture in_world_of_scene(Capture capture, const Mat3& scene_from_captured) {
  const double scale = std::cbrt(std::abs(glm::determinant(scene_from_captured)));
  for (CapturedLayer& layer : capture.map) {
    if (layer.clip_from_world) *layer.clip_from_world *= Mat4(glm::inverse(scene_from_captured));
    if (layer.select) layer.select->near *= scale, layer.select->far *= scale, layer.select->blend *= scale;
    if (layer.bias) layer.bias->normal_offset_world *= scale;
    if (layer.convention && is_linear(*layer.convention))
      layer.range = scale * layer.range.value_or(Vec2(0.0, 1.0));
    if (layer.caster_bias)
      layer.caster_bias->constant_world *= scale, layer.caster_bias->normal_offset_world *= scale;
  }
  if (capture.fade) capture.fade->from *= scale, capture.fade->to *= scale;
  if (capture.bias) capture.bias->normal_offset_world *= scale;
  return capture;
}

namespace {

Expected<void> check_projections(const Capture& capture, const Light& light, const World& world) {
  const auto faces = read_faces(capture, light, world);
  if (!faces) return fail(faces.error());
  return {};
}

Expected<CapturedMap> read_projections(const Capture& capture, const Light& light, const World& world) {
  CapturedMap out;
  out.test = convention_of(capture.filter ? capture.filter->read : FilterRead::nearest).make(capture);
  const StoredDepth convention = *capture.map.front().convention;
  out.stored = convention;
  const bool linear = is_linear(convention);
  if (const auto& range = capture.map.front().range; linear && range)
    out.unit_world = std::abs(range->y - range->x);
  const auto read = read_faces(capture, light, world);
  if (!read) return fail(read.error());
  const std::vector<MatrixFace>& faces = *read;
  LightView& view = out.map.view;
  view.projection = faces.front().projection;
  view.face_count = static_cast<int>(faces.size());
  const bool parallel = view.projection == LightProjection::orthographic;
  if (!parallel && faces.size() != 1 && faces.size() != 6)
    return capture_error(capture, "map", "of a light in perspective has one layer, or six of a cube");
  if (parallel && linear)
    return capture_error(
        capture, "map[0].convention",
        fmt::format("{} does not go with an orthographic matrix, whose own depths are linear: "
                    "zero_to_one, minus_one_to_one or reversed says how they are stored",
                    convention_of(convention).name));
  view.origin = faces.front().origin;
  view.reversed = convention_of(convention).reversed || linear;
  view.seamless = !parallel && faces.size() == 6;
  if (view.seamless && capture.map.front().select)
    return capture_error(capture, "map[0].select", "is not of a cube: the way to the light chooses the face");
  const auto order = order_faces(capture, faces);
  if (!order) return fail(order.error());
  out.caster_bias.resize(faces.size()), out.bias.resize(faces.size());
  if (capture.map.front().select) out.select.resize(faces.size());
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const auto face = static_cast<std::size_t>((*order)[i]);
    view.faces[face] = faces[i].face;
    out.bias[face] = capture.map[i].bias.value_or(capture.bias.value_or(CapturedBias{}));
    if (capture.map[i].select) out.select[face] = *capture.map[i].select;
    CapturedCasterBias& bias = out.caster_bias[face] =
        capture.map[i].caster_bias.value_or(CapturedCasterBias{});
    if (linear) bias.constant_world += bias.constant * out.unit_world, bias.constant = 0.0;
  }
  if (const auto laid = lay_out(capture, *order, out); !laid) return fail(laid.error());
  for (std::size_t i = 0; i < faces.size(); ++i)
    if (const auto read = read_texels(capture, i, faces[i].mirrored, (*order)[i], out); !read)
      return fail(read.error());
  std::vector<CapturedTest::Part>& parts = out.test->parts;
  const CapturedTest::Part whole{0, 0, view.size, view.size};
  if (std::all_of(parts.begin(), parts.end(), [&](const auto& part) { return part == whole; })) parts.clear();
  out.map.format = view.reversed ? raster::DepthFormat::d32f_reversed : raster::DepthFormat::d32f;
  return out;
}

}  // namespace

const MapLayout projected_layout{check_nothing, check_projections, read_projections};

Expected<void> check_map_matrices(const Capture& capture, const Light& light, const World& world) {
  return convention_of(*capture.map.front().convention).layout->check_matrices(capture, light, world);
}

Expected<CapturedMap> read_map(const Capture& capture, const Light& light, const World& world) {
  return convention_of(*capture.map.front().convention).layout->read(capture, light, world);
}

}  // namespace gnomon::judge
