// A bias of casters against its closed form: what each texel stores is its surface's own depth, the constant along the
// light ray, and the factor times the larger slope of the stored depth; of triangles and of shapes, for every light.
#include <cmath>

#include "raster/technique_traits.h"
#include "tests/support/raster_fixture.h"

namespace gnomon::test {
namespace {

using raster::BiasUnit;
using raster::Technique;

/// A tilted square and a box, or a tilted plane with a ball and a cylinder.
Scene tilted_casters(const Light& light, bool shapes) {
  Scene scene;
  scene.materials.resize(1);
  const Vec3 normal = glm::normalize(Vec3(0.4, 1.0, 0.25));
  Vec3 t, b;
  orthonormal_basis(normal, t, b);
  if (shapes) {
    scene.shapes.push_back({"plane", Plane{Vec3(0.0), normal}, 0});
    scene.shapes.push_back({"ball", Sphere{Vec3(0.0, 1.0, 0.0), 0.5}, 0});
  } else {
    scene.meshes = {square_mesh(2.0), box_mesh()};
    Mat4 m(1.0);
    m[0] = Vec4(t, 0.0), m[1] = Vec4(normal, 0.0), m[2] = Vec4(glm::cross(t, normal), 0.0);
    scene.instances.push_back({"square", 0, m, 0});
    scene.instances.push_back({"box", 1, placed({0.1, 0.9, 0.0}, 0.6), 0});
  }
  scene.camera.eye = Vec3(0.5, 4.0, 5.0);
  scene.lights = {light};
  return scene;
}

Light caster_light(LightType type) {
  if (type == LightType::directional) return sun({-0.3, -1.0, -0.2});
  return lamp(type, {0.7, 4.0, 0.9}, {0.0, 0.0, 0.0});
}

/// What a texel stores of one surface, by closed form.
struct Caster {
  double own = 0.0, moved = 0.0, slope = 0.0;
};

class ClosedForm {
 public:
  ClosedForm(const Drawn& drawn, double constant, double slope)
      : world_(*drawn.world),
        record_(drawn.light()),
        view_(record_.map.view),
        constant_(constant),
        slope_(slope) {
    const raster::MapOptions& map = drawn.frame.options.map;
    in_texels_ = map.bias.caster_unit == BiasUnit::texel,
    scales_ = in_texels_ && raster::follows_camera(map.technique);
  }

  Caster of(int face, int column, int row, const ReferenceHit& hit) const {
    const Vec2 at(column + 0.5, row + 0.5);
    const Ray ray = texel_ray(view_, face, at.x, at.y);
    const double depth = depth_of(view_, face, ray, hit.t);
    const double width =
        scales_ ? texel_world_size(view_, project_to_face(view_, face, ray.at(hit.t))) : record_.texel_world;
    const double world = in_texels_ ? constant_ * width : constant_;
    const bool parallel = view_.projection == LightProjection::orthographic;
    const double along = parallel ? world : world * glm::dot(ray.direction, view_.face(face).forward);
    const double slope = stored_slope(face, at, ray.at(hit.t), hit.primitive);
    const double by = view_.reversed ? -slope_ * slope : slope_ * slope;
    return {stored_from_depth(view_, face, at.y, depth),
            stored_from_depth(view_, face, at.y, depth + along) + by, slope};
  }

  /// Another surface on the texel's ray comes to lie before this one.
  bool is_overtaken(int face, int column, int row, const ReferenceHit& hit) const {
    const Ray ray = texel_ray(view_, face, column + 0.5, row + 0.5);
    const double moved = of(face, column, row, hit).moved;
    for (std::uint32_t i = 0; i < world_.primitive_count(); ++i) {
      const double t =
          world_.is_triangle(i) ? hit_triangle(ray, world_.corners(i)) : hit_shape(ray, world_.shape(i));
      if (i == hit.primitive || !(t >= ray.t.min) || std::isinf(t)) continue;
      const double other = of(face, column, row, {t, i}).moved;
      if (view_.reversed ? other > moved - 1e-3 : other < moved + 1e-3) return true;
    }
    return false;
  }

 private:
  /// The larger change of the stored depth of the surface's tangent plane over a texel.
  double stored_slope(int face, const Vec2& at, const Vec3& position, std::uint32_t primitive) const {
    const Vec3 normal = geometric_normal(world_, primitive, position);
    const auto stored = [&](double u, double v) {
      const Ray ray = texel_ray(view_, face, u, v);
      const double t = glm::dot(normal, position - ray.origin) / glm::dot(normal, ray.direction);
      return stored_from_depth(view_, face, v, depth_of(view_, face, ray, t));
    };
    return std::max(std::abs(stored(at.x + 0.5, at.y) - stored(at.x - 0.5, at.y)),
                    std::abs(stored(at.x, at.y + 0.5) - stored(at.x, at.y - 0.5)));
  }

  const World& world_;
  const raster::LightRecord& record_;
  const LightView& view_;
  double constant_, slope_;
  bool in_texels_, scales_;
};

struct CasterCase {
  const char* name;
  LightType light;
  bool shapes;
  Technique technique = Technique::hard;
  raster::DepthFormat format = raster::DepthFormat::d32f;
  BiasUnit unit = BiasUnit::world;
};

class CasterBias : public testing::TestWithParam<CasterCase> {
 protected:
  static raster::RasterOptions options(double constant, double slope) {
    raster::RasterOptions options = small_options(128);
    options.map.technique = GetParam().technique;
    options.map.depth_format = GetParam().format;
    options.map.bias.caster_constant = constant, options.map.bias.caster_unit = GetParam().unit;
    options.map.bias.caster_slope = slope;
    return options;
  }
};

// As in raster_depth_map_gl_test.cpp the larger of half a step and a few units in the last place of 1, once for each of
// the two depths, and as much of the slope, which is a difference of two such; where the surface is steep, what moving a
// vertex by a few units in the last place of the map's width does.
TEST_P(CasterBias, MovesEveryTexelByItsClosedForm) {
  const double constant = GetParam().unit == BiasUnit::texel ? 1.5 : 0.04, slope = 2.0;
  const Drawn drawn =
      draw(tilted_casters(caster_light(GetParam().light), GetParam().shapes), options(constant, slope));
  const raster::ShadowMap& map = drawn.light().map;
  ASSERT_EQ(map.unbiased.size(), map.depth.size());
  const ClosedForm form(drawn, constant, slope);
  const double step = GetParam().format == raster::DepthFormat::d16 ? 0x1p-16 : 0x1p-21;
  double worst = 0.0, most = 0.0;
  int tested = 0;
  for (int face = 0; face < map.view.face_count; ++face)
    for (int row = 0; row < map.view.size; ++row)
      for (int column = 0; column < map.view.size; ++column) {
        const auto hit = hit_away_from_edges(*drawn.world, map.view, face, column, row);
        if (!hit || hit->primitive == no_id || form.is_overtaken(face, column, row, *hit)) continue;
        const auto [own, moved, steep] = form.of(face, column, row, *hit);
        if (!(own > 0.0 && own < 1.0 && moved > 0.0 && moved < 1.0)) continue;
        const std::size_t i = map.texel_index(face, column, row);
        const double vertices = 0x1p-20 * map.view.size * steep;
        EXPECT_NEAR(map.unbiased[i], own, step + vertices);
        worst = std::max(worst, std::abs(map.depth[i] - moved) - (1.0 + slope) * vertices);
        most = std::max(most, std::abs(moved - own));
        ++tested;
      }
  EXPECT_GT(tested, 1500);
  EXPECT_GT(most, 100.0 * step);
  EXPECT_LE(worst, (1.0 + slope) * step);
}

// A constant takes the same off every gap, whoever has it. Places on a texel's border fall to either side.
TEST_P(CasterBias, AConstantDrawsWhatTheReceiversConstantDraws) {
  Drawn drawn = make_drawn(tilted_casters(caster_light(GetParam().light), GetParam().shapes));
  raster::RasterOptions receivers = options(0.0, 0.0);
  receivers.map.bias.constant = GetParam().unit == BiasUnit::texel ? 0.7 : 0.04;
  receivers.map.bias.unit = GetParam().unit;
  drawn.render(receivers);
  const Image<float> wanted = drawn.light().visibility;
  EXPECT_TRUE(drawn.light().map.unbiased.empty());
  drawn.render(options(receivers.map.bias.constant, 0.0));
  std::size_t differ = 0, dark = 0;
  for (std::size_t i = 0; i < wanted.data.size(); ++i) {
    differ += drawn.light().visibility.data[i] != wanted.data[i] ? 1 : 0;
    dark += wanted.data[i] == 0.0f ? 1 : 0;
  }
  EXPECT_GT(dark, 200u);
  EXPECT_LE(differ, wanted.data.size() / 2000);
}

TEST_P(CasterBias, OfNothingDrawsTheSameMap) {
  Drawn drawn = make_drawn(tilted_casters(caster_light(GetParam().light), GetParam().shapes));
  drawn.render(options(0.0, 0.0));
  const std::vector<float> plain = drawn.light().map.depth;
  drawn.render(options(0.1, 1.0));
  EXPECT_EQ(drawn.light().map.unbiased, plain);
  EXPECT_NE(drawn.light().map.depth, plain);
  drawn.render(options(0.0, 0.0));
  EXPECT_EQ(drawn.light().map.depth, plain);
}

std::vector<CasterCase> caster_cases() {
  std::vector<CasterCase> all;
  for (const bool shapes : {false, true}) {
    all.push_back({"sun", LightType::directional, shapes});
    all.push_back({"spot", LightType::spot, shapes});
    all.push_back({"lamp", LightType::point, shapes});
    all.push_back({"sun_reversed", LightType::directional, shapes, Technique::hard,
                   raster::DepthFormat::d32f_reversed});
    all.push_back(
        {"spot_reversed", LightType::spot, shapes, Technique::hard, raster::DepthFormat::d32f_reversed});
    all.push_back({"sun_d16", LightType::directional, shapes, Technique::hard, raster::DepthFormat::d16});
    all.push_back(
        {"spot_texels", LightType::spot, shapes, Technique::hard, raster::DepthFormat::d24, BiasUnit::texel});
    all.push_back({"csm_texels", LightType::directional, shapes, Technique::csm, raster::DepthFormat::d32f,
                   BiasUnit::texel});
    all.push_back({"lispsm_texels", LightType::directional, shapes, Technique::lispsm,
                   raster::DepthFormat::d32f, BiasUnit::texel});
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Lights, CasterBias, testing::ValuesIn(caster_cases()), [](const auto& chosen) {
  return std::string(chosen.param.name) + (chosen.param.shapes ? "_shapes" : "_triangles");
});

}  // namespace
}  // namespace gnomon::test
