// How one option is added to a command. Its help says unit, range and default. They are taken from the same
// numbers that the parser checks and the same field that it fills. CLI11 throws; what is thrown here is
// caught in command_line.cpp and never leaves this room.
#pragma once

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>

#include "app/invocation.h"
#include "app/options/effect_options.h"
#include "app/options/map_options.h"
#include "app/options/values.h"
#include "scene/base/option_text.h"

namespace gnomon::app {

/// "what [unit; range; default]": the shape of every option's help.
inline std::string describe(std::string_view what, std::string_view unit_and_range,
                            std::string_view fallback) {
  return fmt::format("{} [{}; default {}]", what, unit_and_range, fallback);
}

/// One option that takes one value; `store` parses it and may fail.
template <class Store>
void add_value(CLI::App& command, const std::string& names, const char* type, const std::string& text,
               Store store) {
  const std::string name = names.substr(names.find("--"));
  command
      .add_option_function<std::string>(
          names,
          [name, store = std::move(store)](const std::string& value) {
            if (const Expected<void> stored = store(value); !stored) {
              throw CLI::ValidationError(name, stored.error().reason);
            }
          },
          text)
      ->type_name(type);
}

/// Stores the value of a parse, or hands its error on.
template <class Field, class Value>
Expected<void> assign(Field& field, const Expected<Value>& value) {
  if (!value) return fail(value.error());
  field = static_cast<Field>(*value);
  return {};
}

/// A name, which "" is not: an unset variable of a script would otherwise ask for nothing.
inline void add_name(CLI::App& command, const std::string& names, std::string& field, const char* type,
                     const std::string& text) {
  add_value(command, names, type, text, [&field](const std::string& value) -> Expected<void> {
    if (value.empty()) return fail(ErrorKind::usage, "is empty (allowed: a name)");
    field = value;
    return {};
  });
}

inline void add_integer(CLI::App& command, const std::string& name, int& field, int min, int max,
                        const char* unit, std::string_view what) {
  const std::string range = fmt::format("{}{}{} to {}", unit, *unit ? ", " : "", min, max);
  add_value(
      command, name, "N", describe(what, range, std::to_string(field)),
      [&field, min, max](const std::string& value) { return assign(field, parse_integer(value, min, max)); });
}

inline void add_number(CLI::App& command, const std::string& name, double& field, OptionRange range,
                       const char* unit, const char* what) {
  add_value(command, name, "NUMBER",
            describe(what, fmt::format("{}, {}", unit, range_text(range)), number_text(field)),
            [&field, range](const std::string& value) { return assign(field, parse_number(value, range)); });
}

template <class Enum>
using Choices = std::span<const std::pair<std::string_view, Enum>>;

template <class Enum>
std::string choice_names(Choices<Enum> choices, std::string_view separator) {
  std::string text;
  for (const auto& [name, value] : choices)
    text += (text.empty() ? "" : std::string(separator)) + std::string(name);
  return text;
}

template <class Enum>
Expected<Enum> parse_choice(const std::string& text, Choices<Enum> choices) {
  std::vector<std::string_view> names;
  for (const auto& [name, value] : choices) {
    if (name == text) return value;
    names.push_back(name);
  }
  return fail(ErrorKind::usage, fmt::format("unknown value (got {}, allowed {}){}", text,
                                            choice_names<Enum>(choices, ", "), did_you_mean(text, names)));
}

/// `all` outlives the command.
template <class Enum>
void add_choice(CLI::App& command, const std::string& name, Enum& field,
                std::type_identity_t<Choices<Enum>> all, const char* type, const char* what) {
  std::string_view fallback;
  for (const auto& [text, value] : all) {
    if (value == field) fallback = text;
  }
  add_value(
      command, name, type, describe(what, choice_names<Enum>(all, " or "), fallback),
      [&field, all](const std::string& value) { return assign(field, parse_choice<Enum>(value, all)); });
}

// What every command does with its options once they are bound.

/// When the command is the one that was named:
/// - `finish` completes its map's options where it has a setting.
/// - `given` learns what was typed.
/// - `trace` learns the file of the stages where it asks for that.
/// - The action is `run`.
template <class Command, class Run>
void bind_run(CLI::App& app, Invocation& invocation, const std::shared_ptr<Command>& command, Run run) {
  app.callback([&, command, run] {  // not every command uses app
    if constexpr (requires { command->setting.options.raster.map; })
      invocation.finish = [&app, command] { finish_map_options(app, command->setting.options.raster.map); };
    if constexpr (requires { command->trace; }) command->trace = invocation.trace;
    if constexpr (requires { command->given; }) command->given = given_options(app);
    invocation.action = [command, run] { return run(*command); };
  });
}

}  // namespace gnomon::app
