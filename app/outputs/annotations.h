// --annotate: what was held against a limit, as platforms of continuous integration show it. One line or test case for each
// light or limit. Every command that judges hands its verdicts here.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "scene/base/expected.h"

namespace CLI {
class App;
}

namespace gnomon::app {

struct Annotation {
  enum class Outcome : std::uint8_t { kept, exceeded, failed } outcome = Outcome::kept;
  std::string about{};  ///< the scene or capture
  std::string name{};   ///< of the light or limit
  std::string said{};
};

struct Annotate {
  enum class Form : std::uint8_t { none, github, junit } form = Form::none;
  std::string path{};  ///< of junit: the file
};

/// --annotate.
void add_annotate(CLI::App& app, Annotate& annotate);

/// The text of the file; empty where none was asked for. `command` is what judged: "compare".
std::string annotation_file(const Annotate& annotate, const std::string& command,
                            std::span<const Annotation> annotations);
/// Prints on stderr what goes there: workflow commands of GitHub Actions.
void print_annotations(const Annotate& annotate, std::span<const Annotation> annotations);
/// Prints, and writes the file where it appears with no other output. ErrorKind::cannot_write.
Expected<void> put_annotations(const Annotate& annotate, const std::string& command,
                               std::span<const Annotation> annotations);

}  // namespace gnomon::app
