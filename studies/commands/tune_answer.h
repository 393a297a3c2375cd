// The tuner's answer for people and for programs: the command, why it won, why the others lost, and its bias in the units
// of engines.
#pragma once

#include <string>
#include <vector>

#include "app/options/view_options.h"
#include "app/outputs/run_files.h"
#include "app/strongest_lights.h"
#include "raster/frame.h"
#include "studies/commands/tune_families.h"
#include "studies/tune/tune.h"

namespace gnomon::app {

/// What an answer's command repeats of the question.
struct TuneQuestion {
  SceneArgument scene;
  std::string camera, shader_folder;
  OptionValues fixed;  ///< options with one value
  studies::TuneGoal goal;
  std::vector<raster::ReplacedShader> shaders;  ///< of shader_folder
  FilmedMeasure asked{};
  int max_lights = usual_max_lights;
  const compare::TunedEngine* engine = nullptr;  ///< the one asked about
  double most_seconds = 0.0;                     ///< of processor time
  raster::Backend backend = raster::Backend::automatic;
  ViewListOptions views{};
  bool quick = false;  ///< the first that is good enough was asked for
};

/// Returns what a family has that meets the goal, or what comes nearest to it.
inline const studies::Attempt& attempt_of(const studies::FamilyResult& family) {
  return family.answer ? *family.answer : family.closest;
}

/// The options of an answer, in the order that compare takes them.
OptionValues answer_values(const OptionValues& fixed, const OptionFamily& family,
                           const studies::Attempt& attempt);

struct TuneAnswer {
  const TuneQuestion& question;
  const std::vector<OptionFamily>& families;
  const studies::TuneResult& result;

  /// The options of an attempt of the family, with those that set back what the scene asks for.
  OptionValues values(std::size_t family, const studies::Attempt& attempt) const;
  /// gnomon compare SCENE …, or gnomon shimmer SCENE …, at a family's answer.
  std::string line(std::size_t family) const;
  /// Writes the line of another attempt of the family.
  std::string line(std::size_t family, const studies::Attempt& attempt) const;
  /// Two others: the best of those that engines draw first, of each technique one, then the best of the others.
  std::vector<std::size_t> rivals() const;
  /// The other families: of each technique the best first.
  std::vector<std::size_t> others() const;
  /// At most 80 columns, but for commands: the answer and two rivals, in no more than some twelve lines.
  std::string text() const;
  /// All families, and the bias in the units of all engines.
  std::string whole_text() const;
  std::string json() const;
};

}  // namespace gnomon::app
