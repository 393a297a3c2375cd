#include "app/help/manual.h"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <sstream>

namespace gnomon::app {

namespace {

/// Text as roff takes it literally: backslashes and hyphens escaped, no line that begins with a control
/// character.
std::string roff(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else {
      out += c;
    }
  }
  return out.starts_with('.') || out.starts_with('\'') ? "\\&" + out : out;
}

std::string option_entry(const CLI::Option& option) {
  const std::string names = option.get_positional() ? option.get_name(true) : option.get_name(false, true);
  const std::string value = option.get_positional() ? std::string() : option.get_type_name();
  return fmt::format(".TP\n\\fB{}\\fR{}{}\n{}\n", roff(names), value.empty() ? "" : " ",
                     value.empty() ? "" : "\\fI" + roff(value) + "\\fR", roff(option.get_description()));
}

std::string command_section(const CLI::App& command) {
  std::string text =
      fmt::format(".SS gnomon {}\n{}\n", roff(command.get_name()), roff(command.get_description()));
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_name() != "--help") text += option_entry(*option);
  }
  return text;
}

std::string examples_of(const CLI::App& command) {
  std::string text;
  std::istringstream lines(command.get_footer());
  for (std::string line; std::getline(lines, line);) text += roff(line) + "\n";
  return text;
}

constexpr const char* exit_status =
    ".SH EXIT STATUS\n"
    ".TP\n0\ndone\n"
    ".TP\n1\ndone, but a limit is not kept: more errors, or more uncertain pixels, than "
    "\\fB\\-\\-fail\\-above\\fR allows, or nothing compared; no setting of a sweep or of the tuner within "
    "\\fB\\-\\-max\\-error\\fR; a case of verify that is wrong\n"
    ".TP\n2\nusage\n"
    ".TP\n3\nbad input\n"
    ".TP\n4\nan output could not be written\n"
    ".TP\n5\ngraphics or resources\n"
    ".TP\n6\ninternal error\n"
    ".TP\n130\ninterrupted (SIGINT)\n"
    ".TP\n143\nended by SIGTERM\n"
    ".SH ENVIRONMENT\n"
    ".TP\nNO_COLOR\nwhen set and not empty, nothing is coloured\n";

}  // namespace

std::string man_page(const CLI::App& program, const std::string& version) {
  std::string commands, examples = examples_of(program);
  for (const CLI::App* command : program.get_subcommands({})) {
    commands += command_section(*command);
    examples += examples_of(*command);
  }
  std::string options;
  for (const CLI::Option* option : program.get_options()) options += option_entry(*option);
  return fmt::format(
      ".TH GNOMON 1 \"\" \"gnomon {}\" \"User Commands\"\n"
      ".SH NAME\ngnomon \\- compare shadow maps with ray\\-traced shadows\n"
      ".SH SYNOPSIS\n.B gnomon\n.I COMMAND\n[\\fIOPTIONS\\fR]\n"
      ".SH DESCRIPTION\n{}\n.SH OPTIONS\n{}.SH COMMANDS\n{}.SH EXAMPLES\n.nf\n{}.fi\n{}",
      version, roff(program.get_description()), options, commands, examples, exit_status);
}

}  // namespace gnomon::app
