// CLI11 parses; what it throws becomes one line and exit code 2. A wrong command or option name gets a
// suggestion.
#include "app/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "app/commands.h"
#include "app/console.h"
#include "app/help/manual.h"
#include "app/invocation.h"
#include "app/lesson_scene.h"
#include "app/options/options.h"
#include "app/other_programs.h"
#include "app/outputs/run_files.h"
#include "app/process/interrupt.h"
#include "app/process/many_commands.h"
#include "app/session.h"
#include "compare/result/option_names.h"
#include "scene/base/expected.h"
#include "scene/base/many_commands.h"
#include "scene/base/option_text.h"
#include "scene/base/stages.h"
#include "scene/base/threads.h"
#include "scene/files/staged_folder.h"
#include "scene/files/write_file.h"
#include "scene/load.h"

namespace gnomon::app {

namespace {

std::string command_line_text(int argc, const char* const* argv) {
  std::string text = "gnomon";
  for (int i = 1; i < argc; ++i) text += " " + shell_quoted(argv[i]);
  return text;
}

std::vector<std::string_view> command_names(const CLI::App& program) {
  std::vector<std::string_view> names;
  for (const CLI::App* command : program.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

int usage_error(const std::string& text) {
  print_error("gnomon " + one_line(text));
  return static_cast<int>(ErrorKind::usage);
}

int print_failure(const Error& error) {
  print_error(error);
  return static_cast<int>(error.kind);
}

bool looks_like_a_scene(const std::string& word) {
  const std::vector<BuiltinScene> scenes = builtin_scenes();
  return std::filesystem::path(word).has_extension() || !lesson_note(word).empty() ||
         std::any_of(scenes.begin(), scenes.end(),
                     [&](const BuiltinScene& scene) { return scene.name == word; });
}

/// The first word must be a command or one of the program's own options.
int unknown_command(const CLI::App& program, const std::string& word) {
  if (looks_like_a_scene(word)) {
    return usage_error(fmt::format("{0}: not a command; did you mean gnomon compare {0}?", word));
  }
  const std::string hint = did_you_mean(word, command_names(program));
  return usage_error(fmt::format("{}: not a command{}", word, hint.empty() ? " (see gnomon --help)" : hint));
}

/// The first argument that the command did not take.
int unexpected_argument(const CLI::App& command, const std::vector<std::string>& left_over) {
  const std::string prefix = command.get_parent() == nullptr ? "" : command.get_name() + ": ";
  const std::string& word = left_over.front();
  if (!word.starts_with("-") || word == "-") {
    return usage_error(fmt::format("{}one argument too many (got {})", prefix, word));
  }
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  const std::string typed = word.substr(0, word.find('='));
  if (std::find(names.begin(), names.end(), typed) != names.end())
    return usage_error(fmt::format("{}{} stands behind the command's name, not before it", prefix, typed));
  const std::string hint = did_you_mean(typed, std::vector<std::string_view>(names.begin(), names.end()));
  return usage_error(
      fmt::format("{}unknown option {}{}", prefix, typed, hint.empty() ? " (--help lists them)" : hint));
}

/// What CLI11 says by itself of an option's value, in this program's words.
std::string in_plain_words(const std::string& text) {
  const auto parted = [&text](std::string_view before, std::string_view between) {
    const std::size_t at = text.find(between);
    return text.starts_with(before) && at != std::string::npos
               ? std::optional(std::pair(text.substr(before.size(), at - before.size()),
                                         text.substr(at + between.size())))
               : std::nullopt;
  };
  if (const auto flag = parted("Could not convert: ", " = "))
    return fmt::format("{}: not a switch's value (got {}, allowed on, off)", flag->first, flag->second);
  if (const auto none = parted("", ": 1 required "))
    return fmt::format("{}: has no value (allowed {})", none->first,
                       none->second.substr(0, none->second.rfind(" missing")));
  return text;
}

int parse_failure(const CLI::App& program, const CLI::ParseError& error) {
  const std::vector<CLI::App*> chosen = program.get_subcommands();
  const CLI::App& command = chosen.empty() ? program : *chosen.front();
  const std::string prefix = chosen.empty() ? "" : command.get_name() + ": ";
  const auto* extras = dynamic_cast<const CLI::ExtrasError*>(&error);
  const std::vector<std::string> left_over = program.remaining(true);
  const bool no_command = chosen.empty() && !left_over.empty();
  if ((extras != nullptr && !left_over.empty()) || no_command) return unexpected_argument(command, left_over);
  return usage_error(prefix + in_plain_words(error.what()));
}

/// CLI11's way to print a text and stop is the version flag's exception.
void add_completion(CLI::App& program) {
  program
      .add_option_function<std::string>(
          "--completion",
          [&program](const std::string& shell) {
            const std::string script = completion_script(program, shell);
            if (script.empty()) {
              throw CLI::ValidationError(
                  "--completion", fmt::format("unknown shell (got {}, allowed bash, zsh, fish)", shell));
            }
            throw CLI::CallForVersion(script, 0);
          },
          "print what makes a shell complete commands, options and scenes, and exit [bash or zsh or fish]")
      ->type_name("SHELL");
}

void add_man_page(CLI::App& program) {
  program.add_flag_callback(
      "--man-page",
      [&program] {
        throw CLI::CallForVersion(man_page(program, std::string(compare::program_version())), 0);
      },
      "print the manual page (roff) and exit");
}

void add_manual(CLI::App& program) {
  program
      .add_option_function<std::string>(
          "--manual",
          [&program](const std::string& name) {
            const std::string chapter = manual_chapter(program, name);
            if (chapter.empty())
              throw CLI::ValidationError(
                  "--manual",
                  fmt::format("unknown chapter (got {}, allowed options, json, schema, techniques)", name));
            throw CLI::CallForVersion(chapter, 0);
          },
          "print a chapter of the manual as Markdown, or the schema of result.json, and exit [options or "
          "json or schema or techniques]")
      ->type_name("CHAPTER");
}

bool is_single(const CLI::Option& option) {
  return !option.get_positional() && option.get_items_expected_max() <= 1;
}

/// So that advice can be appended to what was typed before.
void let_the_last_count(CLI::App& program) {
  for (CLI::App* command : program.get_subcommands({}))
    for (CLI::Option* option : command->get_options())
      if (is_single(*option)) option->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
}

/// One note for each option that was given again with another value.
std::vector<std::string> replaced_values(const CLI::App& program) {
  std::vector<std::string> notes;
  for (const CLI::App* command : program.get_subcommands())
    for (const CLI::Option* option : command->get_options()) {
      const std::vector<std::string>& values = option->results();
      if (!is_single(*option) ||
          std::adjacent_find(values.begin(), values.end(), std::not_equal_to<>()) == values.end())
        continue;
      const std::string name = option->get_name();
      notes.push_back(
          fmt::format("{} is given {} times: the last, {}, counts{}", name, values.size(), values.back(),
                      name == "--technique" ? ", and options that it does not read are left out" : ""));
    }
  return notes;
}

bool has_trace(std::string_view command) {
  constexpr std::string_view names[] = {"compare",  "judge",   "lessons", "raster",
                                        "raytrace", "shimmer", "sweep",   "tune"};
  return std::find(std::begin(names), std::end(names), command) != std::end(names);
}

std::unique_ptr<CLI::App> make_program(Invocation& invocation) {
  auto program = std::make_unique<CLI::App>(
      "Gnomon renders a scene with shadow maps and with rays, and says for every pixel where the two shadows "
      "differ, "
      "why, and what the accuracy costs in time.",
      "gnomon");
  program->footer(
      "gnomon compare fence       a built-in scene; report: out/fence/report.html\n"
      "gnomon compare model.glb --bias 0.02 --map-size 2048 -o report\n"
      "gnomon plan model.glb      which effects are simulated, and why\n"
      "gnomon scenes              the built-in scenes");
  program->set_help_flag("--help,-h", "print this help and exit");
  program->set_version_flag("--version", fmt::format("gnomon {}\n", compare::program_version()),
                            "print the version and exit");
  add_completion(*program);
  add_man_page(*program);
  add_manual(*program);
  program->require_subcommand(1);
  for (const Command& command : all_commands()) {
    CLI::App* added = program->add_subcommand(std::string(command.name), std::string(command.text));
    if (command.add_options == nullptr) continue;
    command.add_options(added, invocation);
    if (has_trace(command.name)) add_trace(*added, invocation.trace);
  }
  let_the_last_count(*program);
  return program;
}

/// `code`, or the one for outputs that cannot be written when the data did not reach stdout.
int code_after_stdout(int code) {
  if (data_reached_stdout()) return code;
  print_error(Error{ErrorKind::cannot_write, "could not write to stdout"});
  return static_cast<int>(ErrorKind::cannot_write);
}

/// When all else is done, so that every stage is in it.
Expected<void> write_trace(const std::string& path) {
  const StageLog* log = StageLog::current();
  if (path.empty() || log == nullptr) return {};
  const OutputGuard whole_file;
  if (const auto made = make_folder_for(path); !made) return made;
  return write_file(path, log->trace("gnomon"));
}

/// What every command that has them takes by one name.
void apply_common_options(const CLI::App& program, Invocation& invocation) {
  invocation.notes = replaced_values(program);
  for (const CLI::App* command : program.get_subcommands()) {
    if (const CLI::Option* threads = command->get_option_no_throw("--threads");
        threads != nullptr && threads->count() > 0)
      invocation.threads = threads->as<int>();
    if (const CLI::Option* quiet = command->get_option_no_throw("--quiet"); quiet != nullptr)
      invocation.quiet = quiet->count() > 0 && quiet->as<bool>();
  }
}

Expected<ExitCode> act_and_trace(const Invocation& invocation) {
  Console console(invocation.quiet);
  for (const std::string& note : invocation.notes) console.note(note);
  limit_threads(invocation.threads, console);
  if (StageLog* log = StageLog::current()) log->keep_runs(!invocation.trace.empty());
  Expected<ExitCode> code = invocation.action();
  if (!code) return code;
  if (const auto written = write_trace(invocation.trace); !written) return fail(written.error());
  return code;
}

/// An error that names an option which the scene's file set is a mistake in that file.
Error placed(const Error& error, const Invocation& invocation) {
  const auto place = invocation.settings.find(error.field);
  if (place == invocation.settings.end()) return error;
  Error in_file = place->second;
  in_file.reason = error.reason;
  return in_file;
}

/// One message, quiet or not: who planted it may be nobody's friend.
void tell_left_alone() {
  const std::vector<std::string> names = StagedFolder::left_alone();
  if (names.empty()) return;
  constexpr std::size_t most = 4;
  const std::size_t shown = std::min(names.size(), most);
  std::string text =
      fmt::format("gnomon: left alone, though named like unfinished work: {}",
                  fmt::join(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(shown), ", "));
  if (shown < names.size()) text += fmt::format(" and {} more", names.size() - shown);
  print_error(one_line(text));
}

int run_action(const Invocation& invocation) {
  Expected<ExitCode> code = act_and_trace(invocation);
  tell_left_alone();
  // First: a program that this one had started may have failed because the signal reached it, too.
  if (const int interrupted = interrupt_exit_code(); interrupted != 0) return interrupted;
  if (!code) {
    code.error() = placed(code.error(), invocation);
    return print_failure(code.error());
  }
  return code_after_stdout(static_cast<int>(*code));
}

/// Adds what lessons and scenes ask for to what was typed. Error: a scene's settings are wrong. Throws CLI::ParseError
/// where what was typed is.
Expected<void> finish_settings(const CLI::App& program, Invocation& invocation) {
  for (CLI::App* command : program.get_subcommands()) {
    add_lesson_settings(*command);
    auto added = add_scene_settings(*command);
    if (!added) return fail(added.error());
    invocation.settings.merge(*added);
  }
  try {
    if (invocation.finish) invocation.finish();
  } catch (const CLI::ValidationError& wrong) {  // "--cascades: belongs to csm; ..."
    const std::string text = wrong.what(), option = text.substr(0, text.find(':'));
    if (!invocation.settings.contains(option)) throw;
    Error error{ErrorKind::usage, text.substr(option.size() + 2)};
    error.field = option;
    return fail(placed(error, invocation));
  }
  return {};
}

bool prints_all_commands(std::string_view option) {
  return option == "--completion" || option == "--man-page" || option == "--manual" ||
         option.starts_with("--completion=") || option.starts_with("--manual=");
}

/// "gnomon --help compare" asks what "gnomon compare --help" does.
const CLI::App* asked_about(const CLI::App& program, int argc, const char* const* argv) {
  if (argc < 3 || (std::string_view(argv[1]) != "--help" && std::string_view(argv[1]) != "-h"))
    return nullptr;
  for (const CLI::App* command : program.get_subcommands({}))
    if (command->get_name() == argv[2]) return command;
  return nullptr;
}

int parse_and_run(int argc, const char* const* argv, bool runs) {
  Invocation invocation;
  invocation.command_line = command_line_text(argc, argv);
  const std::unique_ptr<CLI::App> program = make_program(invocation);
  if (argc < 2) {
    print_error(help_text(*program));
    return static_cast<int>(ErrorKind::usage);
  }
  const std::string first = argv[1];
  if (const CLI::App* command = asked_about(*program, argc, argv); command != nullptr) {
    if (const auto here = missing_program(command->get_name()); !here) return print_failure(here.error());
    print_data(help_text(*command));
    return code_after_stdout(0);
  }
  if (const auto here = missing_program(first); !here) return print_failure(here.error());
  if (first == "--describe") {
    print_data(description_of(*program));
    return code_after_stdout(0);
  }
  if (prints_all_commands(first))
    if (const auto described = describe_others(*program); !described) return print_failure(described.error());
  const std::vector<std::string_view> known = command_names(*program);
  const bool is_command = std::find(known.begin(), known.end(), first) != known.end();
  if (!is_command && !first.starts_with("-")) return unknown_command(*program, first);
  try {
    program->parse(argc, argv);
    if (const auto finished = finish_settings(*program, invocation); !finished) {
      return print_failure(finished.error());
    }
    if (!runs) return 0;
    apply_common_options(*program, invocation);
  } catch (const CLI::CallForHelp&) {
    const std::vector<CLI::App*> chosen = program->get_subcommands();
    print_data(help_text(chosen.empty() ? *program : *chosen.front()));
    return code_after_stdout(0);
  } catch (const CLI::CallForVersion& version) {
    print_data(version.what());
    return code_after_stdout(0);
  } catch (const CLI::ParseError& error) {
    return parse_failure(*program, error);
  }
  return run_action(invocation);
}

}  // namespace

int check_command_line(int argc, const char* const* argv) {
  return parse_and_run(argc, argv, false);
}

int run_command_line(int argc, const char* const* argv) {
  if (argc == 2 && argv[1] == std::string_view(commands_from_stdin))
    return run_commands_from_stdin(run_command_line);
  try {
    return parse_and_run(argc, argv, true);
  } catch (const std::exception& exception) {
    return print_failure(unforeseen(exception));
  }
}

}  // namespace gnomon::app
