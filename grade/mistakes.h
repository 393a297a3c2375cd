// The usual mistakes of an exercise, each a shader of its own (mistakes/*.glsl): which of them explains what was drawn.
#pragma once

#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "grade/check_runs.h"
#include "scene/base/expected.h"

namespace gnomon::embedded {
struct Entry;
}

namespace gnomon::grade {

/// Whether a list of mistakes is known for the shader that the rubric asks for.
bool has_known_mistakes(const Rubric& rubric);

/// Writes the program's own answers for the functions that are handed in: each list of mistakes holds one, without any.
Expected<void> write_right_functions(const Rubric& rubric, const std::string& folder);

class Mistakes {
 public:
  /// The shaders and drawings of the mistakes lie below `folder`.
  Mistakes(const Rubric& rubric, const std::string& folder);

  /// What a mistake is called: "right and up were exchanged".
  const std::string& words(std::size_t mistake) const { return all_[mistake].words; }
  /// What it draws is too flat for later checks to go on as if it were mended.
  bool hides_rest(std::size_t mistake) const { return all_[mistake].hides_rest; }

  /// The drawing of a run beside the one that the mistake makes. `right` is that of the program's own shader.
  Expected<Agreement> agreement(std::size_t mistake, const Run& run, const DrawnValues& drawn,
                                const DrawnValues& right);
  /// The mistakes that draw all but a twentieth of what is wrong alike, the one that draws most alike first. None for a
  /// drawing that is uniform: any flat picture explains another.
  Expected<std::vector<std::size_t>> explaining(const Run& run, const DrawnValues& drawn,
                                                const DrawnValues& right);

 private:
  struct Mistake {
    std::string function;  ///< which it is a mistake of; empty: a technique's
    std::string words;
    bool hides_rest;
    std::string file, text;  ///< "technique/hard.glsl", and what that holds
  };
  /// What every mistake draws of a run; empty values: nothing that counts.
  struct DrawnRun {
    Run run;
    std::vector<DrawnValues> values;
  };
  /// What one process left of a run, whatever its cases.
  struct Files {
    Run run;
    std::string place;  ///< holds a folder for each mistake, named as that of its shaders
    std::vector<std::optional<RunResult>> called;  ///< of a function, by mistake, read once
  };
  void add_list(const Rubric& rubric, const embedded::Entry& list);
  /// Where the shaders of a function's mistakes lie, or of a technique's: a folder for each mistake, named by its number.
  std::string shaders_of(const std::string& function) const;
  Expected<void> write_shaders(const std::string& function) const;
  /// Draws them all at once when they are first asked for.
  Expected<const DrawnRun*> draw(const Run& run, const DrawnValues& right);
  Expected<const Files*> draw_files(Run run);
  Expected<void> read_called_of(Files& files) const;

  CheckRuns runs_;
  std::string folder_;
  std::vector<Mistake> all_;
  std::mutex drawing_;  ///< several threads ask
  std::deque<Files> files_;
  std::deque<DrawnRun> drawn_;  ///< what was handed out stays where it is
};

}  // namespace gnomon::grade
