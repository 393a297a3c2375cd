// Contexts: both backends make OpenGL 4.5 core, draw the same scene, and say who they are.
#include "raster/gl/gl.h"
#include "tests/support/raster_fixture.h"

namespace gnomon::test {
namespace {

void expect_modern(raster::Context& context) {
  ASSERT_TRUE(context.make_current());
  const auto gl = raster::Gl::load(context);
  ASSERT_TRUE(gl.has_value()) << gl.error().message();
  EXPECT_GE((*gl)->integer(GL_MAJOR_VERSION) * 10 + (*gl)->integer(GL_MINOR_VERSION), 45);
  EXPECT_EQ((*gl)->integer(GL_CONTEXT_PROFILE_MASK), GL_CONTEXT_CORE_PROFILE_BIT);
  EXPECT_GE(raster::max_map_size(**gl), 8192);
}

TEST(Context, OsmesaMakesOpenGl45Core) {
  auto context = raster::create_context(raster::Backend::osmesa);
  if (!context) GTEST_SKIP() << context.error().message();
  EXPECT_STREQ((*context)->backend(), "osmesa");
  expect_modern(**context);
}

TEST(Context, EglMakesOpenGl45CoreWithoutADisplay) {
  auto context = raster::create_context(raster::Backend::egl);
  if (!context) GTEST_SKIP() << context.error().message();
  const std::string backend = (*context)->backend();
  EXPECT_TRUE(backend == "egl-software" || backend == "egl-hardware") << backend;
  expect_modern(**context);
}

TEST(Context, EglDrawsWithWhatIsNamedOrNotAtAll) {
  int made = 0;
  for (const auto& [backend, name] : {std::pair(raster::Backend::egl_software, "egl-software"),
                                      std::pair(raster::Backend::egl_hardware, "egl-hardware")}) {
    auto context = raster::create_context(backend);
    if (context) {
      EXPECT_STREQ((*context)->backend(), name);
      expect_modern(**context);
      ++made;
    } else {
      EXPECT_NE(context.error().message().find(std::string(name) + ": "), std::string::npos)
          << context.error().message();
    }
  }
  EXPECT_EQ(raster::create_context(raster::Backend::egl).has_value(), made > 0);
}

TEST(Context, OneOfThemIsAlwaysThere) {
  const auto context = raster::create_context(raster::Backend::automatic);
  ASSERT_TRUE(context.has_value()) << context.error().message();
}

// Two contexts side by side: each renderer has its own function table and makes its context current.
TEST(Context, RenderersOfBothBackendsDoNotDisturbEachOther) {
  auto egl = raster::create_context(raster::Backend::egl);
  if (!egl) GTEST_SKIP() << egl.error().message();
  Scene scene = still_life();
  scene.lights = {sun({-0.5, -1.0, -0.6})};
  Drawn first = draw(scene);
  const auto renderer = raster::Renderer::create(std::move(*egl), *first.world, plan_effects(*first.scene));
  ASSERT_TRUE(renderer.has_value()) << renderer.error().message();
  const std::vector<std::uint32_t> lights{0};
  const auto second = (*renderer)->render(first.frame.options, lights);
  ASSERT_TRUE(second.has_value()) << second.error().message();
  const auto before = first.frame.color.data;
  first.render(first.frame.options);
  EXPECT_EQ(first.frame.color.data, before);
  std::size_t different = 0;
  for (std::size_t i = 0; i < before.size(); ++i)
    different += first.frame.primitive.data[i] != second->primitive.data[i];
  EXPECT_LE(different, before.size() / 1000) << "drivers may differ on pixels that an edge passes";
}

TEST(Context, MessagesBecomeErrors) {
  const auto context = software_context();
  ASSERT_NE(context, nullptr);
  ASSERT_TRUE(context->make_current());
  auto gl = raster::Gl::load(*context);
  ASSERT_TRUE(gl.has_value());
  EXPECT_TRUE((*gl)->check("nothing").has_value());
  (**gl)->Enable(GL_TEXTURE_CUBE_MAP_POSITIVE_X);
  const auto checked = (*gl)->check("a wrong call");
  ASSERT_FALSE(checked.has_value());
  EXPECT_EQ(checked.error().kind, ErrorKind::graphics);
  EXPECT_NE(checked.error().reason.find("a wrong call: OpenGL says: invalid enum"), std::string::npos)
      << checked.error().reason;
  EXPECT_NE(checked.error().reason.find("glEnable"), std::string::npos)
      << "the debug message is missing: " << checked.error().reason;
  EXPECT_TRUE((*gl)->check("afterwards").has_value());
}

}  // namespace
}  // namespace gnomon::test
