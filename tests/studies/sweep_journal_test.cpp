// The folder of a sweep: resumed byte for byte, torn lines cut off, foreign folders refused.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "studies/sweep/cell_files.h"
#include "studies/sweep/journal.h"
#include "studies/sweep/rounds.h"
#include "tests/support/temporary_folder.h"

namespace gnomon::studies {
namespace {

namespace fs = std::filesystem;

/// Returns the line as the journal keeps it.
std::string line(int cell) {
  return sealed(
      R"({"schema":"gnomon/result/1","lights":[{"light":{"name":"sun","type":"directional"},"error":{"wrong":)" +
      std::to_string(cell) +
      R"(},"budget":[],"ladder":[]}],"size":{"width":2,"height":1},"costs":{},"axes":{"bias":)" +
      std::to_string(cell) + "}}\n");
}
const std::string no_times = sealed("{\"cell\":0}\n");
Expected<void> append(Journal& journal, int cell) {
  nlohmann::ordered_json json = nlohmann::ordered_json::parse(line(cell));
  json.erase("checksum");
  return journal.append(json, {{"cell", 0}});
}
std::string axes(int cell) {
  return "{\"bias\":" + std::to_string(cell) + "}";
}

class JournalTest : public ::testing::Test {
 protected:
  Expected<Journal> open(const std::string& configuration = R"({"axes":[1]})") const {
    return Journal::open(folder, make_header(configuration, 3, {}), {axes(0), axes(1), axes(2)}, {0, 1, 2});
  }
  std::string bytes(const std::string& name) const { return test::bytes_of(folder + "/" + name); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder + "/" + name, std::ios::binary) << text;
  }
  const test::TemporaryFolder outer;
  const std::string folder = outer / "journal";
};

TEST_F(JournalTest, GoesOnWhereItStopped) {
  {
    auto journal = open();
    ASSERT_TRUE(journal) << journal.error().message();
    ASSERT_TRUE(append(*journal, 0));
  }
  auto journal = open();
  ASSERT_TRUE(journal) << journal.error().message();
  EXPECT_FALSE(journal->was_torn());
  ASSERT_EQ(journal->size(), 1u);
  ASSERT_TRUE(append(*journal, 1));
  EXPECT_EQ(bytes("sweep.jsonl"), line(0) + line(1));
  EXPECT_EQ(bytes("sweep.csv"),
            "cell,axes_bias,light,light_type,size_width,size_height,error_wrong\r\n"
            "0,0,sun,directional,2,1,0\r\n1,1,sun,directional,2,1,1\r\n");
}

// Every length that a crash can leave.
TEST_F(JournalTest, TornLastLineIsCutOff) {
  const std::string whole = line(0) + line(1);
  for (std::size_t length = 0; length <= whole.size(); ++length) {
    {
      auto journal = open();
      ASSERT_TRUE(journal);
    }
    write("sweep.jsonl", whole.substr(0, length));
    write("sweep_times.jsonl", no_times + no_times + "{\"cel");
    auto journal = open();
    ASSERT_TRUE(journal) << journal.error().message();
    const std::size_t kept = length == whole.size() ? 2 : (length >= line(0).size() ? 1 : 0);
    EXPECT_EQ(journal->size(), kept) << length;
    EXPECT_EQ(journal->was_torn(), length != 0 && length != line(0).size() && length != whole.size())
        << length;
    for (int cell = static_cast<int>(kept); cell < 3; ++cell) ASSERT_TRUE(append(*journal, cell));
    EXPECT_EQ(bytes("sweep.jsonl"), whole + line(2));
    EXPECT_EQ(bytes("sweep_times.jsonl"), no_times + no_times + no_times);
  }
}

TEST_F(JournalTest, ALineWithoutItsTimesIsMadeAgain) {
  ASSERT_TRUE(open());
  write("sweep.jsonl", line(0) + line(1));
  write("sweep_times.jsonl", no_times);
  auto journal = open();
  ASSERT_TRUE(journal);
  EXPECT_EQ(journal->size(), 1u);
}

/// The times of a cell, as they stand in a line of the first round.
nlohmann::ordered_json timed(std::size_t cell, double ms) {
  using Json = nlohmann::ordered_json;
  const Json once{{"median", ms}, {"runs", {ms}}};
  Json light{{"light", "sun"}};
  for (const char* pass : {"map_pass", "shade_pass", "unshadowed_pass", "exact_shadows"}) light[pass] = once;
  light["shading_strips"] = Json::array({{{"shade_pass", {ms}}, {"unshadowed_pass", {1.0}}}});
  return {{"cell", cell}, {"load", ms}, {"accel_build", once}, {"lights", Json::array({light})}};
}

nlohmann::ordered_json further(std::size_t cell, double ms) {
  raster::LightRecord drawn;
  drawn.map_pass.runs = drawn.shade_pass.runs = {ms};
  drawn.unshadowed_pass.runs = {1.0};
  drawn.strips = {{{{ms}}, {{1.0}}}};
  compare::MachineInfo machine;
  machine.load = ms;
  return round_json({drawn}, cell, machine);
}

// Rounds of times follow the cells, and go on where they stopped, in a torn line, too.
TEST_F(JournalTest, RoundsOfTimesGoOnWhereTheyStoppedAndAreJoined) {
  const auto of = [](int cell) {
    auto json = nlohmann::ordered_json::parse(line(cell));
    json.erase("checksum");
    return json;
  };
  {
    auto journal = open();
    ASSERT_TRUE(journal) << journal.error().message();
    for (int cell = 0; cell < 3; ++cell) ASSERT_TRUE(journal->append(of(cell), timed(cell, 10.0 + cell)));
    ASSERT_TRUE(journal->append_round(further(0, 20.0)));
  }
  write("sweep_times.jsonl", bytes("sweep_times.jsonl") + R"({"cell":1,"lo)");
  auto journal = open();
  ASSERT_TRUE(journal) << journal.error().message();
  EXPECT_EQ(journal->size(), 3u);
  EXPECT_EQ(journal->times_size(), 4u);
  ASSERT_TRUE(journal->append_round(further(1, 21.0)));
  ASSERT_TRUE(journal->append_round(further(2, 22.0)));
  for (int cell = 0; cell < 3; ++cell) ASSERT_TRUE(journal->append_round(further(cell, 30.0 + cell)));
  ASSERT_TRUE(journal->finish_rounds());
  const auto sweep = read_sweep(folder);
  ASSERT_TRUE(sweep) << sweep.error().message();
  EXPECT_EQ(sweep->rounds.size(), 9u);
  ASSERT_EQ(sweep->times.size(), 3u);
  const auto second = nlohmann::json::parse(sweep->times[1]);
  EXPECT_EQ(second["load"], 31.0) << "the most of its runs";
  const nlohmann::json& light = second["lights"][0];
  EXPECT_EQ(light["map_pass"]["runs"], (std::vector<double>{11.0, 21.0, 31.0}));
  EXPECT_EQ(light["map_pass"]["median"], 21.0);
  EXPECT_EQ(light["shading_strips"][0]["shade_pass"], (std::vector<double>{11.0, 21.0, 31.0}));
  EXPECT_EQ(light["shadow_lookups"]["median"], 10.0) << "11 less 1, the least of each";
  EXPECT_EQ(light["shadows"]["light_moves_map"], 31.0);
  EXPECT_NE(bytes("sweep.csv").find("times_ms_shadows_light_moves_map"), std::string::npos);
  EXPECT_NE(bytes("sweep.csv").find(",31.0,"), std::string::npos) << bytes("sweep.csv");
}

TEST_F(JournalTest, RefusesAnotherConfiguration) {
  ASSERT_TRUE(open());
  const auto other = open(R"({"axes":[2]})");
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().kind, ErrorKind::usage);
  EXPECT_NE(other.error().message().find("axes/0"), std::string::npos) << other.error().message();
  const auto shard = Journal::open(folder, make_header(R"({"axes":[1]})", 3, {1, 2}), {}, {});
  EXPECT_FALSE(shard);
}

TEST_F(JournalTest, RefusesAForeignLine) {
  ASSERT_TRUE(open());
  write("sweep.jsonl", line(1) + line(0));
  write("sweep_times.jsonl", no_times + no_times);
  const auto journal = open();
  ASSERT_FALSE(journal);
  EXPECT_EQ(journal.error().kind, ErrorKind::bad_input);
  EXPECT_EQ(journal.error().line, 1);
}

// A number changed in any line, the last one included, and in the times.
TEST_F(JournalTest, RefusesAnEditedLine) {
  ASSERT_TRUE(open());
  const std::string whole = line(0) + line(1);
  const auto refused = [&](const std::string& lines, const std::string& times, int where) {
    write("sweep.jsonl", lines);
    write("sweep_times.jsonl", times);
    const auto journal = open();
    ASSERT_FALSE(journal) << lines;
    EXPECT_EQ(journal.error().kind, ErrorKind::bad_input);
    EXPECT_EQ(journal.error().line, where);
    EXPECT_NE(journal.error().message().find("checksum"), std::string::npos) << journal.error().message();
    EXPECT_FALSE(read_sweep(folder));
  };
  for (int cell = 0; cell < 2; ++cell) {
    std::string edited = whole;
    const std::size_t digit = whole.find("wrong\":" + std::to_string(cell)) + 7;
    edited[digit] = '7';
    refused(edited, no_times + no_times, cell + 1);
  }
  refused(whole, no_times + "{\"cell\":1}\n", 2);
}

/// The number of a process that is no more.
std::string dead_process() {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(0);
  ::waitpid(child, nullptr, 0);
  return std::to_string(child);
}

TEST_F(JournalTest, RemovesWhatWasNotFinishedAndNothingElse) {
  {
    auto journal = open();
    ASSERT_TRUE(append(*journal, 0));
  }
  const std::string dead = dead_process(), alive = std::to_string(::getppid());
  const std::string truth = "cells/" + truth_name("x") + ".png";  // named after what the files hold
  const std::vector<std::string> own = {"cells/cell-000000.js", truth, "thumbnails/cell-000000.png"};
  // Of other people and other programs, of other runs of this one, and of cells that this sweep does not have.
  const std::vector<std::string> others = {"mine.txt",
                                           "movie.mp4.part",
                                           "movie.mp4." + dead + "-0.part",
                                           "sweep.json.part",
                                           "sweep.json." + alive + "-0.part",
                                           "sweep.json.0" + dead + "-0.part",
                                           "sweep.json." + dead + "-.part",
                                           "sweep.json." + dead + "-0x.part",
                                           "sweep.json.-0.part",
                                           ".part",
                                           "cell-000001.png",
                                           "cells/cell-me.png",
                                           "cells/cell-7.png",
                                           "cells/cell-1.js",
                                           "cells/cell-0000001.js",
                                           "cells/cell-000001.jpg",
                                           "cells/cell-000001.old.png",
                                           "cells/truth-12.png",
                                           "cells/truth-0123456789aB.png",
                                           "cells/truth-0123456789ab.jpg",
                                           "cells/truth-0123456789ab.png",
                                           "cells/cell-000003.png",
                                           "thumbnails/cell-000077.png",
                                           "cells/x.png." + dead + "-1.part",
                                           "thumbnails/download.part",
                                           "thumbnails/cell-1.png"};
  const std::vector<std::string> strays = {"cells/cell-000001.js",
                                           "thumbnails/cell-000002.png",
                                           "cells/cell-000000.js." + dead + "-0.part",
                                           "sweep.json." + dead + "-12.part",
                                           "cells/truth-0123456789ab.png." + dead + "-3.part",
                                           "thumbnails/probe." + dead + "-3.part"};
  for (const char* name : {"cells", "thumbnails"}) fs::create_directories(fs::path(folder) / name);
  fs::create_directory(fs::path(folder) / ("cells/cell-000002.png"));  // a folder of that name
  for (const auto& names : {own, others, strays})
    for (const std::string& name : names) write(name, "x");
  ASSERT_TRUE(open());
  const auto exists = [&](const std::string& name) { return fs::exists(fs::path(folder) / name); };
  for (const auto& names : {own, others})
    for (const std::string& name : names) EXPECT_TRUE(exists(name)) << name;
  for (const std::string& name : strays) EXPECT_FALSE(exists(name)) << name;
  ASSERT_TRUE(discard_sweep(folder));
  for (const std::string& name : others) EXPECT_TRUE(exists(name)) << name;
  for (const std::string& name : own) EXPECT_FALSE(exists(name)) << name;
  EXPECT_FALSE(exists("sweep.jsonl"));
  for (const char* name : {"cells", "thumbnails"}) fs::remove_all(fs::path(folder) / name);
  fs::create_directory(fs::path(folder) / "thumbnails");
  ASSERT_TRUE(discard_sweep(folder));
  EXPECT_FALSE(exists("thumbnails"));
}

// What cannot be looked at is not taken for what is not there.
TEST_F(JournalTest, AHeaderThatCannotBeReadStays) {
  ASSERT_TRUE(open());
  fs::remove(fs::path(folder) / "sweep.json");
  fs::create_symlink("sweep.json", fs::path(folder) / "sweep.json");
  EXPECT_FALSE(open());
  EXPECT_TRUE(fs::is_symlink(fs::path(folder) / "sweep.json"));
  fs::remove(fs::path(folder) / "sweep.json");
  ASSERT_TRUE(open());
  fs::create_symlink("cells", fs::path(folder) / "cells");
  const auto strays = open();
  ASSERT_FALSE(strays);
  EXPECT_EQ(strays.error().kind, ErrorKind::cannot_write);
}

TEST_F(JournalTest, ASweepAtWorkIsNotDiscarded) {
  const auto at_work = open();
  ASSERT_TRUE(at_work);
  const auto discarded = discard_sweep(folder);
  ASSERT_FALSE(discarded);
  EXPECT_EQ(discarded.error().kind, ErrorKind::usage);
  EXPECT_TRUE(fs::exists(fs::path(folder) / "sweep.json"));
}

// Where the file that is to go on cannot be read, nothing of it may be taken for torn.
TEST_F(JournalTest, WhatCannotBeReadStays) {
  {
    auto journal = open();
    ASSERT_TRUE(journal);
    ASSERT_TRUE(append(*journal, 0));
  }
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
  const int next = ::open("/dev/null", O_RDONLY);
  ASSERT_GE(next, 0);
  ::close(next);
  int refused = 0;
  for (rlim_t opened = 0; opened < 8;
       ++opened) {  // whichever of its files is the first that cannot be opened
    const rlimit few{static_cast<rlim_t>(next) + opened, before.rlim_max};
    ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &few), 0);
    const auto journal = open();
    ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &before), 0);
    if (!journal) {
      ++refused;
      EXPECT_NE(journal.error().message().find("Too many open files"), std::string::npos)
          << journal.error().message();
    }
    EXPECT_EQ(bytes("sweep.jsonl"), line(0)) << opened;
  }
  EXPECT_GE(refused, 3);  // the three files that grow
}

// What a sweep would cut, write over or remove, and did not write.
class NotASweepsTest : public JournalTest {
 protected:
  void SetUp() override { fs::create_directories(folder); }
  /// Everything in the folder and beside it, links as what they lead to.
  std::map<std::string, std::string> contents() const {
    std::map<std::string, std::string> found;
    for (const auto& entry : fs::recursive_directory_iterator(outer.path())) {
      const std::string path = entry.path().string();
      if (fs::is_symlink(entry.path()))
        found[path] = "link to " + fs::read_symlink(entry.path()).string();
      else if (fs::is_regular_file(entry.path()))
        found[path] = test::bytes_of(path);
      else
        found[path] = "no file";
    }
    return found;
  }
  /// A new sweep, one begun anew, and one to be merged into the folder: all say that they cannot write, and change nothing.
  void expect_refused(const std::string& what) const {
    const auto before = contents();
    const SweepHeader header = make_header(R"({"axes":[1]})", 3, {});
    const auto opened = open();
    EXPECT_FALSE(opened) << what;
    if (!opened) {
      EXPECT_EQ(opened.error().kind, ErrorKind::cannot_write) << what << ": " << opened.error().message();
      EXPECT_NE(opened.error().message().find("left as it is"), std::string::npos)
          << opened.error().message();
    }
    const auto merged = check_takes_sweep(folder, header, {axes(0), axes(1), axes(2)});
    EXPECT_FALSE(merged) << what;
    const auto discarded = discard_sweep(folder);
    EXPECT_FALSE(discarded) << what;
    if (!discarded) {
      EXPECT_EQ(discarded.error().kind, ErrorKind::cannot_write) << what;
    }
    EXPECT_EQ(contents(), before) << what;
  }
  void clear() const {
    fs::remove_all(folder);
    fs::create_directories(folder);
  }
};

TEST_F(NotASweepsTest, AFileThatBeginsOtherwiseStays) {
  for (const char* name : {"sweep.jsonl", "sweep_times.jsonl", "sweep.csv", "sweep.json"})
    for (const char* text :
         {"precious text without a line break", "precious, no JSON\n", "[1]\n", "{\"a\":1}\n"}) {
      clear();
      write(name, text);
      expect_refused(std::string(name) + " holds " + text);
      if (std::string_view(name) == "sweep.json") continue;
      clear();
      ASSERT_TRUE(open());  // nor where a sweep's list lies beside it
      write(name, text);
      expect_refused(std::string(name) + " of a sweep holds " + text);
    }
}

TEST_F(NotASweepsTest, WhatBeginsAlikeWithoutASweepStays) {
  for (const auto& [name, text] : {std::pair("sweep.csv", "cell,my own table\n1,2\n"),
                                   {"sweep.jsonl", "{\"schema\":\"gnomon/result/1\",\"mine\":1}\n"},
                                   {"sweep_times.jsonl", "{\"cell\":\"phone\"}\n"}}) {
    clear();
    write(name, text);
    expect_refused(name);
  }
  for (const char* name :
       {"cells/cell-000000.png", "thumbnails/cell-000002.png", "cells/truth-0123456789ab.png"}) {
    clear();
    fs::create_directories((fs::path(folder) / name).parent_path());
    write(name, "a picture of mine");
    expect_refused(name);
  }
}

TEST_F(NotASweepsTest, NothingIsWrittenThroughALink) {
  std::ofstream(outer / "mine.txt") << "";  // empty: as if no line had been written yet
  fs::create_directories(outer / "pictures");
  for (const char* name : {"sweep.jsonl", "sweep_times.jsonl", "sweep.csv", "report.html", "ray_tracer.json",
                           "cells", "thumbnails", "cells/cell-000000.png", "cells/truth-0123456789ab.png"}) {
    const bool is_folder = !fs::path(name).has_extension();
    for (const std::string& target : {outer / (is_folder ? "pictures" : "mine.txt"), outer / "nowhere"}) {
      clear();
      ASSERT_TRUE(open());
      fs::create_directories((fs::path(folder) / name).parent_path());
      fs::remove_all(fs::path(folder) / name);
      fs::create_symlink(target, fs::path(folder) / name);
      expect_refused(std::string(name) + " is a link to " + target);
    }
  }
}

TEST_F(NotASweepsTest, APipeDoesNotHoldIt) {
  for (const char* name : {"sweep.jsonl", "sweep_times.jsonl", "sweep.csv"}) {
    clear();
    ASSERT_EQ(::mkfifo((folder + "/" + name).c_str(), 0600), 0);
    expect_refused(std::string(name) + " is a pipe");
  }
}

// What is behind the sweep's own lines is cut off only where a crash can have left it.
TEST_F(NotASweepsTest, WhatFollowsItsLinesStays) {
  for (const char* rest : {"a note of mine", "a note of mine\n", "a note\nof two lines\n"})
    for (const bool of_times : {false, true}) {
      clear();
      ASSERT_TRUE(open());
      write("sweep.jsonl", line(0) + (of_times ? "" : rest));
      write("sweep_times.jsonl", no_times + (of_times ? rest : ""));
      const auto before = contents();
      EXPECT_FALSE(open()) << rest;
      EXPECT_EQ(contents(), before) << rest;
    }
}

TEST_F(JournalTest, OneProcessAtATime) {
  const auto first = open();
  ASSERT_TRUE(first);
  const auto second = open();
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().kind, ErrorKind::usage);
}

TEST_F(JournalTest, ReadsBackWhatItWrote) {
  {
    auto journal = open();
    ASSERT_TRUE(append(*journal, 0));
  }
  const auto sweep = read_sweep(folder);
  ASSERT_TRUE(sweep) << sweep.error().message();
  EXPECT_EQ(sweep->lines, std::vector<std::string>{line(0)});
  EXPECT_EQ(sweep->header.cells, 3u);
  write("sweep.json", "{}");
  EXPECT_FALSE(read_sweep(folder));
}

}  // namespace
}  // namespace gnomon::studies
