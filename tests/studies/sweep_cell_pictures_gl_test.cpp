// A sweep's pictures are written by several threads at once: whichever comes first, every cell names its
// truth.
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <future>
#include <iterator>
#include <thread>

#include "studies/commands/make_cells.h"
#include "studies/sweep/cell_files.h"
#include "tests/support/one_world.h"
#include "tests/support/small_scenes.h"
#include "tests/support/temporary_folder.h"

namespace gnomon::test {
namespace {

namespace fs = std::filesystem;

TEST(CellPictures, EveryCellNamesItsTruthWhateverTheOrderOfTheJobs) {
  OneWorld world(test::boxes_under_three_lights());
  studies::Engine engine(world.scene, world.world, *world.renderer, false);
  compare::Setting setting;
  setting.raster.size = setting.raytrace.size = {64, 36};
  setting.raster.runs = 0;
  setting.camera = world.scene.camera;
  setting.lights = world.scene.lights;
  setting.compared = {0};
  const TemporaryFolder folder;
  app::CellPictureWriter writer(folder.path(), engine);
  ASSERT_TRUE(writer.make_folders());
  std::vector<app::CellPictureWriter::Job> jobs;
  for (std::size_t cell = 0; cell < 3; ++cell) {
    setting.raster.map.bias = {0.01 * static_cast<double>(cell), raster::BiasUnit::texel};
    const auto compared = engine.compare(setting, studies::Detail::numbers);
    ASSERT_TRUE(compared);
    jobs.push_back(writer.pictures(cell, **compared));
  }
  std::vector<std::future<Expected<void>>> written;
  for (std::size_t cell = jobs.size(); cell-- > 0;) {
    written.push_back(std::async(std::launch::async, jobs[cell]));
    std::this_thread::sleep_for(
        std::chrono::milliseconds(20));  // the later cells' jobs are well on their way
  }
  for (auto& job : written) {
    const auto done = job.get();
    EXPECT_TRUE(done) << done.error().message();
  }
  std::size_t truths = 0;
  std::string truth;
  for (const auto& file : fs::directory_iterator(studies::cells_folder(folder.path())))
    if (const std::string name = file.path().stem().string(); name.starts_with("truth-"))
      ++truths, truth = name;
  EXPECT_EQ(truths, 1u);
  for (std::size_t cell = 0; cell < jobs.size(); ++cell) {
    const std::string data =
        bytes_of(fs::path(studies::cells_folder(folder.path())) / (studies::cell_name(cell) + ".js"));
    EXPECT_NE(data.find("\"truth\":\"" + truth + '"'), std::string::npos)
        << "cell " << cell << ": " << data.substr(0, 120);
  }
}

}  // namespace
}  // namespace gnomon::test
