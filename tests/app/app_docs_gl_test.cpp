// The documents cannot rot: every command in them and in the chapters that the program prints is one that it takes, links lead
// somewhere, here and on the site, and the shaders of the manual compile.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <regex>
#include <span>
#include <sstream>

#include "app/command_line.h"
#include "app/help/manual.h"
#include "compare/comparison.h"
#include "compare/ladder/labels.h"
#include "lab/lessons/site.h"
#include "report/lessons.h"
#include "scene/load.h"
#include "tests/support/app_process.h"
#include "tests/support/places.h"

namespace gnomon::app_test {
namespace {

namespace fs = std::filesystem;

struct Document {
  fs::path file;
  std::string text;
};

/// Of the program's own chapters what it prints, in the place where an installation has them.
std::vector<Document> documents() {
  std::vector<Document> all;
  const fs::path root = test::source_dir();
  for (const std::string_view name : app::written_chapters)
    all.push_back(
        {root / fmt::format("docs/manual/{}.md", name), run_gnomon({"--manual", std::string(name)}).out});
  std::vector<fs::path> files{root / "README.md", root / "CONTRIBUTING.md"};
  for (const auto& entry : fs::recursive_directory_iterator(root / "docs"))
    if (entry.path().extension() == ".md") files.push_back(entry.path());
  for (const fs::path& file : files) all.push_back({file, read_file(file.string())});
  return all;
}

/// Blocks between ```language and ```.
std::vector<std::string> blocks(const std::string& text, const std::string& language) {
  std::vector<std::string> found;
  std::istringstream lines(text);
  bool inside = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("```")) {
      inside = !inside && line == "```" + language;
      if (inside) found.emplace_back();
    } else if (inside) {
      found.back() += line + "\n";
    }
  }
  return found;
}

/// A line as a shell would split it, up to a comment, a pipe or a redirection.
Words shell_words(const std::string& line) {
  Words words;
  std::string word;
  bool is_word = false;
  char quote = 0;
  for (const char c : line + " ") {
    if (quote != 0) {
      if (c == quote)
        quote = 0;
      else
        word += c;
    } else if (c == '\'' || c == '"') {
      quote = c, is_word = true;
    } else if (c == ' ') {
      if (is_word) words.push_back(word);
      word.clear(), is_word = false;
    } else if (!is_word && (c == '#' || c == '|' || c == '>' || c == ';')) {
      return words;
    } else {
      word += c, is_word = true;
    }
  }
  return words;
}

struct Shown {
  std::string file, line;
  Words words;  ///< without "gnomon"
};

std::vector<Shown> shown_commands() {
  std::vector<Shown> commands;
  for (const auto& [file, text] : documents()) {
    for (const std::string& block : blocks(text, "sh")) {
      std::istringstream lines(block);
      for (std::string line; std::getline(lines, line);) {
        Words words = shell_words(line);
        if (words.empty() || (words[0] != "gnomon" && words[0] != "./gnomon")) continue;
        const Words script = {"build", "test", "install", "web", "format", "tidy"};  // the script's own
        if (words.size() > 1 && std::find(script.begin(), script.end(), words[1]) != script.end()) continue;
        // Three blanks or more part a command from what is said of it in the help's examples.
        const std::size_t gap = line.find("   ");
        if (gap != std::string::npos && line.find('#') == std::string::npos)
          words = shell_words(line.substr(0, gap));
        words.erase(words.begin());
        commands.push_back({file.lexically_relative(test::source_dir()).string(), line, words});
      }
    }
  }
  return commands;
}

int parsed(const Words& words) {
  std::vector<const char*> argv{"gnomon"};
  for (const std::string& word : words) argv.push_back(word.c_str());
  return app::check_command_line(static_cast<int>(argv.size()), argv.data());
}

bool is_scene(const std::string& word) {
  const std::span<const report::Lesson> lessons = report::all_lessons();
  return fs::path(word).has_extension() || find_builtin_scene(word).has_value() ||
         std::any_of(lessons.begin(), lessons.end(),
                     [&](const report::Lesson& lesson) { return lesson.name == word; });
}

// In a folder that holds what the commands name.
TEST(Documents, CommandsAreTheProgramsOwn) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "mine");
  fs::create_directories(folder / "homework/student");
  const fs::path before = fs::current_path();
  fs::current_path(folder.path());
  const std::vector<Shown> commands = shown_commands();
  EXPECT_GE(commands.size(), 60u);
  for (const Shown& shown : commands) {
    EXPECT_EQ(parsed(shown.words), 0) << shown.file << ": " << shown.line;
    const Words without_scene = {"scenes", "verify", "merge",   "bench", "shaders",
                                 "judge",  "grade",  "lessons", "diff",  "check"};
    if (shown.words.size() < 2 || shown.words[0].starts_with("-") || shown.words[1] == "--suite" ||
        std::find(without_scene.begin(), without_scene.end(), shown.words[0]) != without_scene.end())
      continue;
    EXPECT_TRUE(is_scene(shown.words[1])) << shown.file << ": " << shown.line;
  }
  EXPECT_EQ(parsed({"compare", "fence", "--bais", "1"}), 2);  // this test can fail
  fs::current_path(before);
}

TEST(Documents, AChapterThatIsNoneIsSaid) {
  expect_one_line(run_gnomon({"--manual", "labels"}), 2,
                  "(got labels, allowed options, json, schema, techniques)");
}

// A page of the sources leads to none that the program prints: a reader of the sources has it not.
TEST(Documents, LinksLeadSomewhere) {
  const std::regex link(R"(\]\(([^)#:]+)(#[^)]*)?\))");
  const std::vector<Document> all = documents();
  for (const auto& [file, text] : all) {
    for (std::sregex_iterator found(text.begin(), text.end(), link), end; found != end; ++found) {
      const fs::path target = file.parent_path() / (*found)[1].str();
      const bool is_printed =
          !fs::exists(file) && std::any_of(all.begin(), all.end(), [&](const Document& document) {
            return document.file == target.lexically_normal();
          });
      EXPECT_TRUE(fs::exists(target) || is_printed) << file << ": " << (*found)[1];
    }
  }
}

/// The relative links of a page: "options.html" and "shared-options" of options.html#shared-options.
std::vector<std::pair<std::string, std::string>> links_of(const std::string& html) {
  const std::regex link(R"re(<a href="([^"#:]*)(?:#([^"]*))?")re");
  std::vector<std::pair<std::string, std::string>> links;
  for (std::sregex_iterator found(html.begin(), html.end(), link), end; found != end; ++found)
    links.emplace_back((*found)[1], (*found)[2]);
  return links;
}

TEST(Documents, TheSitesManualIsWhole) {
  std::vector<lab::lessons::ManualChapter> chapters;
  for (const std::string_view name : app::written_chapters)
    chapters.push_back({fmt::format("{}.md", name), run_gnomon({"--manual", std::string(name)}).out});
  const auto pages = lab::lessons::manual_pages(chapters);
  ASSERT_TRUE(pages) << pages.error().message();
  std::map<std::string, std::string> site;
  for (const auto& [file, html] : *pages) site[file] = html;
  for (const auto& [file, html] : site)
    for (const auto& [target, place] : links_of(html)) {
      if (target == "../index.html") continue;  // the site's start
      const auto page = site.find(target.empty() ? file : target);
      ASSERT_NE(page, site.end()) << file << ": " << target;
      const bool is_there = page->second.find(fmt::format("id=\"{}\"", place)) != std::string::npos;
      EXPECT_TRUE(place.empty() || is_there) << file << ": " << target << "#" << place;
    }
  for (const std::string_view name : app::written_chapters) {
    const std::string page = fmt::format("{}.html", name);
    EXPECT_TRUE(site.contains(page)) << name;
    EXPECT_NE(site["index.html"].find(fmt::format("<a href=\"{}\">", page)), std::string::npos) << name;
  }
}

TEST(Documents, ChannelsOfTheManualAreThoseOfTheFile) {
  const std::string manual = read_file(test::source_dir() + "/docs/manual/aov.md");
  const std::string source = read_file(test::source_dir() + "/compare/result/aov.cpp");
  const std::regex channel(R"re("([a-z_]+\.[A-Z])")re");
  int count = 0;
  for (std::sregex_iterator found(source.begin(), source.end(), channel), end; found != end; ++found, ++count)
    EXPECT_NE(manual.find(std::string("`").append((*found)[1].str()).append("`")), std::string::npos)
        << (*found)[1];
  EXPECT_GE(count, 7);
  for (std::size_t k = 0; k < compare::rung_count; ++k) {
    const std::string rung = fmt::format("`{}.V`", compare::rung_text(static_cast<compare::Rung>(k)).name);
    EXPECT_NE(manual.find(rung), std::string::npos) << rung;
  }
  for (std::size_t k = 0; k <= compare::class_count; ++k) {
    const std::string label =
        std::to_string(k).append(" ").append(compare::label_name(static_cast<compare::Label>(k)));
    EXPECT_NE(manual.find(label), std::string::npos) << label;
  }
}

// Each block says in its first line which file it is.
TEST(Documents, ShadersOfTheManualDraw) {
  const std::vector<std::string> shaders =
      blocks(read_file(test::source_dir() + "/docs/manual/shaders.md"), "glsl");
  EXPECT_EQ(shaders.size(), 2u);
  for (const std::string& shader : shaders) {
    const TemporaryFolder folder;
    const std::string name = shader.substr(3, shader.find(':') - 3);
    fs::create_directories(fs::path(folder / name).parent_path());
    write_text(folder / name, shader);
    const ProcessResult drawn = run_gnomon({"raster", "fence", "--size", "64x36", "--map-size", "128",
                                            "--shader-dir", folder.path(), "-o", folder / "picture.png"});
    EXPECT_EQ(drawn.exit_code, 0) << drawn.err << shader;
  }
}

}  // namespace
}  // namespace gnomon::app_test
