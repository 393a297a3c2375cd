#include "app/outputs/annotations.h"

#include <fmt/core.h>

#include <algorithm>

#include "app/console.h"
#include "app/options/option_kinds.h"
#include "report/html.h"
#include "scene/files/write_file.h"

namespace gnomon::app {
namespace {

using Outcome = Annotation::Outcome;

/// A workflow command ends with its line; a property of one ends at a comma, too.
std::string workflow_text(std::string_view text, bool is_property) {
  std::string out;
  for (const char c : text) {
    const bool ends = c == '%' || c == '\r' || c == '\n' || (is_property && (c == ':' || c == ','));
    out += ends ? fmt::format("%{:02X}", static_cast<unsigned char>(c)) : std::string(1, c);
  }
  return out;
}

std::string workflow_command(const Annotation& annotation) {
  return fmt::format("::{} title={}::{}", annotation.outcome == Outcome::kept ? "notice" : "error",
                     workflow_text(annotation.about + ", " + annotation.name, true),
                     workflow_text(annotation.said, false));
}

std::string test_case(const Annotation& annotation) {
  const std::string said = report::escaped(annotation.said);
  std::string xml = fmt::format("    <testcase classname=\"{}\" name=\"{}\">\n",
                                report::escaped(annotation.about), report::escaped(annotation.name));
  if (annotation.outcome == Outcome::kept)
    xml += fmt::format("      <system-out>{}</system-out>\n", said);
  else
    xml += fmt::format("      <{} message=\"{}\"/>\n",
                       annotation.outcome == Outcome::exceeded ? "failure" : "error", said);
  return xml + "    </testcase>\n";
}

}  // namespace

void add_annotate(CLI::App& app, Annotate& annotate) {
  add_value(app, "--annotate", "FORM",
            "also say each verdict as platforms of continuous integration show it: on stderr as commands of "
            "GitHub's workflows, or in a file as test cases of JUnit [github or junit:FILE; default off]",
            [&annotate](const std::string& text) -> Expected<void> {
              constexpr std::string_view junit = "junit:";
              if (text == "github") return annotate = {Annotate::Form::github, {}}, Expected<void>();
              if (!text.starts_with(junit) || text.size() == junit.size())
                return wrong_value("not a form of annotations", text, "github, junit:FILE");
              annotate = {Annotate::Form::junit, text.substr(junit.size())};
              return {};
            });
}

std::string annotation_file(const Annotate& annotate, const std::string& command,
                            std::span<const Annotation> annotations) {
  if (annotate.form != Annotate::Form::junit) return {};
  const auto count = [&](Outcome outcome) {
    return std::ranges::count(annotations, outcome, &Annotation::outcome);
  };
  std::string xml = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n"
      "  <testsuite name=\"gnomon {}\" tests=\"{}\" failures=\"{}\" errors=\"{}\">\n",
      command, annotations.size(), count(Outcome::exceeded), count(Outcome::failed));
  for (const Annotation& annotation : annotations) xml += test_case(annotation);
  return xml + "  </testsuite>\n</testsuites>\n";
}

void print_annotations(const Annotate& annotate, std::span<const Annotation> annotations) {
  if (annotate.form != Annotate::Form::github) return;
  for (const Annotation& annotation : annotations) print_error(workflow_command(annotation));
}

Expected<void> put_annotations(const Annotate& annotate, const std::string& command,
                               std::span<const Annotation> annotations) {
  print_annotations(annotate, annotations);
  if (annotate.form != Annotate::Form::junit) return {};
  return write_file(annotate.path, annotation_file(annotate, command, annotations));
}

}  // namespace gnomon::app
