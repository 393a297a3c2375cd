// The program's words from outside: what a wrong word is told (exit code 2, one line on stderr), what the
// help, the manual and the shells' completions say.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "app/command_line.h"
#include "app/wrong_words.h"
#include "tests/support/app_process.h"

namespace gnomon::app_test {
namespace {

/// What the program says to these words: without a process where the words alone are wrong, else by running it.
ProcessResult said_to(const Words& words) {
  std::vector<const char*> argv{"gnomon"};
  for (const std::string& word : words) argv.push_back(word.c_str());
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  ProcessResult result;
  result.exit_code = app::check_command_line(static_cast<int>(argv.size()), argv.data());
  result.out = testing::internal::GetCapturedStdout();
  result.err = testing::internal::GetCapturedStderr();
  return result.exit_code != 0 ? result : run_gnomon(words);
}

/// Words that end with exit code 2 and one line, and what stands in it.
struct Refusal {
  Words words;
  std::string said;
};

void expect_refused(const std::vector<Refusal>& refusals) {
  for (const Refusal& refusal : refusals) expect_one_line(said_to(refusal.words), 2, refusal.said);
}

/// Words behind "gnomon compare fence".
Words fence(const Words& more) {
  return Words{"compare", "fence"} + more;
}

TEST(Usage, WrongNamesGetASuggestion) {
  expect_refused({{{"comapre", "fence"}, "did you mean compare?"},
                  {fence({"--bais", "1"}), "did you mean --bias?"},
                  {fence({"--map-sise=1"}), "did you mean --map-size?"},
                  {{"fence"}, "did you mean gnomon compare fence?"},
                  {{"model.glb"}, "did you mean gnomon compare model.glb?"},
                  {fence({"--depth-format", "d32"}), "did you mean d32f?"},
                  {{"bench", "--tune", "fence", "--technique", "hard,cms"}, "did you mean csm?"},
                  {{"hlep"}, "did you mean help?"},
                  {{"help", "comapre"}, "did you mean compare?"}});
}

TEST(Usage, OtherProgramsNamesOfOptionsAreUnderstood) {
  expect_refused({{fence({"--resolution", "1280x720"}), "did you mean --size?"},
                  {fence({"--spp=16"}), "unknown option --spp; did you mean --samples?"},
                  {fence({"--shadow-map-size", "1024"}), "did you mean --map-size?"},
                  {fence({"--shadowMapSize", "1024"}), "did you mean --map-size?"},
                  {fence({"--shadow_normal_bias", "1"}), "did you mean --normal-offset?"},
                  {fence({"--map_size", "1024"}), "did you mean --map-size?"},
                  {fence({"--max-error", "1%"}), "did you mean --fail-above?"},
                  {{"tune", "fence", "--fail-above", "1%"}, "did you mean --max-error?"},
                  {{"raytrace", "fence", "--depth-bias", "1"}, "(--help lists them)"},
                  {{"plan", "fence", "--seed", "1"}, "unknown option --seed (an option of compare, "}});
}

// Each row of the table is of use: some command has our option, and does not call it so itself.
TEST(Usage, EverySynonymHelpsSomewhere) {
  const std::vector<Words> commands = {
      fence({}), {"tune", "fence"}, {"raytrace", "fence"}, {"serve", "fence"}};
  for (const app::OptionSynonym& synonym : app::option_synonyms()) {
    const std::string hint = "; did you mean --" + std::string(synonym.ours) + "?";
    const bool helps = std::any_of(commands.begin(), commands.end(), [&](const Words& command) {
      return said_to(command + Words{"--" + std::string(synonym.theirs)}).err.find(hint) != std::string::npos;
    });
    EXPECT_TRUE(helps) << synonym.theirs << ": " << synonym.ours;
  }
}

TEST(Usage, NamedValuesAreUnderstoodInAnyCase) {
  const auto parsed = [](const Words& words) {
    std::vector<const char*> argv{"gnomon"};
    for (const std::string& word : words) argv.push_back(word.c_str());
    return app::check_command_line(static_cast<int>(argv.size()), argv.data());
  };
  for (const Words& words : {fence({"--technique", "PCF", "--filter-kernel=Vogel"}),
                             fence({"--bias", "Auto", "--exposure", "AUTO", "--accel", "BVH"}),
                             fence({"--size", "4K", "--measure", "FLIP", "--backend", "EGL"}),
                             {"sweep", "fence", "--technique", "Hard,PCF,vsm", "--receiver-plane", "OFF,on"},
                             {"bench", "--tune", "fence", "--technique", "HARD,Csm"},
                             {"tune", "fence", "--max-error", "1%", "--engine", "Unity"}})
    EXPECT_EQ(parsed(words), 0) << words[0] << " " << words[2] << " " << words[3];
  expect_refused({{fence({"--technique", "PFC"}), "(got PFC, allowed hard, "},
                  {fence({"--technique", "PFC"}), "did you mean pcf?"}});
  // What was meant is what is written down.
  const TemporaryFolder folder;
  EXPECT_EQ(
      run_gnomon(Words{"sweep", "acne-floor", "--technique", "HARD,Pcf", "-o", folder / "sweep"} + small)
          .exit_code,
      0);
  const std::string table = read_file(folder / "sweep/sweep.csv");
  EXPECT_NE(table.find("pcf"), std::string::npos);
  EXPECT_EQ(table.find("Pcf"), std::string::npos);
}

TEST(Usage, ValuesOutOfRange) {
  const std::vector<Words> wrong = {{"--bias", "nan"},          {"--bias", "inf"},
                                    {"--bias", "-inf"},         {"--bias", "wide"},
                                    {"--slope-bias", "nan"},    {"--slope-bias", "inf"},
                                    {"--normal-offset", "-1"},  {"--size", "0x10"},
                                    {"--size", "-1x10"},        {"--size", "10"},
                                    {"--size", "2147483648x1"}, {"--map-size", "0"},
                                    {"--map-size", "-5"},       {"--map-size", "2147483648"},
                                    {"--threads", "-1"},        {"--runs", "0"},
                                    {"--technique", "soft"},    {"--precision", "half"},
                                    {"--accel", "quadtree"},    {"--cull", "both"},
                                    {"--backend", "vulkan"},    {"--exposure", "0"},
                                    {"--seed", "-1"},           {"--fail-above", "101%"},
                                    {"--min-contribution", "2"}};
  for (const Words& option : wrong) {
    const ProcessResult result = said_to(fence(option));
    expect_one_line(result, 2, option[0] + ": ");
    expect_one_line(result, 2, "(got " + option[1] + ", allowed ");
  }
}

TEST(Usage, OptionsInTheWrongPlaceOrNumber) {
  expect_refused(
      {{{"--size", "8x8", "compare", "fence"}, "--size stands behind the command's name"},
       {fence({"--quiet=maybe"}), "--quiet: not a switch's value (got maybe, allowed on, off)"},
       {fence({"--map-size"}), "--map-size: has no value (allowed N)"},
       {fence({"--bias"}), "--bias"},
       {{"--bogus"}, "--bogus"},
       {{"compare"}, "SCENE is required"},
       {fence({"other"}), "one argument too many (got other)"},
       {fence({"--measure", "shimmer"}), "--measure: unknown value (got shimmer, allowed wrong, "},
       {fence({"--fail-above", "mean:1%", "--measure", "flip"}),
        "--fail-above: is no limit of --measure flip (got mean:1%, allowed flip:LIMIT)"},
       {{"tune", "fence", "--max-error", "0.1", "--anchors", "2"}, "--anchors: belongs to --measure shimmer"},
       {{"raster", "fence", "-o", "x.jpg"}, "(got x.jpg, allowed .png .exr)"},
       {{"verify", "--rays", "1000.5"}, "--rays: is not a whole number (got 1000.5, allowed "},
       {{"raytrace", "fence", "--map-size", "64"}, "unknown option --map-size"},
       {{"raster", "fence", "--accel", "bvh"}, "unknown option --accel"},
       {{"plan", "fence", "--map-size", "1"}, "unknown option --map-size"}});
  EXPECT_EQ(run_gnomon({}).exit_code, 2);
}

// Advice is appended to what was typed.
TEST(Usage, OfAnOptionGivenAgainTheLastValueCounts) {
  const TemporaryFolder folder;
  const auto said = [&](const Words& more) {
    return run_gnomon(
        Words{"compare", "sphere-plane", "--size", "16x9", "--no-report", "-o", folder / "out"} + more);
  };
  const auto map = [&](const Words& more) {
    const ProcessResult result = said(more);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const std::size_t at = result.out.find("  map ");
    return result.out.substr(at, result.out.find("\n  wrong", at) - at);
  };
  EXPECT_EQ(map({"--bias", "1", "--map-size", "64", "--bias", "2texel", "--map-size", "128"}),
            map({"--bias", "2texel", "--map-size", "128"}));
  EXPECT_EQ(map({"--receiver-plane", "--receiver-plane=false", "--bias", "-1"}), map({"--bias=-1"}));
  EXPECT_NE(
      said({"--bias", "1", "--bias", "2"}).err.find("note: --bias is given 2 times: the last, 2, counts\n"),
      std::string::npos);
  EXPECT_EQ(said({"--bias", "2", "--bias", "2"}).err.find("given"), std::string::npos);
  // A technique that takes another's place takes its own options with it.
  const Words vogel{"--technique", "pcf", "--filter-kernel", "vogel"};
  EXPECT_EQ(map(vogel + Words{"--technique", "pcss"}), map({"--technique", "pcss"}));
  EXPECT_NE(
      said(vogel + Words{"--technique", "pcss"}).err.find("and options that it does not read are left out"),
      std::string::npos);
  expect_refused({{fence({"--filter-kernel", "vogel"}), "--filter-kernel: belongs to pcf"}});
}

TEST(Usage, OptionsThatCouldHaveNoEffectAreRefused) {
  const TemporaryFolder folder;
  const std::string as_written = ": the scenes of --suite are written as they are";
  const Words suite{"export", "--suite", folder / "suite"};
  expect_refused({{{"export", "fence", "--size", "8x8"}, "--size: is that of the masks of --suite"},
                  {suite + Words{"--tessellate", "8"}, "--tessellate" + as_written},
                  {suite + Words{"--camera", "eye=1,1,1"}, "--camera" + as_written}});
  // Where it could, and only where it was given, that is said.
  const std::string box = folder / "box.glb", effect = "--tessellate has no effect";
  EXPECT_EQ(run_gnomon({"export", "thin-wall", "-o", box}).err.find(effect), std::string::npos);
  EXPECT_NE(run_gnomon({"export", "thin-wall", "--tessellate", "8", "-o", box}).err.find(effect),
            std::string::npos);
}

// An unset variable of a script.
TEST(Usage, EmptyNamesAskForNothingAndAreRefused) {
  for (const std::string option : {"--output", "--json", "--aov", "--trace", "--light", "--camera"})
    expect_refused({{fence({option, ""}), option + ": "}});
  expect_refused({{fence({"--trace", "-"}), "--trace: not a file (got -)"}});
}

TEST(Usage, AnUpVectorIsOneAndNotAlongTheView) {
  const TemporaryFolder folder;
  const auto with_up = [&](const std::string& up) {
    return Words{"raytrace", "sphere-plane", "-o", folder / "x.png", "--size", "8x8", "--camera-up", up};
  };
  // The scene's eye is at 0.6, 2.8, 6.2 and its target at 0.45, 0.35, -0.3.
  expect_refused({{with_up("1e-300,0,0"), "--camera-up: has no direction"},
                  {with_up("0.15,2.45,6.5"), "camera.up is parallel to the view direction"}});
  EXPECT_EQ(run_gnomon(with_up("0.15,2.46,6.5")).exit_code, 0);
}

TEST(Usage, WhatOptionsLeaveOutOfACaptureIsNamedAsAnOption) {
  const Words scene{"judge", "--scene", "fence"}, renderer{"--renderer", "mine"}, size{"--size", "64x36"};
  const Words all = scene + renderer + size, seen = all + Words{"--visibility", "v.exr"};
  expect_refused({{scene + size, "gnomon: --renderer: is missing"},
                  {scene + renderer, "gnomon: --size: is missing"},
                  {all, "--visibility: is missing, and so are shadowed and unshadowed"},
                  {seen + Words{"--map-bias", "1"}, "--map-bias: says nothing without map"},
                  {seen + Words{"--map-normal-offset", "1"}, "--map-normal-offset: says"},
                  {seen + Words{"--depth-near", "1"}, "--depth: is missing"},
                  {seen + Words{"--map", "m.exr"}, "--map-convention: is missing"}});
}

TEST(Usage, AnUnknownLightIsNamedBesideThoseThatExist) {
  const TemporaryFolder folder;
  const ProcessResult result = run_gnomon(Words{"compare", "acne-floor", "--light", "snu", "--quiet"} + small,
                                          {.folder = folder.path()});
  expect_one_line(result, 2, "(got snu, allowed ");
  EXPECT_TRUE(folder.entries().empty());
}

TEST(Usage, AMissingTextureBesideAModelInTheWorkingFolderIsANote) {
  const TemporaryFolder folder;
  write_text(folder / "m.mtl", "newmtl m\nmap_Kd missing.png\n");
  write_text(folder / "m.obj", "mtllib m.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const ProcessResult made =
      run_gnomon({"raytrace", "m.obj", "--size", "8x8", "-o", "m.png"}, {.folder = folder.path()});
  EXPECT_EQ(made.exit_code, 0);
  EXPECT_NE(made.err.find("the texture missing.png is not there; its plain colour is used"),
            std::string::npos)
      << made.err;
}

TEST(Usage, ARefusedTechniqueIsNotCommentedOn) {
  const TemporaryFolder folder;
  expect_one_line(
      run_gnomon(Words{"compare", "fence", "--technique", "cube"} + small, {.folder = folder.path()}), 2,
      "technique cube: is made for point lights alone");
  expect_one_line(
      run_gnomon(Words{"compare", "fence", "--technique", "cube"} + small), 2,
      "allowed there hard, pcf, pcss, vsm, esm, evsm, msm, second-depth, midpoint, csm, lispsm, izb, "
      "hybrid, rays)");
  const ProcessResult made = run_gnomon(Words{"compare", "fence"} + small, {.folder = folder.path()});
  EXPECT_NE(made.err.find("follows the camera by parts of a texel"), std::string::npos) << made.err;
  EXPECT_NE(read_file(folder / "out/fence/result.json").find("follows the camera by parts"),
            std::string::npos);
}

// --- Help
// ----------------------------------------------------------------------------------------------------

/// The paragraphs of a help text that describe an option: each starts with two blanks and a dash.
std::vector<std::string> option_paragraphs(const std::string& help) {
  std::vector<std::string> paragraphs;
  std::istringstream lines(help);
  bool inside = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("  -")) {
      paragraphs.push_back(line);
      inside = true;
    } else if (inside && line.starts_with("      ")) {
      paragraphs.back().append(" ").append(line.substr(6));
    } else {
      inside = false;
    }
  }
  return paragraphs;
}

/// Characters of UTF-8.
std::ptrdiff_t columns_of(const std::string& line) {
  return std::count_if(line.begin(), line.end(), [](char c) { return (c & 0xc0) != 0x80; });
}

TEST(Help, EveryOptionSaysItsDefaultAndNoLineIsTooLong) {
  for (const char* command : {"compare", "raster", "raytrace", "plan", "scenes"}) {
    const ProcessResult result = run_gnomon({command, "--help"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.err, "");
    std::istringstream lines(result.out);
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 80u) << line;
    EXPECT_LT(result.out.find("Examples:"), result.out.find("Options:"));
    const std::vector<std::string> options = option_paragraphs(result.out);
    EXPECT_GE(options.size(), 2u);
    for (const std::string& option : options) {
      if (option.find("--help") != std::string::npos) continue;
      EXPECT_NE(option.find("default "), std::string::npos) << command << ":" << option;
      EXPECT_NE(option.find('['), std::string::npos) << command << ":" << option;
    }
  }
}

TEST(Help, UsageNamesWhatTheCommandTakes) {
  const std::pair<const char*, const char*> usages[] = {
      {"compare", " SCENE "},  {"judge", " [CAPTURE...] "}, {"grade", " [RUBRIC] [STUDENTS...] "},
      {"merge", " SHARD... "}, {"export", " [SCENE] "},     {"scenes", " "}};
  for (const auto& [command, words] : usages) {
    const std::string help = run_gnomon({command, "--help"}).out;
    EXPECT_NE(help.find(std::string("Usage: gnomon ") + command + words + "[OPTIONS]\n"), std::string::npos)
        << help;
  }
  EXPECT_NE(run_gnomon({"judge", "--help"}).out.find("\n  CAPTURE\n"), std::string::npos);
}

TEST(Help, UnitsAreNamed) {
  const std::string help = run_gnomon({"compare", "--help"}).out;
  const std::vector<std::string> options = option_paragraphs(help);
  const std::pair<const char*, const char*> units[] = {{"--size ", "pixels"},
                                                       {"--map-size ", "texels"},
                                                       {"--bias ", "world units along the light ray"},
                                                       {"--slope-bias ", "multiples"},
                                                       {"--normal-offset ", "texels"},
                                                       {"--threads ", "cores"}};
  for (const auto& [name, unit] : units) {
    const auto found = std::find_if(options.begin(), options.end(), [flag = name](const std::string& option) {
      return option.find(flag) != std::string::npos;
    });
    ASSERT_NE(found, options.end()) << name;
    EXPECT_NE(found->find(unit), std::string::npos) << *found;
  }
}

TEST(Help, Version) {
  EXPECT_EQ(run_gnomon({"--version"}).out.substr(0, 7), "gnomon ");
  EXPECT_EQ(run_gnomon({"--help"}).exit_code, 0);
  for (const char* help : {"--help", "-h"}) {
    const ProcessResult asked = run_gnomon({help, "compare"});
    EXPECT_EQ(asked.exit_code, 0) << asked.err;
    EXPECT_EQ(asked.out, run_gnomon({"compare", help}).out);
  }
}

TEST(Help, WordsAskForWhatOptionsDo) {
  EXPECT_EQ(run_gnomon({"version"}).out, run_gnomon({"--version"}).out);
  EXPECT_EQ(run_gnomon({"help"}).out, run_gnomon({"--help"}).out);
  for (const char* command : {"compare", "judge"}) {
    const ProcessResult asked = run_gnomon({"help", command});
    EXPECT_EQ(asked.exit_code, 0) << asked.err;
    EXPECT_EQ(asked.out, run_gnomon({command, "--help"}).out);
  }
}

// -h: what people need, on one screen; --help: all.
TEST(Help, InShortItIsAScreen) {
  const std::string program = run_gnomon({"-h"}).out, all = run_gnomon({"--help"}).out;
  EXPECT_LT(program.size(), all.size());
  std::vector<Words> asked{{"-h"}};
  std::istringstream manual(run_gnomon({"--manual", "options"}).out);
  for (std::string line; std::getline(manual, line);)
    if (line.starts_with("## gnomon ")) asked.push_back({line.substr(10), "-h"});
  EXPECT_GE(asked.size(), 19u);
  for (const Words& words : asked) {
    const ProcessResult result = run_gnomon(words);
    EXPECT_EQ(result.exit_code, 0) << words[0];
    EXPECT_LE(std::count(result.out.begin(), result.out.end(), '\n'), 40) << words[0];
    std::istringstream lines(result.out);
    for (std::string line; std::getline(lines, line);) EXPECT_LE(columns_of(line), 80) << line;
    if (words.size() == 1) continue;
    EXPECT_NE(program.find("\n  " + words[0] + " "), std::string::npos) << words[0] << " is listed";
    EXPECT_NE(result.out.find("Usage: gnomon " + words[0]), std::string::npos) << words[0];
    EXPECT_EQ(run_gnomon({"-h", words[0]}).out, result.out) << words[0];
  }
  const std::string compare = run_gnomon({"compare", "-h"}).out;
  for (const char* option : {"--output DIR", "--size WxH", "720p or 1080p", "--technique NAME",
                             "hard or pcf or", "--fail-above LIMIT", "gnomon compare --help has all "})
    EXPECT_NE(compare.find(option), std::string::npos) << option << "\n" << compare;
}

TEST(Help, CompletionAndManualNameEveryOption) {
  const std::string manual = run_gnomon({"--man-page"}).out;
  EXPECT_TRUE(manual.starts_with(".TH GNOMON 1"));
  for (const char* shell : {"bash", "zsh", "fish"}) {
    const ProcessResult script = run_gnomon({"--completion", shell});
    EXPECT_EQ(script.exit_code, 0);
    for (const char* name : {"compare", "map-size", "receiver-plane", "fence"}) {
      EXPECT_NE(script.out.find(name), std::string::npos) << shell << " " << name;
    }
  }
  for (const char* name :
       {"map\\-size", "receiver\\-plane", "gnomon compare fence", "max\\-error", ".TP\n143\n"}) {
    EXPECT_NE(manual.find(name), std::string::npos) << name;
  }
  expect_one_line(run_gnomon({"--completion", "ksh"}), 2, "(got ksh, allowed bash, zsh, fish)");
}

}  // namespace
}  // namespace gnomon::app_test
