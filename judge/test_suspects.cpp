#include "judge/test_suspects.h"

#include <fmt/core.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "compare/bias/bias_curve.h"
#include "judge/turned_map.h"
#include "scene/base/parallel.h"

namespace gnomon::judge {
namespace {

using raster::LightRecord;
using Reads = CapturedTest::Reads;

/// Exchanges the numbers of so many texels from two on, a before b.
void exchange_texels(LightRecord& record, std::size_t a, std::size_t b, std::size_t count) {
  std::vector<std::size_t> from(b + count - a);
  std::iota(from.begin(), from.end(), a);
  std::swap_ranges(from.begin(), from.begin() + static_cast<std::ptrdiff_t>(count),
                   from.end() - static_cast<std::ptrdiff_t>(count));
  reorder_texels(record, a, from);
}

bool turn_faces(LightRecord& record, const MapTurn& turn) {
  bool turned = true;
  for (int face = 0; face < record.map.view.face_count; ++face)
    turned = turned && turn_face(turn, face, record);
  return turned;
}

bool turn_sign(LightRecord& record) {
  record.bias_constant_world = -record.bias_constant_world;
  return record.bias_constant_world != 0.0;
}

template <class Change>
bool change_faces(LightRecord& record, const Change& change) {
  if (record.map.view.projection != LightProjection::orthographic) return false;
  for (int i = 0; i < record.map.view.face_count; ++i)
    change(record.map.view.faces[static_cast<std::size_t>(i)]);
  return true;
}

/// x / 2 + 1 / 2 in the place of x.
bool take_off_texture_matrix(LightRecord& record) {
  return change_faces(record, [](LightFace& face) {
    face.half_extent = 0.5 * face.half_extent;
    face.center += face.half_extent;
  });
}

/// The depths' range so many times as long, up to the same far plane.
bool stretch_depths(LightRecord& record, double times) {
  if (record.map.view.reversed) return false;
  changed_test(record).unit_world *= times, record.bias_constant_world *= times;
  return change_faces(record, [=](LightFace& face) {
    face.near_depth = face.far_depth - times * (face.far_depth - face.near_depth);
  });
}

/// Changes the lookup to that of a renderer that takes one side of the window for the other's.
bool take_side_for(LightRecord& record, int axis) {
  const LightFace& face = record.map.view.face(0);
  if (std::abs(face.half_extent.x - face.half_extent.y) < 0.01 * face.half_extent.x) return false;
  return change_faces(record, [axis](LightFace& f) { f.half_extent[axis] = f.half_extent[1 - axis]; });
}

bool move_by_texels(LightRecord& record, Vec2 texels) {
  const double size = record.map.view.size;
  return change_faces(record, [=](LightFace& f) { f.center += 2.0 * texels * f.half_extent / size; });
}

bool has_offset(LightRecord& record) {
  return captured_test(record).normal_offset_world > 0.0;
}

bool turn_offset(LightRecord& record) {
  CapturedTest& test = changed_test(record);
  test.normal_offset_world *= -1.0;
  for (auto& layer : test.layers) layer.normal_offset_world *= -1.0;
  return test.normal_offset_world != 0.0 || !test.layers.empty();
}

bool keep(LightRecord&) {
  return true;
}

/// Each texel's number taken for a distance where it was taken for a depth along the axis, or the reverse.
bool take_for_other_linear(LightRecord& record) {
  raster::ShadowMap& map = record.map;
  const CapturedTest& test = captured_test(record);
  if (test.stores == Stores::depths || !map.unbiased.empty() || test.reads() == Reads::elsewhere)
    return false;
  const LightView& view = map.view;
  const bool distances = test.stores == Stores::distances;
  parallel_for(view.face_count * view.size, [&](int line) {
    const int face = line / view.size, row = line % view.size;
    for (int column = 0; column < view.size; ++column) {
      float& stored = map.depth[map.texel_index(face, column, row)];
      if (!holds_caster(view, double{stored})) continue;
      const double along =
          glm::dot(texel_ray(view, face, column + 0.5, row + 0.5).direction, view.face(face).forward);
      const double depth = depth_from_stored(view, face, row + 0.5, double{stored});
      stored = static_cast<float>(
          stored_from_depth(view, face, row + 0.5, distances ? depth / along : depth * along));
    }
  });
  changed_test(record).stores = distances ? Stores::linear_z : Stores::distances;
  return true;
}

void add_conventions(const LightRecord& described, std::vector<TestSuspect>& out) {
  const auto add = [&](const char* of_capture, const char* of_renderer, auto change) -> TestSuspect& {
    out.push_back({of_capture, of_renderer, change});
    out.back().with_others = true;
    return out.back();
  };
  add("`rows` of the map is the other one", "the renderer reads its map upside down (v runs the other way)",
      [](LightRecord& record) { return turn_faces(record, {.rows = true}); })
      .turns_map = true;
  add("the map's columns run the other way", "the renderer reads its map mirrored (u runs the other way)",
      [](LightRecord& record) { return turn_faces(record, {.columns = true}); })
      .turns_map = true;
  add("the map's columns are its rows", "the renderer reads its map with u and v exchanged",
      [](LightRecord& record) { return turn_faces(record, {.transposed = true}); })
      .turns_map = true;
  add("`constant_depth` has the other sign (positive takes shadow away)",
      "the renderer applies its bias with the other sign", turn_sign)
      .of_constant = true;
  out.back().of_sign = true;
  add("`slope` has the other sign (positive takes shadow away)",
      "the renderer applies its slope bias with the other sign", keep)
      .of_sign = true;
  out.back().of_slope = -1.0;
  add("`normal_offset_world` has the other sign",
      "the renderer applies its normal offset with the other sign, into the surface", turn_offset)
      .of_sign = true;
  add("`clip_from_world` holds the scale and shift to texture coordinates", "", take_off_texture_matrix);
  add("the matrix makes depths of -1 to 1 (`minus_one_to_one`)", "",
      [](LightRecord& record) { return stretch_depths(record, 2.0); });
  add("the matrix makes depths of 0 to 1 (`zero_to_one`)", "",
      [](LightRecord& record) { return stretch_depths(record, 0.5); });
  add("the matrix has the window's height for its width",
      "the renderer takes the window's height for its width",
      [](LightRecord& record) { return take_side_for(record, 0); });
  add("the matrix has the window's width for its height",
      "the renderer takes the window's width for its height",
      [](LightRecord& record) { return take_side_for(record, 1); });
  add("the offset goes along the front's normal, on back faces into the surface",
      "the renderer's normal offset has the wrong sign on back faces", has_offset)
      .by_fronts = true;
  out.push_back({"the picture has 1 for shadow and 0 for light, or the comparison is swapped", "", keep});
  out.back().swapped = out.back().of_sign = true;
  const bool distances = captured_test(described).stores == Stores::distances;
  out.push_back({distances ? "`convention` of the map is linear_z" : "`convention` of the map is distance",
                 "", take_for_other_linear});
}

/// How stored numbers are read and biased.
void add_keys_of_test(const LightRecord& described, std::vector<TestSuspect>& out) {
  const CapturedTest& test = captured_test(described);
  for (const Reads read : {Reads::texel, Reads::between}) {
    if (read == test.reads() || test.reads() == Reads::elsewhere) continue;
    const bool between = read == Reads::between;
    out.push_back({between ? "`filter.read` is linear_depths" : "`filter.read` is nearest", "",
                   [between](LightRecord& record) {
                     record.foreign->test = std::make_shared<DepthsTest>(captured_test(record), between);
                     return true;
                   }});
  }
  for (std::size_t i = 0; i < bias_angle_names.size(); ++i) {
    const auto form = static_cast<BiasAngle>(i);
    if (form != test.constant_angle)
      out.push_back({fmt::format("`bias.angle` is {}", bias_angle_names[i]), "", [form](LightRecord& record) {
                       changed_test(record).constant_angle = form;
                       return record.bias_constant_world != 0.0;
                     }});
    if (form != test.normal_offset_angle && form != BiasAngle::tangent)
      out.push_back({fmt::format("`bias.normal_offset_angle` is {}", bias_angle_names[i]), "",
                     [form](LightRecord& record) {
                       changed_test(record).normal_offset_angle = form;
                       return has_offset(record);
                     }});
  }
  out.push_back({"nothing limits the bias (`bias.min`, `bias.max`)", "", [](LightRecord& record) {
                   CapturedTest& changed = changed_test(record);
                   const bool limited = changed.least != -infinity || changed.most != infinity;
                   changed.least = -infinity, changed.most = infinity;
                   return limited;
                 }});
  out.push_back(
      {"no offset along the normal is drawn (`bias.normal_offset_world` is 0)", "", [](LightRecord& record) {
         CapturedTest& changed = changed_test(record);
         const bool any = changed.normal_offset_world != 0.0 || !changed.layers.empty();
         changed.normal_offset_world = 0.0;
         for (auto& layer : changed.layers) layer.normal_offset_world = 0.0;
         return any;
       }});
  out.push_back({"no slope bias is drawn (`bias.slope` is 0)", "", keep});
  out.back().of_slope = 0.0;
  out.push_back({"the layers' own biases (`map[].bias`) are not drawn", "", [](LightRecord& record) {
                   return !std::exchange(changed_test(record).layers, {}).empty();
                 }});
}

/// Half a texel and a whole one to all sides: matrices to texel centres, parts of atlases with and without their border.
void add_shifts(const LightRecord& described, std::vector<TestSuspect>& out) {
  if (described.map.view.projection != LightProjection::orthographic) return;
  for (const double by : {0.5, 1.0})
    for (const Vec2 along : {Vec2(1, 0), Vec2(0, 1), Vec2(1, 1), Vec2(1, -1)})
      for (const double sign : {1.0, -1.0}) {
        const Vec2 texels = sign * by * along;
        out.push_back({fmt::format("the map lies {:g}, {:g} texels off (`rect`, or `clip_from_world`)",
                                   texels.x, texels.y),
                       "", [texels](LightRecord& record) { return move_by_texels(record, texels); }});
      }
}

/// The windows of layers in atlases whose matrices are those of the layers alone.
void add_own_matrices(const Capture& capture, const LightRecord& described, std::vector<TestSuspect>& out) {
  std::vector<std::pair<Vec2, Vec2>>
      scale_and_middle;  // of the picture against the rect, and where its middle is
  bool any = false;
  for (std::size_t i = 0; i < capture.map.size(); ++i) {
    const CapturedLayer& layer = capture.map[i];
    const auto picture = layer_picture_size(capture, i);
    if (!picture) return;
    const CapturedRect rect = layer.rect.value_or(CapturedRect{0, 0, picture->width, picture->height});
    const int low = *layer.rows == RowOrder::top_down ? picture->height - rect.y - rect.height : rect.y;
    const Vec2 scale(double(picture->width) / rect.width, double(picture->height) / rect.height);
    scale_and_middle.emplace_back(scale, Vec2(2.0 * (rect.x + 0.5 * rect.width) / picture->width - 1.0,
                                              2.0 * (low + 0.5 * rect.height) / picture->height - 1.0));
    any = any || scale != Vec2(1.0);
  }
  if (!any || described.map.view.projection != LightProjection::orthographic) return;
  out.push_back({"`clip_from_world` is that of the layer alone, not of its whole picture (`rect`)", "",
                 [scale_and_middle](LightRecord& record) {
                   for (std::size_t i = 0; i < scale_and_middle.size(); ++i) {
                     LightFace& face = record.map.view.faces[i];
                     const auto& [scale, middle] = scale_and_middle[i];
                     face.half_extent *= scale, face.center -= middle * face.half_extent;
                   }
                   return true;
                 }});
}

void add_exchanged_layers(const LightRecord& described, std::vector<TestSuspect>& out) {
  if (described.map.view.seamless) return;  // a cube's faces stand in an order of their own
  for (int i = 0; i + 1 < described.map.view.face_count; ++i)
    out.push_back({fmt::format("the pictures of map[{}] and map[{}] are exchanged", i, i + 1), "",
                   [i](LightRecord& record) {
                     const raster::ShadowMap& map = record.map;
                     const std::size_t first = map.texel_index(i, 0, 0), next = map.texel_index(i + 1, 0, 0);
                     exchange_texels(record, first, next, next - first);
                     return map.unbiased.empty();
                   }});
}

// ---- numbers that the picture tells ----

class ByPicture {
 public:
  ByPicture(const FrameInput& in, const LightRecord& described, const compare::LightComparison& light)
      : in_(in), described_(described), light_(light), view_(make_view(in.camera, in.capture.size)) {}

  void add_selections(std::vector<TestSuspect>& out) const;
  void add_fade(bool by_distance, std::vector<TestSuspect>& out) const;
  void add_layer_constants(std::vector<TestSuspect>& out) const;

 private:
  bool is_asked(std::size_t i) const {
    return compare::is_compared(light_.labels.data[i]) && described_.outside_map.data[i] == 0;
  }
  bool test_is_dark(std::size_t i) const {
    return double{described_.gap.data[i]} > described_.bias_constant_world;
  }
  bool drawn_dark(std::size_t i) const { return light_.rungs[6].data[i] < 0.5f; }
  static TestSuspect with_faces(std::string what, Image<std::uint8_t> faces) {
    return {std::move(what), "", [faces = std::move(faces)](LightRecord& record) {
              changed_test(record).faces = faces;
              return true;
            }};
  }
  const FrameInput& in_;
  const LightRecord& described_;
  const compare::LightComparison& light_;
  View view_;
};

void ByPicture::add_selections(std::vector<TestSuspect>& out) const {
  std::vector<CapturedSelect> select = captured_selects(in_.capture);
  const auto& fade = in_.capture.fade;
  if (fade) out.push_back(with_faces("shadows do not end (`fade`)", looked_up_faces(in_, select, {})));
  if (select.empty()) return;
  out.push_back(with_faces("layers are chosen by place, the first that holds it (no `select`)",
                           looked_up_faces(in_, {}, fade)));
  const bool by_distance = !select.front().by_distance;
  for (CapturedSelect& one : select) one.by_distance = by_distance;
  out.push_back(with_faces(fmt::format("layers are chosen by {} (`select.by`)", select_names[by_distance]),
                           looked_up_faces(in_, select, fade)));
}

/// The distance beyond which most of what the test shadows is drawn lit, and before which it is drawn dark.
void ByPicture::add_fade(bool by_distance, std::vector<TestSuspect>& out) const {
  if (in_.capture.fade) return;
  std::vector<std::pair<double, bool>> dark;
  for (std::size_t i = 0; i < light_.labels.data.size(); ++i)
    if (is_asked(i) && test_is_dark(i))
      dark.emplace_back(from_camera(view_, by_distance, in_.traced.receiver.data[i].position), drawn_dark(i));
  std::sort(dark.begin(), dark.end());
  std::ptrdiff_t right = 0, best = 0;
  std::size_t end = 0;
  for (std::size_t i = 0; i < dark.size(); ++i)
    if (right += dark[i].second ? 1 : -1; right >= best) best = right, end = i + 1;
  if (end == 0 || end == dark.size()) return;
  const double limit = 0.5 * (dark[end - 1].first + dark[end].first);
  out.push_back(with_faces(
      fmt::format("shadows end about {:.3g} world units {} (`fade`)", limit,
                  by_distance ? "from the eye" : "along the view's axis"),
      looked_up_faces(in_, captured_selects(in_.capture), CapturedFade{limit, limit, by_distance})));
}

/// Each layer with the constant with which its pixels agree best.
void ByPicture::add_layer_constants(std::vector<TestSuspect>& out) const {
  constexpr double well_drawn = 0.999;
  const int faces = described_.map.view.face_count;
  if (faces < 2 || described_.map.view.seamless) return;
  const double unit = captured_test(described_).unit_world;
  std::vector<double> more(static_cast<std::size_t>(faces), 0.0);  // stored numbers
  std::string what;
  for (int face = 0; face < faces; ++face) {
    Image<compare::Label> own = light_.labels;
    std::size_t asked = 0, as_drawn = 0;
    for (std::size_t i = 0; i < own.data.size(); ++i) {
      if (!is_asked(i) || described_.face.data[i] != face)
        own.data[i] = compare::Label::background;
      else
        ++asked, as_drawn += test_is_dark(i) == drawn_dark(i) ? 1 : 0;
    }
    if (double(as_drawn) >= well_drawn * double(asked)) continue;
    const double constant =
        compare::find_best_bias(compare::sort_gaps(described_, light_.rungs[6], own)).constant_world -
        described_.bias_constant_world;
    more[static_cast<std::size_t>(face)] = constant / unit;
    const CapturedBias said = in_.capture.map[static_cast<std::size_t>(face)].bias.value_or(
        in_.capture.bias.value_or(CapturedBias{}));
    what += fmt::format("{}`map[{}].bias.constant_depth` is about {:.2g}", what.empty() ? "" : ", ", face,
                        said.constant_depth + constant / unit);
  }
  if (what.empty()) return;
  out.push_back({what, "", [more](LightRecord& record) {
                   auto& layers = changed_test(record).layers;
                   layers.resize(more.size());
                   for (std::size_t i = 0; i < more.size(); ++i) layers[i].constant += more[i];
                   return true;
                 }});
}

}  // namespace

std::vector<TestSuspect> test_suspects(const FrameInput& in, const LightRecord& described,
                                       const compare::LightComparison& light) {
  std::vector<TestSuspect> out;
  add_conventions(described, out);
  add_keys_of_test(described, out);
  captured_test(described).add_suspects(out);
  add_shifts(described, out);
  add_own_matrices(in.capture, described, out);
  add_exchanged_layers(described, out);
  const ByPicture picture(in, described, light);
  picture.add_selections(out);
  for (const bool by_distance : {false, true}) picture.add_fade(by_distance, out);
  picture.add_layer_constants(out);
  return out;
}

}  // namespace gnomon::judge
