// Which files of a shader folder count as those that decide the visibility.
#include "raster/programs/shader_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace gnomon::raster {
namespace {

/// Returns the shaders that count where the folder holds one file, the program's own with a comment behind it.
std::vector<std::string> counted(const std::string& name, Technique technique) {
  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / "gnomon-custom-shader";
  std::filesystem::create_directories((folder / name).parent_path());
  const std::vector<ShaderFile> own = own_shaders();
  const auto file =
      std::find_if(own.begin(), own.end(), [&](const ShaderFile& each) { return each.name == name; });
  EXPECT_NE(file, own.end()) << name;
  if (file == own.end()) return {};
  std::ofstream(folder / name) << file->text << "// mine\n";
  const auto read = ShaderFolder::read(folder.string());
  std::filesystem::remove_all(folder);
  EXPECT_TRUE(read.has_value()) << name;
  if (!read) return {};
  MapOptions map;
  map.technique = technique;
  const auto custom = custom_shader(*read, map, Light{});
  return custom ? custom->files : std::vector<std::string>{};
}

TEST(CustomShaderFiles, AreThoseThatDecideTheVisibility) {
  using Files = std::vector<std::string>;
  for (const char* name : {"technique/hard.glsl", "gap.glsl", "light.glsl", "light_map.glsl", "shade.frag"})
    EXPECT_EQ(counted(name, Technique::hard), Files{name});
  for (const char* name : {"moments.frag", "moments.glsl", "moment_lookup.glsl", "blur.frag"})
    EXPECT_EQ(counted(name, Technique::vsm), Files{name});
  for (const char* name :
       {"technique/izb.glsl", "izb/functions.glsl", "izb/insert.frag", "izb/triangle.vert"})
    EXPECT_EQ(counted(name, Technique::izb), Files{name});
  EXPECT_EQ(counted("blinn_phong.glsl", Technique::hard), Files{});
  EXPECT_EQ(counted("moments.frag", Technique::hard), Files{});
  EXPECT_EQ(counted("gap.glsl", Technique::hybrid), Files{});
}

}  // namespace
}  // namespace gnomon::raster
