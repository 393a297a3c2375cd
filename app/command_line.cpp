// CLI11 parses; what it throws becomes one line and exit code 2 (app/wrong_words.h).
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
#include "app/wrong_words.h"
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

int usage_error(const std::string& text) {
  print_error("gnomon " + one_line(text));
  return static_cast<int>(ErrorKind::usage);
}

int print_failure(const Error& error) {
  print_error(error);
  return static_cast<int>(error.kind);
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

/// The value as the option's help spells it: "PCF" for "pcf", part by part where commas are between.
std::string as_named(const std::string& typed, const std::vector<std::string>& names) {
  std::string value;
  for (std::size_t start = 0; start <= typed.size();) {
    const std::size_t end = std::min(typed.find(',', start), typed.size());
    std::string part = typed.substr(start, end - start);
    for (const std::string& name : names)
      if (is_same_word(part, name)) part = name;
    value += part;
    if (end < typed.size()) value += ',';
    start = end + 1;
  }
  return value;
}

/// Named values are understood in any case.
void take_names_in_any_case(CLI::App& program) {
  std::vector<CLI::App*> takers = program.get_subcommands({});
  takers.push_back(&program);
  for (CLI::App* taker : takers)
    for (CLI::Option* option : taker->get_options())
      if (!option->get_type_name().empty())
        option->transform([option](std::string typed) { return as_named(typed, named_values(*option)); });
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
  program->set_help_flag(
      "--help,-h", "print this help and exit, as gnomon help [COMMAND] does; -h prints what is needed most");
  program->set_version_flag("--version", fmt::format("gnomon {}\n", compare::program_version()),
                            "print the version and exit, as gnomon version does");
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
  take_names_in_any_case(*program);
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

using Words = std::vector<std::string>;

/// What was typed behind the program's name, "help" as --help.
Words words_of(int argc, const char* const* argv) {
  Words words(argv + 1, argv + argc);
  words.front() = option_for(words.front());
  return words;
}

/// -h asks for the help in short, --help for all of it.
int print_help(const CLI::App& command, const Words& words) {
  const bool in_full = std::find(words.begin(), words.end(), "--help") != words.end();
  print_data(in_full ? help_text(command) : short_help_text(command));
  return code_after_stdout(0);
}

/// "gnomon --help compare" says what "gnomon compare --help" does.
int help_on_command(const CLI::App& program, const Words& words) {
  const std::string& name = words[1];
  if (const auto here = missing_program(name); !here) return print_failure(here.error());
  for (const CLI::App* command : program.get_subcommands({}))
    if (command->get_name() == name) return print_help(*command, words);
  return usage_error(unknown_command_text(program, name));
}

bool is_command(const CLI::App& program, const std::string& word) {
  const std::vector<const CLI::App*> commands = program.get_subcommands({});
  return std::any_of(commands.begin(), commands.end(),
                     [&](const CLI::App* command) { return command->get_name() == word; });
}

int parse_and_run(int argc, const char* const* argv, bool runs) {
  Invocation invocation;
  invocation.command_line = command_line_text(argc, argv);
  const std::unique_ptr<CLI::App> program = make_program(invocation);
  if (argc < 2) {
    print_error(short_help_text(*program));
    return static_cast<int>(ErrorKind::usage);
  }
  const Words words = words_of(argc, argv);
  const std::string& first = words.front();
  if (words.size() > 1 && asks_for_help(first) && !words[1].starts_with("-"))
    return help_on_command(*program, words);
  if (const auto here = missing_program(first); !here) return print_failure(here.error());
  if (first == "--describe") {
    print_data(description_of(*program));
    return code_after_stdout(0);
  }
  if (prints_all_commands(first)) {
    const auto missing = describe_others(*program);
    if (!missing) return print_failure(missing.error());
    for (const Error& one : *missing) {
      print_error(one);
      if (!first.starts_with("--completion")) return static_cast<int>(one.kind);
    }
  }
  if (!is_command(*program, first) && !first.starts_with("-"))
    return usage_error(unknown_command_text(*program, first));
  try {
    program->parse(Words(words.rbegin(), words.rend()));  // the last first, as CLI11 wants them
    if (const auto finished = finish_settings(*program, invocation); !finished) {
      return print_failure(finished.error());
    }
    if (!runs) return 0;
    apply_common_options(*program, invocation);
  } catch (const CLI::CallForHelp&) {
    const std::vector<CLI::App*> chosen = program->get_subcommands();
    return print_help(chosen.empty() ? *program : *chosen.front(), words);
  } catch (const CLI::CallForVersion& version) {
    print_data(version.what());
    return code_after_stdout(0);
  } catch (const CLI::ParseError& error) {
    return usage_error(parse_failure_text(*program, error));
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
