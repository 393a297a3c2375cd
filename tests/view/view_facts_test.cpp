// What the lab's page is told: the same formats that the loader reads and the help names, and each group of settings once, in the
// panel's order.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "lab/lab_options.h"
#include "lab/serve/lab_facts.h"
#include "raster/settings.h"
#include "scene/load.h"
#include "tests/support/temporary_folder.h"

namespace gnomon::lab {
namespace {

TEST(LabFacts, HaveTheFormatsThatAreRead) {
  const auto facts = nlohmann::json::parse(lab_facts({}, false));
  const auto extensions = facts["extensions"].get<std::vector<std::string>>();
  EXPECT_TRUE(std::ranges::count(extensions, ".3mf") == 1 && std::ranges::count(extensions, ".usd") == 0);
  const test::TemporaryFolder folder;
  for (const std::string& extension : extensions) {
    const auto loaded = load_scene(folder.put("nothing" + extension, "x"));
    ASSERT_FALSE(loaded);
    EXPECT_EQ(loaded.error().reason.find("unknown extension"), std::string::npos) << extension;
  }
  const auto other = load_scene(folder.put("nothing.usd", "x"));
  EXPECT_NE(other.error().reason.find(extensions_text()), std::string::npos) << other.error().reason;
  EXPECT_EQ(extensions_text(), extensions_text(false) + " " + extensions_text(true));
}

TEST(LabFacts, HaveEachGroupOnceInThePanelsOrder) {
  const auto facts = nlohmann::json::parse(lab_facts({}, false));
  std::vector<std::string> groups, wanted;
  for (const auto& setting : facts["settings"])
    if (groups.empty() || groups.back() != setting["group"]) groups.push_back(setting["group"]);
  for (const raster::SettingGroup group : raster::panel_groups)
    wanted.emplace_back(raster::group_title(group));
  EXPECT_EQ(groups, wanted);
  EXPECT_EQ(facts["settings"].size(), raster::map_settings().size()) << "every group is in the panel";
}

}  // namespace
}  // namespace gnomon::lab
