// What the tests of a capture's keys have an engine draw and say: each function changes a capture of Gnomon's own map into one
// that another renderer might hand over.
#pragma once

#include <set>

#include "scene/files/pictures/image_io.h"
#include "tests/support/judged_engine.h"

namespace gnomon::test {

using judge::Capture;
using judge::CapturedBias;
using judge::CapturedFade;
using judge::CapturedSelect;

inline void put_texels(Capture& capture, const std::function<float(float)>& change) {
  std::set<std::string> files;  // layers may share one
  for (const judge::CapturedLayer& layer : capture.map) files.insert(layer.depth);
  for (const std::string& file : files)
    spoil(file, [&](ChannelImage& image) {
      for (float& v : image.channels[0].values) v = change(v);
    });
}

/// Stored numbers that run over [0, 1] from one end of the range to the other; nothing drawn: the far end's.
inline std::function<void(Engine&)> in_range(double near, double far) {
  return [=](Engine& engine) {
    for (judge::CapturedLayer& layer : engine.capture.map) layer.range = Vec2(near, far);
    put_texels(engine.capture, [=](float v) {
      return v > 0.0f ? static_cast<float>((double{v} - near) / (far - near)) : near < far ? 1.0f : 0.0f;
    });
    engine.capture.bias->constant_depth /= std::abs(far - near);
  };
}

inline std::function<void(Engine&)> with_bias(const CapturedBias& bias) {
  return [=](Engine& engine) { engine.capture.bias = bias; };
}

inline std::function<void(Engine&)> filtered(const judge::CapturedFilter& filter) {
  return [=](Engine& engine) {
    engine.capture.filter = filter;
    store_moments(engine.capture);
  };
}

/// Three layers by these distances, the second with a bias that leaves no shadow; all hold the same.
inline void select_three(Capture& capture, bool by_distance, double blend = 0.0) {
  capture.map.resize(1);
  capture.map.assign(3, capture.map[0]);
  const double ends[] = {0.0, 5.5, 6.2, 1e3};
  for (std::size_t i = 0; i < 3; ++i)
    capture.map[i].select = CapturedSelect{ends[i], ends[i + 1], by_distance, i < 2 ? blend : 0.0};
  capture.map[1].bias = CapturedBias{.constant_depth = 0.05, .normal_offset_world = 0.01};
}

inline std::function<void(Engine&)> selected(bool by_distance, double blend = 0.0) {
  return [=](Engine& engine) { select_three(engine.capture, by_distance, blend); };
}

inline std::function<void(Engine&)> faded(const CapturedFade& fade) {
  return [=](Engine& engine) { engine.capture.fade = fade; };
}

/// The one layer cut into n x n that overlap, each a picture of its own.
inline void cut_into(Capture& capture, int n, int overlap) {
  const judge::CapturedLayer whole = capture.map[0];
  const auto picture = read_channels(whole.depth);
  const int size = picture->size.width, side = size / n + overlap;
  capture.map.clear();
  for (int k = 0; k < n * n; ++k) {
    const int x = std::min(k % n * (size / n), size - side), y = std::min(k / n * (size / n), size - side);
    judge::CapturedLayer& layer = capture.map.emplace_back(whole);
    layer.depth = whole.depth + std::to_string(k) + ".exr";
    Channel part{"Z", {}};
    for (int row = 0; row < side; ++row)
      for (int column = 0; column < side; ++column)
        part.values.push_back(picture->channels[0].values[std::size_t((y + row) * size + x + column)]);
    EXPECT_TRUE(write_exr(layer.depth, {side, side}, std::array{part}));
    Mat4 part_from_whole(1.0);
    part_from_whole[0][0] = part_from_whole[1][1] = double(size) / side;
    part_from_whole[3][0] = -(2.0 * x + side - size) / side;
    part_from_whole[3][1] = -(2.0 * y + side - size) / side;
    layer.clip_from_world = part_from_whole * *whole.clip_from_world;
  }
}

/// The layer in a part of a larger picture, its matrix into the whole of that.
inline void put_into_atlas(Engine& engine, const judge::CapturedRect& rect, ImageSize atlas) {
  Capture& capture = engine.capture;
  spoil(capture.map[0].depth, [&](ChannelImage& image) {
    std::vector<float> whole(atlas.pixels(), 0.37f);
    for (int y = 0; y < rect.height; ++y)
      for (int x = 0; x < rect.width; ++x)
        whole[std::size_t((rect.y + y) * atlas.width + rect.x + x)] =
            image.channels[0].values[std::size_t(y * image.size.width + x)];
    image.size = atlas, image.channels[0].values = std::move(whole);
  });
  const double below =
      capture.map[0].rows == judge::RowOrder::top_down ? atlas.height - rect.y - rect.height : rect.y;
  Mat4 atlas_from_rect(1.0);
  atlas_from_rect[0][0] = double(rect.width) / atlas.width,
  atlas_from_rect[1][1] = double(rect.height) / atlas.height;
  atlas_from_rect[3][0] = 2.0 * (rect.x + 0.5 * rect.width) / atlas.width - 1.0;
  atlas_from_rect[3][1] = 2.0 * (below + 0.5 * rect.height) / atlas.height - 1.0;
  *capture.map[0].clip_from_world = atlas_from_rect * *capture.map[0].clip_from_world;
  capture.map[0].rect = rect;
}

/// A strip of the map, whose texels are those of the whole: what lies beside it is outside the map.
inline void cut_to_strip(Engine& engine) {
  constexpr int low = 160, height = 192;
  spoil(engine.capture.map[0].depth, [&](ChannelImage& image) {
    std::vector<float>& v = image.channels[0].values;
    v = std::vector<float>(v.begin() + low * 512, v.begin() + (low + height) * 512);
    image.size.height = height;
  });
  Mat4 part_from_whole(1.0);
  part_from_whole[1][1] = 512.0 / height;
  *engine.capture.map[0].clip_from_world = part_from_whole * *engine.capture.map[0].clip_from_world;
}

/// A strip of the picture at a fifth of its light.
inline void darken_by_another(Engine& engine) {
  engine.capture.also = folder_for("keys-also") + ".exr";
  Channel also{"V", std::vector<float>(small_picture.pixels(), 1.0f)};
  for (std::size_t i = 0; i < also.values.size(); ++i)
    if (i % small_picture.width < 8 && i > also.values.size() / 2) also.values[i] = 0.2f;
  EXPECT_TRUE(write_exr(engine.capture.also, small_picture, std::array{also}));
}

inline void draw_with_also(Engine& engine) {
  if (engine.capture.also.empty()) return;
  const auto also = read_channels(engine.capture.also);
  spoil(engine.capture.visibility, [&](ChannelImage& image) {
    for (std::size_t i = 0; i < image.size.pixels(); ++i)
      image.channels[0].values[i] *= also->channels[0].values[i];
  });
}

/// The cube in the place of which two paraboloids are drawn, each of so many texels, by rays through the texels' middles. The second
/// mirrors, as those of Godot do. `together`: one picture holds both, one above the other.
inline std::function<void(Engine&)> as_paraboloids(ImageSize size, bool together) {
  return [=](Engine& engine) {
    Capture& capture = engine.capture;
    const judge::CapturedLayer first = capture.map[0];
    const Vec3 light = engine.drawn.scene->lights[0].position;
    const raytrace::Tracer tracer(*engine.drawn.world, raytrace::Accel::bvh);
    // The halves meet over the floor.
    const Vec3 z = glm::normalize(Vec3(1.0, -0.3, 0.2)),
               x = glm::normalize(glm::cross(z, Vec3(0.1, 1.0, 0.3)));
    const Mat3 turn = glm::transpose(Mat3(x, glm::cross(z, x), z));
    capture.map.assign(2, first);
    std::vector<Channel> pictures;
    for (int half = 0; half < 2; ++half) {
      Mat3 own = turn;
      if (half == 1) own = Mat3(Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, -1)) * own;
      Channel texels{"Z", {}};
      for (int row = 0; row < size.height; ++row)
        for (int column = 0; column < size.width; ++column) {
          const Vec2 at = 2.0 * Vec2((column + 0.5) / size.width, (row + 0.5) / size.height) - 1.0;
          const double square = glm::dot(at, at);  // d.z = (1 - r^2) / (1 + r^2)
          const Vec3 d = Vec3(2.0 * at.x, 2.0 * at.y, 1.0 - square) / (1.0 + square);
          const auto hit = tracer.closest_hit({light, glm::transpose(own) * d, {0.0, infinity}});
          texels.values.push_back(hit ? static_cast<float>(hit->t) : 0.0f);
        }
      pictures.push_back(texels);
      judge::CapturedLayer& layer = capture.map[std::size_t(half)];
      layer.convention = judge::StoredDepth::paraboloid, layer.rows = judge::RowOrder::bottom_up;
      layer.clip_from_world = Mat4(own);
      (*layer.clip_from_world)[3] = Vec4(-(own * light), 1.0);
      if (together) layer.rect = judge::CapturedRect{0, half * size.height, size.width, size.height};
      layer.depth = first.depth + (together ? "" : std::to_string(half)) + ".exr";
      if (together) continue;
      EXPECT_TRUE(write_exr(layer.depth, size, std::array{texels}));
    }
    if (!together) return;
    std::vector<float>& all = pictures[0].values;
    all.insert(all.end(), pictures[1].values.begin(), pictures[1].values.end());
    EXPECT_TRUE(write_exr(capture.map[0].depth, {size.width, 2 * size.height}, std::array{pictures[0]}));
  };
}

}  // namespace gnomon::test
