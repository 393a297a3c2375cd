// gnomon sweep as a process: killed at any moment it goes on to the same bytes; shards merge to the same
// bytes; another configuration is refused; an interrupt leaves whole lines.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "compare/result/result_schema.h"
#include "tests/support/json_schema_check.h"
#include "tests/support/program_process.h"

namespace gnomon::test {
namespace {

/// These tests look at one sweep that was never interrupted, root/"whole"; it is made once, and each has a copy.
class WholeSweep : public SweepProgram {
 protected:
  void SetUp() override {
    static const TemporaryFolder made;
    const fs::path whole = fs::path(made.path()) / "whole";
    if (!fs::exists(whole / "sweep.json")) {
      ASSERT_EQ(run(words(whole.string())), 0) << said();
    }
    fs::copy(whole, root / "whole", fs::copy_options::recursive);
  }
};

std::vector<nlohmann::json> parsed_lines(const std::string& text) {
  std::istringstream stream(text);
  std::vector<nlohmann::json> results;
  for (std::string line; std::getline(stream, line);) results.push_back(nlohmann::json::parse(line));
  return results;
}

// Full records are whole results; what the usual ones lack belongs to the drawing.
TEST_F(WholeSweep, RecordsAreShortOrFull) {
  ASSERT_EQ(run(words("full", {"--full-records"})), 0) << said();
  gnomon::SchemaCheck schema(gnomon::compare::result_schema());
  std::vector<nlohmann::json> full = parsed_lines(lines("full")), usual = parsed_lines(lines("whole"));
  ASSERT_EQ(full.size(), usual.size());
  const nlohmann::json effects = full.front()["effects"];
  for (std::size_t i = 0; i < full.size(); ++i) {
    for (const std::string& problem : schema.violations(full[i])) ADD_FAILURE() << problem;
    EXPECT_EQ(full[i]["effects"], effects);
    EXPECT_TRUE(full[i]["times_ms"]["total"]["median"].is_null()) << "a line has no times";
    for (const char* key : {"effects", "timing", "times_ms"}) EXPECT_EQ(full[i].erase(key), 1u) << key;
    nlohmann::json& light = full[i]["lights"][0];
    for (const char* key : {"bias_curve", "engine_units", "times_ms"}) EXPECT_EQ(light.erase(key), 1u) << key;
    EXPECT_EQ(light["derived_bias"].erase("engine_units"), 1u);
    full[i].erase("checksum"), usual[i].erase("checksum");
    EXPECT_EQ(full[i], usual[i]);
  }
  EXPECT_EQ(nlohmann::json::parse(bytes_of(root / "whole/sweep.json"))["configuration"]["effects"], effects);
  EXPECT_EQ(untimed_table("full"), untimed_table("whole"));
  EXPECT_LT(4 * lines("whole").size(), lines("full").size());
  EXPECT_EQ(run(words("full")), 2) << "records of both kinds would stand in one file";
}

TEST_F(WholeSweep, WritesResultsWithAxes) {
  const std::vector<nlohmann::json> results = parsed_lines(lines("whole"));
  ASSERT_EQ(results.size(), 12u);
  EXPECT_EQ(results[5]["axes"].dump(), R"({"bias":0.0333333333333,"map_size":64})");
  EXPECT_EQ(results[5]["command"],
            "gnomon compare floating-box --size 96x54 --map-size 64 --bias 0.0333333333333");
  EXPECT_FALSE(results[5].contains("times_ms")) << "sweep_times.jsonl has them";

  // A cell's command gives the cell's numbers.
  ASSERT_EQ(run({"compare", "floating-box", "--size", "96x54", "--map-size", "64", "--bias",
                 "0.0333333333333", "--threads", "2", "-o", (root / "one").string()}),
            0)
      << said();
  nlohmann::json one = nlohmann::json::parse(bytes_of(root / "one/result.json"));
  nlohmann::json cell = results[5];
  for (nlohmann::json* json : {&one, &cell}) {
    (*json)["lights"][0].erase("times_ms");
    (*json)["lights"][0].erase("bias_kinds");       // other kinds of bias are looked at by compare alone
    (*json)["lights"][0].erase("ray_tests");        // and rays tried
    (*json)["lights"][0].erase("other_map_sizes");  // and maps of other sizes
    for (const char* drawn : {"bias_curve", "engine_units"})
      (*json)["lights"][0].erase(drawn);  // which only full records have
    (*json)["lights"][0]["derived_bias"].erase("engine_units");
    (*json)["lights"][0]["map"].erase("windows");  // and where each map lies
    (*json)["lights"][0]["error"].erase("flip");
    (*json)["lights"][0]["error"].erase("ssim");
    (*json)["lights"][0]["error"].erase("flip_compared");
    (*json)["lights"][0]["error"].erase("ssim_compared");
  }
  EXPECT_EQ(one["lights"], cell["lights"]);
  EXPECT_EQ(one["costs"], cell["costs"]);
}

// The schema, and with it the manual, says of each key that compare has and a cell lacks that it is not in sweep.jsonl.
TEST_F(SweepProgram, WhatCellsLackOfAComparisonIsDocumented) {
  const Words setting{"courtyard", "--technique", "csm", "--size", "64x48", "--map-size", "64"};
  Words sweep{"sweep"}, compare{"compare"};
  for (Words* words : {&sweep, &compare}) words->insert(words->end(), setting.begin(), setting.end());
  sweep.insert(sweep.end(), {"--bias", "1texel,2texel", "-o", (root / "cells").string()});
  compare.insert(compare.end(), {"--bias", "1texel", "--json", (root / "one.json").string()});
  ASSERT_EQ(run(sweep), 0) << said();
  ASSERT_EQ(run(compare), 0) << said();
  const nlohmann::json schema = gnomon::compare::result_schema();
  const std::string text = lines("cells");
  const nlohmann::json cell = nlohmann::json::parse(text.substr(0, text.find('\n')));
  const nlohmann::json one = nlohmann::json::parse(bytes_of(root / "one.json"));
  const auto check = [](const nlohmann::json& whole, const nlohmann::json& part, const nlohmann::json& keys) {
    int lacking = 0;
    for (const auto& [key, value] : whole.items()) {
      if (part.contains(key)) continue;
      ++lacking;
      EXPECT_TRUE(keys[key]["description"].get<std::string>().starts_with("not in sweep.jsonl")) << key;
    }
    return lacking;
  };
  EXPECT_EQ(check(one, cell, schema["properties"]), 6);
  EXPECT_EQ(check(one["lights"][0], cell["lights"][0], schema["$defs"]["light"]["properties"]), 5);
}

// The measure is what cells are ranked by, and a plain limit is one of it; the folder remembers it.
TEST_F(SweepProgram, RanksByTheMeasureThatWasChosen) {
  const std::string folder = (root / "measured").string();
  const Words sweep{"sweep", "fence", "--size", "64x36", "--map-size", "64,128,256", "-o", folder};
  const auto with = [&](const Words& more) {
    Words words = sweep;
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  ASSERT_EQ(run(with({"--measure", "edge", "--max-error", "1e6"})), 0) << said();
  EXPECT_NE(said().find("Cheapest with shadow edges displaced by at most 1000000 texels (RMS): "),
            std::string::npos)
      << said();
  EXPECT_NE(said().find("Best for edge error"), std::string::npos) << said();
  const std::string page = bytes_of(folder + "/report.html");
  EXPECT_NE(page.find(R"("measure":{"name":"edge","words":"edge error, texels","shares":false})"),
            std::string::npos);
  EXPECT_EQ(run(with({"--measure", "mean"})), 2) << "another sweep: " << said();
}

// Each cell's film is the one that gnomon shimmer makes, and its flips are the error of headline and table.
TEST_F(SweepProgram, CountsFlipsOfFilms) {
  const Words setting{"thin-wall", "--size", "192x108", "--map-size", "64"};
  const Words film{"--frames", "3", "--path", "drift", "--drift", "0.5,0.5"};
  const auto joined = [](Words all, const std::vector<Words>& more) {
    for (const Words& each : more) all.insert(all.end(), each.begin(), each.end());
    return all;
  };
  const std::string folder = (root / "films").string();
  ASSERT_EQ(
      run(joined(
          {"sweep"},
          {setting, film, {"--full-records", "--snap", "off,on", "--measure", "shimmer", "-o", folder}})),
      0)
      << said();
  EXPECT_NE(said().find("Best for flips"), std::string::npos) << said();
  gnomon::SchemaCheck schema(gnomon::compare::result_schema());
  std::istringstream stream(lines("films"));
  std::vector<nlohmann::json> cells;
  for (std::string line; std::getline(stream, line);) cells.push_back(nlohmann::json::parse(line));
  ASSERT_EQ(cells.size(), 2u);
  for (const nlohmann::json& cell : cells)
    for (const std::string& problem : schema.violations(cell)) ADD_FAILURE() << problem;
  const std::string alone = (root / "alone.json").string();
  ASSERT_EQ(run(joined({"shimmer"}, {setting, film, {"--json", alone, "-o", (root / "alone").string()}})), 0)
      << said();
  const nlohmann::json shimmer = nlohmann::json::parse(bytes_of(alone))["lights"][0];
  const nlohmann::json counted = cells[0]["lights"][0]["shimmer"];
  EXPECT_GT(counted["flips"], 0);
  for (const char* key : {"flips", "receiver_steps", "flips_per_receiver_second"})
    EXPECT_EQ(counted[key], shimmer[key]);
  EXPECT_EQ(cells[1]["lights"][0]["shimmer"]["flips"], 0);
  EXPECT_EQ(cells[1]["command"],
            "gnomon shimmer thin-wall --size 192x108 --map-size 64 --snap --frames 3 --path drift --drift "
            "0.5,0.5");
  EXPECT_NE(bytes_of(root / "films/sweep.csv").find("shimmer_flips_per_receiver_second"), std::string::npos);
  EXPECT_EQ(bytes_of(root / "films/report.html").find("\"flips_per_receiver_second\":null"),
            std::string::npos);
  EXPECT_EQ(run(joined({"sweep"}, {setting, film, {"-o", folder}})), 2) << "a film's options without a film";
}

TEST_F(WholeSweep, KilledAnywhereItEndsInTheSameBytes) {
  const auto begin = std::chrono::steady_clock::now();  // with warm caches
  ASSERT_EQ(run(words("timed")), 0) << said();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  // GNOMON_SWEEP_KILLS=200 for the thorough run.
  const char* asked = std::getenv("GNOMON_SWEEP_KILLS");
  const int kills = asked != nullptr ? std::atoi(asked) : 5;
  int died = 0;
  for (int i = 0; i < kills; ++i) {
    const std::string folder = "killed" + std::to_string(i);
    const pid_t child = start(words(folder), log());
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds * (i + 0.5) / kills));
    kill(child, SIGKILL);
    died += finish(child) == 128 + SIGKILL;
    ASSERT_EQ(run(words(folder)), 0) << said();
    expect_same("whole", folder);
    fs::remove_all(root / folder);
  }
  EXPECT_GT(died, 0);
}

// The ray tracer's own points: exact is wrong nowhere, and they survive merging and stand on the page.
TEST_F(SweepProgram, RayTracersPointsStandBesideTheCells) {
  ASSERT_EQ(run(words("part1", {"--shard", "1/2", "--ray-tracer"})), 0) << said();
  ASSERT_EQ(run(words("part2", {"--shard", "2/2", "--ray-tracer"})), 0) << said();
  EXPECT_FALSE(fs::exists(root / "part2/ray_tracer.json"));
  ASSERT_EQ(
      run({"merge", (root / "part1").string(), (root / "part2").string(), "-o", (root / "merged").string()}),
      0)
      << said();
  const nlohmann::json points = nlohmann::json::parse(bytes_of(root / "merged/ray_tracer.json"))["points"];
  ASSERT_EQ(points.size(), 3u);
  EXPECT_EQ(points[0]["name"], "fast");
  EXPECT_EQ(points[2]["name"], "exact");
  EXPECT_EQ(points[2]["wrong"], 0);
  EXPECT_EQ(points[2]["uncertain"], 0);
  for (const auto& point : points) {
    EXPECT_GT(point["compared"], 96 * 54 / 4);
    EXPECT_GT(point["rays"], 96 * 54);
    EXPECT_GT(point["boxes_per_ray"], 1.0);
    EXPECT_GT(point["times_ms"]["median"], 0.0);
  }
  const std::string page = bytes_of(root / "merged/report.html");
  EXPECT_NE(page.find(R"("rays":[{"name":"fast",)"), std::string::npos);
}

TEST_F(WholeSweep, ShardsMergeToTheSameBytes) {
  ASSERT_EQ(run(words("part1", {"--shard", "1/2"})), 0) << said();
  const auto merge = [&](const Words& folders) {
    Words all{"merge"};
    for (const std::string& folder : folders) all.push_back((root / folder).string());
    all.insert(all.end(), {"-o", (root / "merged").string()});
    return run(all);
  };
  EXPECT_EQ(merge({"part1"}), 2);
  EXPECT_NE(said().find("8 of 12 cells are there"), std::string::npos) << said();
  ASSERT_EQ(run(words("part2", {"--shard", "2/2"})), 0) << said();
  ASSERT_EQ(merge({"part2", "part1"}), 0) << said();
  expect_same("whole", "merged");
  EXPECT_EQ(bytes_of(root / "whole/sweep.json"), bytes_of(root / "merged/sweep.json"));
  for (const auto& entry : fs::directory_iterator(root / "whole/thumbnails"))
    EXPECT_TRUE(bytes_of(entry.path()) == bytes_of(root / "merged/thumbnails" / entry.path().filename()));
  EXPECT_FALSE(bytes_of(root / "merged/report.html").empty());
}

// An option of one technique is an axis of all: where it has no effect the cell says so, its command leaves
// it out, and its numbers are those of its neighbour.
TEST_F(SweepProgram, AnAxisThatATechniqueDoesNotReadIsNamed) {
  const auto sweep = [&](const std::string& folder, const Words& more) {
    Words all{
        "sweep",    "floating-box",    "--size", "96x54",     "--map-size", "64", "--technique",
        "hard,pcf", "--filter-radius", "1,2",    "--threads", "2",          "-o", (root / folder).string()};
    all.insert(all.end(), more.begin(), more.end());
    return run(all);
  };
  ASSERT_EQ(sweep("whole", {"--full-records"}), 0) << said();
  gnomon::SchemaCheck schema(gnomon::compare::result_schema());
  std::istringstream stream(lines("whole"));
  std::vector<nlohmann::json> cells;
  for (std::string line; std::getline(stream, line);) {
    cells.push_back(nlohmann::json::parse(line));
    for (const std::string& problem : schema.violations(cells.back())) ADD_FAILURE() << problem;
  }
  ASSERT_EQ(cells.size(), 4u);
  const std::string base = "gnomon compare floating-box --size 96x54 --map-size 64 --technique ";
  EXPECT_EQ(cells[1]["command"], base + "hard --bias auto")
      << "the scene asks for a texel, and was not heeded";
  EXPECT_EQ(cells[1]["no_effect"].dump(), R"(["filter_radius"])");
  EXPECT_EQ(cells[0]["lights"], cells[1]["lights"]);
  EXPECT_EQ(cells[3]["command"], base + "pcf --filter-radius 2");
  EXPECT_FALSE(cells[3].contains("no_effect"));
  EXPECT_NE(cells[2]["lights"], cells[3]["lights"]);
  EXPECT_NE(bytes_of(root / "whole/report.html").find(R"("no_effect":["filter_radius"])"), std::string::npos);
  EXPECT_NE(bytes_of(root / "whole/sweep.csv").find(",no_effect,"), std::string::npos);
  ASSERT_EQ(sweep("part1", {"--full-records", "--shard", "1/2"}), 0) << said();
  ASSERT_EQ(sweep("part2", {"--full-records", "--shard", "2/2"}), 0) << said();
  ASSERT_EQ(
      run({"merge", (root / "part1").string(), (root / "part2").string(), "-o", (root / "merged").string()}),
      0)
      << said();
  expect_same("whole", "merged");
}

// A stand-in for sbatch that runs the array's tasks one after another shows what the script does; whether
// Slurm itself takes it is the next test.
TEST_F(WholeSweep, SlurmScriptMakesTheShards) {
  fs::create_directories(root / "bin");
  std::ofstream(root / "bin/sbatch")
      << "#!/bin/sh\nset -e\nfor word in \"$@\"; do case $word in --array=1-*) "
         "n=${word#--array=1-};; --*) ;; *) script=$word;; esac; done\n"
         "for i in $(seq $n); do SLURM_ARRAY_TASK_ID=$i sh \"$script\"; done\n";
  fs::permissions(root / "bin/sbatch", fs::perms::owner_all);
  const std::string path = std::getenv("PATH");
  setenv("PATH", ((root / "bin").string() + ":" + path).c_str(), 1);
  const int code = run(words("array", {"--slurm", "2"}));
  setenv("PATH", path.c_str(), 1);
  ASSERT_EQ(code, 0) << said();
  expect_same("whole", "array");
}

/// A real Slurm of one node, for as long as this lives; not running where it cannot.
class PrivateSlurm {
 public:
  explicit PrivateSlurm(const fs::path& folder) : folder_(folder.string()) {
    const int status =
        std::system((command("start") + " >" + folder_ + ".conf 2>" + folder_ + ".log").c_str());
    std::ifstream conf(folder_ + ".conf");
    std::string path;
    running = status == 0 && std::getline(conf, path);
    if (running) setenv("SLURM_CONF", path.c_str(), 1);
  }
  ~PrivateSlurm() {
    unsetenv("SLURM_CONF");
    if (std::system(command("stop").c_str()) != 0) std::perror("private_slurm.sh stop");
  }
  PrivateSlurm(const PrivateSlurm&) = delete;
  PrivateSlurm& operator=(const PrivateSlurm&) = delete;
  std::string why_not() const { return bytes_of(folder_ + ".log"); }
  bool running = false;

 private:
  std::string command(const std::string& action) const {
    return "sh " + gnomon::test::source_dir() + "/tests/support/private_slurm.sh " + action + " " + folder_;
  }
  std::string folder_;
};

TEST_F(WholeSweep, SlurmTakesTheArray) {
  const PrivateSlurm slurm(root / "slurm");
  if (!slurm.running) GTEST_SKIP() << slurm.why_not();
  ASSERT_EQ(run(words("array", {"--slurm", "2"})), 0) << said();
  expect_same("whole", "array");
  EXPECT_TRUE(fs::exists(root / "array/slurm-1.log"));

  // A task that fails is told apart from one that is done.
  EXPECT_EQ(run({"sweep", (root / "none.json").string(), "--bias", "0,1", "--slurm", "2", "-o",
                 (root / "broken").string()}),
            5)
      << said();
  EXPECT_NE(said().find("the job array failed"), std::string::npos) << said();
}

TEST_F(WholeSweep, TornLastLineIsMadeAnew) {
  fs::copy(root / "whole", root / "torn", fs::copy_options::recursive);
  fs::resize_file(root / "torn/sweep.jsonl", lines("whole").size() - 100);
  ASSERT_EQ(run(words("torn")), 0);
  EXPECT_NE(said().find("torn"), std::string::npos);
  expect_same("whole", "torn");
}

TEST_F(WholeSweep, RefusesAnotherConfiguration) {
  const std::string before = lines("whole");
  EXPECT_EQ(run(words("whole", {"--slope-bias", "1"})), 2);
  EXPECT_NE(said().find("holds another sweep"), std::string::npos) << said();
  EXPECT_EQ(lines("whole"), before);
  EXPECT_EQ(run(words("whole", {"--slope-bias", "1", "--restart"})), 0) << said();
  EXPECT_NE(lines("whole"), before);
}

TEST_F(SweepProgram, TwoBackendsAreNotMixedWithoutAWord) {
  const auto part = [&](const char* folder, const char* shard, const char* backend) {
    return run(words(folder, {"--shard", shard, "--backend", backend}));
  };
  if (part("part1", "1/2", "osmesa") != 0 || part("part2", "2/2", "egl-software") != 0)
    GTEST_SKIP() << "one backend alone: " << said();
  fs::resize_file(root / "part1/sweep.jsonl", lines("part1").size() - 100);
  EXPECT_EQ(part("part1", "1/2", "egl-software"), 2);
  EXPECT_NE(said().find("were drawn by osmesa"), std::string::npos) << said();
  EXPECT_EQ(part("part1", "1/2", "osmesa"), 0) << said();
  EXPECT_EQ(
      run({"merge", (root / "part1").string(), (root / "part2").string(), "-o", (root / "all").string()}), 0);
  EXPECT_NE(said().find("not all cells were drawn alike: egl-software"), std::string::npos) << said();
}

TEST_F(WholeSweep, InterruptLeavesWholeLines) {
  const pid_t child = start(words("stopped"), log());
  while (lines("stopped").empty()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  kill(child, SIGINT);
  const int code = finish(child);
  EXPECT_TRUE(code == 130 || code == 0) << code;  // 0: it was done before the signal came
  const std::string part = lines("stopped");
  EXPECT_TRUE(lines("whole").starts_with(part) && part.ends_with('\n'));
  ASSERT_EQ(run(words("stopped")), 0);
  expect_same("whole", "stopped");
}

TEST_F(SweepProgram, SweepNamesItsBestCells) {
  ASSERT_EQ(run(words("whole", {"--max-error", "wrong:100%"})), 0) << said();
  const std::string out = said();
  EXPECT_NE(out.find("Cheapest with at most 100 % wrong: cell "), std::string::npos) << out;
  EXPECT_NE(out.find("Best for "), std::string::npos) << out;
  EXPECT_NE(bytes_of(root / "whole/report.html")
                .find(R"("headline":[{"title":"Cheapest with at most 100 % wrong","cell":)"),
            std::string::npos);
  EXPECT_EQ(run(words("whole", {"--max-error", "0"})), 1) << said();
  EXPECT_NE(said().find("No cell has at most 0 % wrong"), std::string::npos) << said();
}

// The same columns, but for a cell's own.
TEST_F(WholeSweep, TablesOfSweepAndCompareHaveOneSetOfColumns) {
  ASSERT_EQ(run({"compare", "floating-box", "--size", "96x54", "-o", (root / "one").string()}), 0) << said();
  const auto columns = [](const std::string& table) {
    std::istringstream head(table.substr(0, table.find('\r')));
    std::set<std::string> names;
    for (std::string name; std::getline(head, name, ',');) names.insert(name);
    return names;
  };
  std::set<std::string> sweep = columns(bytes_of(root / "whole/sweep.csv"));
  const std::set<std::string> one = columns(bytes_of(root / "one/result.csv"));
  for (const char* own : {"cell", "axes_map_size", "axes_bias", "derived", "cell_ms", "load"})
    EXPECT_EQ(sweep.erase(own), 1u) << own;
  for (const std::string& name : sweep) EXPECT_EQ(one.count(name), 1u) << name << " is in sweep.csv alone";
  for (const char* timed : {"times_ms_map_pass_median", "times_ms_shade_pass_median",
                            "times_ms_shadow_rays_median", "times_ms_primary_rays_median"})
    EXPECT_EQ(sweep.count(timed), 1u) << timed;
}

// What shadows cost is told apart from what the picture costs, on both sides.
TEST_F(SweepProgram, ShadowsAreTimedApartFromThePicture) {
  ASSERT_EQ(run(words("whole", {"--ray-tracer"})), 0) << said();
  const std::string page = bytes_of(root / "whole/report.html");
  std::istringstream stream(bytes_of(root / "whole/sweep_times.jsonl"));
  int lines_of_times = 0;
  for (std::string line; std::getline(stream, line);) {
    const nlohmann::json cell = nlohmann::json::parse(line);
    EXPECT_EQ(cell["cell"], lines_of_times++ % 12) << "all cells once, then all again";
    EXPECT_GE(cell["load"], 0.0);
    EXPECT_FALSE(cell["lights"][0]["shading_strips"].empty());
  }
  EXPECT_EQ(lines_of_times, 36);
  std::istringstream table(bytes_of(root / "whole/sweep.csv"));
  std::vector<std::map<std::string, std::string>> rows;
  std::vector<std::string> heads;
  for (std::string line; std::getline(table, line);) {
    std::istringstream fields(line.substr(0, line.find('\r')));
    std::vector<std::string> values;
    for (std::string value; std::getline(fields, value, ',');) values.push_back(value);
    if (heads.empty()) {
      heads = values;
      continue;
    }
    auto& row = rows.emplace_back();
    for (std::size_t i = 0; i < values.size(); ++i) row[heads[i]] = values[i];
  }
  ASSERT_EQ(rows.size(), 12u);
  for (auto& row : rows) {
    const auto ms = [&](const std::string& key) { return std::stod(row.at("times_ms_shadows_" + key)); };
    EXPECT_LE(ms("nothing_moves_map_low"), ms("nothing_moves_map"));
    EXPECT_LE(ms("nothing_moves_map"), ms("nothing_moves_map_high"));
    EXPECT_NEAR(ms("light_moves_map"),
                ms("nothing_moves_map") + std::stod(row.at("times_ms_map_pass_median")), 1e-6);
    EXPECT_EQ(ms("light_moves_rays"), ms("nothing_moves_rays"));
    EXPECT_NEAR(ms("casters_move_rays"),
                ms("light_moves_rays") + std::stod(row.at("times_ms_accel_build_median")), 1e-6);
    EXPECT_NE(page.find("," + row.at("times_ms_shadows_light_moves_map") + ","), std::string::npos);
  }
  const nlohmann::json points = nlohmann::json::parse(bytes_of(root / "whole/ray_tracer.json"))["points"];
  EXPECT_FALSE(points.empty());
  for (const nlohmann::json& point : points) {
    EXPECT_GT(point["shadow_times_ms"]["median"], 0.0);
    EXPECT_LT(point["shadow_times_ms"]["median"], point["times_ms"]["median"]);
  }
}

TEST_F(SweepProgram, UsageErrors) {
  const std::vector<std::pair<Words, std::string>> wrong = {
      {{"--bias", "0:1"}, "--bias: not a range (got 0:1, allowed START:END:COUNT"},
      {{"--map-size", "128,0"}, "(got 0, allowed 1 to 65536)"},
      {{"--shard", "3/2"}, "--shard"},
      {{"--receiver-plane", "maybe"}, "--receiver-plane"},
      {{"--map-size", "1,2", "--bias", "0,1,2", "--zip"}, "one length"}};
  for (const auto& [axes, part] : wrong) {
    Words sweep{"sweep", "floating-box"};
    sweep.insert(sweep.end(), axes.begin(), axes.end());
    EXPECT_EQ(run(sweep), 2) << part;
    EXPECT_NE(said().find(part), std::string::npos) << said();
  }
}

}  // namespace
}  // namespace gnomon::test
