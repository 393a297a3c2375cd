// What compare says of a scene holds where it is followed, and where it is asked in another way.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/support/app_process.h"

namespace gnomon::app_test {
namespace {

/// Returns what result.json says of the scene's only light.
nlohmann::json light_of(const Words& words) {
  const ProcessResult result = run_gnomon(Words{"compare", "--json", "-", "--runs", "1", "--quiet"} + words);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return nlohmann::json::parse(result.out).at("lights").at(0);
}

Words words_of(const std::string& text) {
  std::istringstream in(text);
  Words words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

// A lesson that sets a bias of its own, one that sets a slope, and a bias given in every way. A driver's floats may part
// from the doubles that the promise is made from in one pixel of a thousand (BiasKinds.AreWhatTheyDraw).
TEST(Answers, EachKindOfBiasLeavesWhatItPromises) {
  struct Case {
    Words scene, bias;
  };
  const Case cases[] = {
      {{"peter-panning"}, {}},
      {{"precision"}, {}},
      {{"peter-panning"}, {"--caster-bias", "4texel", "--caster-slope-bias", "2"}},
      {{"fence"}, {"--slope-bias", "3", "--normal-offset", "2", "--receiver-plane", "--bias", "4texel"}}};
  for (const Case& c : cases) {
    const Words scene = c.scene + Words{"--size", "160x90", "--map-size", "256"};
    const nlohmann::json kinds = light_of(scene + c.bias).at("bias_kinds");
    ASSERT_GE(kinds.size(), 4u);
    for (const nlohmann::json& kind : kinds) {
      const auto options = kind.at("options").get<std::string>();
      EXPECT_NEAR(light_of(scene + words_of(options)).at("error").at("wrong_fraction").get<double>(),
                  kind.at("wrong_fraction").get<double>(), 1e-3)
          << c.scene[0] << ": " << options;
    }
  }
}

// Exact arithmetic settles what is ambiguous. Where nothing is, what pixels are called is the same.
TEST(Answers, ExactArithmeticChangesNoLabel) {
  const Words fence = {"fence", "--size", "160x90"};
  const nlohmann::json robust = light_of(fence), exact = light_of(fence + Words{"--precision", "exact"});
  ASSERT_EQ(robust.at("pixels").at("uncertain"), 0);
  EXPECT_GT(robust.at("classes").at("peter_panning"), 0);
  EXPECT_EQ(exact.at("classes"), robust.at("classes"));
}

// Both sides of a shape have its number: the one that culling leaves is no matter of the stored depth's precision.
TEST(Answers, CullingAShapesFrontIsNoMatterOfPrecision) {
  for (const Words& culled : {Words{"--technique", "second-depth"}, Words{"--cull", "front"}}) {
    const nlohmann::json light = light_of(Words{"shapes", "--size", "160x90"} + culled);
    EXPECT_EQ(light.at("classes").at("precision"), 0) << culled[1];
    for (const nlohmann::json& step : light.at("budget"))
      if (step.at("cause") == "precision") {
        EXPECT_LT(step.at("absolute"), 1e-3) << culled[1];
      }
  }
}

// The float truth is wrong somewhere, which the light's size cannot be the reason of.
TEST(Answers, ALightWithoutSizeIsNoReason) {
  for (const char* technique : {"hybrid", "izb"}) {
    const nlohmann::json light =
        light_of({"fence", "--size", "320x180", "--precision", "fast", "--technique", technique});
    EXPECT_GT(light.at("error").at("wrong"), 0) << technique;
    EXPECT_EQ(light.at("classes").at("light_size"), 0) << technique;
    EXPECT_EQ(light.at("budget").at(0).at("absolute"), 0.0) << technique;
    EXPECT_TRUE(light.at("map").at("bias").at("constant_world").is_null()) << technique << " has no bias";
    EXPECT_EQ(light.at("map").at("bias").at("slope"), 0.0) << technique;
  }
}

TEST(Answers, AnOptionThatIsOffAsksForNothing) {
  const auto map_with = [](const Words& options) {
    return light_of(Words{"fence", "--size", "32x18", "--map-size", "64"} + options).at("map");
  };
  const Words csm{"--technique", "csm"};
  EXPECT_EQ(map_with(csm + Words{"--no-snap=off"}).at("cascades").at("snap"), true);
  EXPECT_EQ(map_with(csm + Words{"--no-snap"}).at("cascades").at("snap"), false);
  for (const char* option : {"--receiver-plane=off", "--adaptive-bias=off"})
    EXPECT_EQ(map_with({option}).at("bias").at("slope"), 1.0) << option;
}

TEST(Answers, WhatTessellationLeavesAsItIsIsSaid) {
  const TemporaryFolder folder;
  const auto said = [&](const std::string& scene) {
    const Words words{"raytrace", scene, "--size", "8x8", "--tessellate", "8", "-o", folder / "x.png"};
    return run_gnomon(words).err.find("--tessellate has no effect") != std::string::npos;
  };
  EXPECT_TRUE(said("fence")) << "its one exact shape is a plane";
  EXPECT_FALSE(said("sphere-plane"));
}

// A picture small enough to be its own forecast: with the ray that finds the glass that the eye is in.
TEST(Answers, RaytraceCastsWhatPlanCounts) {
  const TemporaryFolder folder;
  const Words whitted{"whitted", "--size", "64x36"};
  const auto json = [](const ProcessResult& run) { return nlohmann::json::parse(run.out); };
  const nlohmann::json plan = json(run_gnomon(Words{"plan"} + whitted + Words{"--json", "-"})).at("rays");
  ASSERT_EQ(plan.at("exact"), true);
  const nlohmann::json costs =
      json(run_gnomon(Words{"raytrace"} + whitted + Words{"--json", "-", "-o", folder / "x.png"}))
          .at("costs");
  std::uint64_t cast = 0;
  for (const auto& [name, count] : costs.items())
    if (name != "soft_shadow_rays_asked") cast += count.get<std::uint64_t>();
  EXPECT_EQ(cast, plan.at("total"));
}

constexpr const char* looks_away = R"({"schema": "gnomon/scene/1",
    "camera": {"eye": [4, 4, 8], "target": [8, 8, 16]},
    "lights": [{"name": "sun", "type": "directional", "direction": [-1, -2, -0.5]}],
    "materials": [{"name": "m"}],
    "meshes": [{"name": "floor", "vertices": [[-5, 0, -5], [5, 0, -5], [5, 0, 5], [-5, 0, 5]],
                "triangles": [[0, 2, 1], [0, 3, 2]]}],
    "instances": [{"mesh": "floor", "material": "m"}]})";

// The camera looks away from all there is: nothing is compared, and nothing is wrong with the scene.
// Each of 64 surfaces of glass may split a ray in two: somebody has to say so before the picture is begun. The camera looks
// away, so that there is none to wait for.
TEST(Answers, RaytraceSaysThatGlassMayTakeDays) {
  const TemporaryFolder folder;
  write_text(
      folder / "glass.json",
      R"({"schema": "gnomon/scene/1", "max_depth": 64, "camera": {"eye": [0, 1, 5], "target": [0, 1, 9]},
                 "lights": [{"name": "sun", "type": "directional", "direction": [-1, -2, -1]}],
                 "materials": [{"name": "glass", "transmission": 0.9}],
                 "shapes": [{"name": "ball", "sphere": {"center": [0, 1, 0], "radius": 1}, "material": "glass"}]})");
  const Words words{"raytrace", folder / "glass.json", "--size", "16x9", "-o", folder / "glass.png"};
  const ProcessResult all = run_gnomon(words + Words{"--min-contribution", "0"});
  EXPECT_EQ(all.exit_code, 0) << all.err;
  EXPECT_NE(all.err.find("Glass may take up to 3e+21 rays"), std::string::npos) << all.err;
  EXPECT_EQ(run_gnomon(words).err.find("Glass may take"), std::string::npos);
}

TEST(Answers, ACameraThatSeesNothing) {
  const TemporaryFolder folder;
  write_text(folder / "away.json", looks_away);
  for (const char* technique : {"hard", "csm", "lispsm", "izb", "hybrid"}) {
    const nlohmann::json light =
        light_of({folder / "away.json", "--size", "64x36", "--technique", technique});
    EXPECT_EQ(light.at("pixels").at("compared"), 0) << technique;
    EXPECT_EQ(light.at("pixels").at("background"), 64 * 36) << technique;
  }
}

constexpr const char* one_point = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"mode":0}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":1,"type":"VEC3","min":[0,0,0],"max":[0,0,0]}],
"bufferViews":[{"buffer":0,"byteLength":12}],
"buffers":[{"byteLength":12,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAA"}]})";

// The ground that is made for a bare model says nothing about a file that draws nothing.
TEST(Answers, NoLimitIsKeptByAFileThatDrawsNothing) {
  const TemporaryFolder folder;
  write_text(folder / "point.gltf", one_point);
  const Words plain{"compare", folder / "point.gltf", "--size", "64x36", "-o", folder / "out"};
  EXPECT_EQ(run_gnomon(plain).exit_code, 0);
  Words limited = plain;
  limited.insert(limited.end(), {"--fail-above", "1%"});
  const ProcessResult compared = run_gnomon(limited);
  EXPECT_EQ(compared.exit_code, 1);
  EXPECT_NE(compared.err.find("the file has no triangles, so nothing holds against --fail-above 1%"),
            std::string::npos)
      << compared.err;
  const nlohmann::json result = nlohmann::json::parse(read_file(folder / "out/result.json"));
  EXPECT_EQ(result.at("fail_above").at("failed"), true);
}

// Who asks for a limit wants to know that it was kept.
TEST(Answers, NoLimitIsKeptWhereNothingIsCompared) {
  const TemporaryFolder folder;
  write_text(folder / "away.json", looks_away);
  const auto run = [&](const Words& command) {
    return run_gnomon(Words{command[0], folder / "away.json", "--size", "64x36"} +
                      Words(command.begin() + 1, command.end()));
  };
  EXPECT_EQ(run({"compare", "-o", folder / "out"}).exit_code, 0);
  const ProcessResult compared = run({"compare", "-o", folder / "out", "--fail-above", "1%"});
  EXPECT_EQ(compared.exit_code, 1);
  EXPECT_NE(compared.err.find("no pixel could be compared, so nothing holds against --fail-above 1%"),
            std::string::npos)
      << compared.err;
  const nlohmann::json result = nlohmann::json::parse(read_file(folder / "out/result.json"));
  EXPECT_EQ(result.at("fail_above").at("failed"), true);
  const ProcessResult filmed =
      run({"shimmer", "--frames", "3", "-o", folder / "film", "--fail-above", "0.1"});
  EXPECT_EQ(filmed.exit_code, 1);
  EXPECT_NE(filmed.err.find("no receiver could be compared"), std::string::npos) << filmed.err;
  const ProcessResult tuned = run({"tune", "--max-error", "1%", "--map-size", "64"});
  EXPECT_EQ(tuned.exit_code, 3);
  EXPECT_NE(tuned.err.find("no pixel can be compared"), std::string::npos) << tuned.err;
  const ProcessResult measured =
      run_gnomon({"bench", "--techniques", folder / "away.json", "--size", "32x18", "--map-size", "32"});
  EXPECT_EQ(measured.exit_code, 3);
  EXPECT_NE(measured.err.find("no pixel can be compared"), std::string::npos) << measured.err;
  const ProcessResult swept =
      run({"sweep", "--map-size", "64,128", "--max-error", "1%", "-o", folder / "sweep"});
  EXPECT_EQ(swept.exit_code, 1);
  EXPECT_NE(swept.out.find("No pixel could be compared in any cell."), std::string::npos) << swept.out;
}

// A sun's map is one picture, a point light's six: each light's work is its own.
TEST(Answers, TheWorkOfALightIsThatOfItsOwnMap) {
  const TemporaryFolder folder;
  write_text(folder / "two.json", R"({"schema": "gnomon/scene/1",
    "camera": {"eye": [0, 4, 8], "target": [0, 0, 0]},
    "lights": [{"name": "sun", "type": "directional", "direction": [-1, -2, -0.5]},
               {"name": "lamp", "type": "point", "position": [1, 3, 1]}],
    "materials": [{"name": "m"}],
    "meshes": [{"name": "floor", "generate": {"kind": "floor", "size": [8, 8]}},
               {"name": "box", "generate": {"kind": "box"}}],
    "instances": [{"mesh": "floor", "material": "m"}, {"mesh": "box", "material": "m"}]})");
  const ProcessResult result =
      run_gnomon({"compare", "-v", folder / "two.json", "--size", "64x36", "--map-size", "128", "--runs", "1",
                  "--no-report", "-o", folder / "out"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find(" 16,384 texels drawn"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find(" 98,304 texels drawn"), std::string::npos) << result.out;
}

}  // namespace
}  // namespace gnomon::app_test
