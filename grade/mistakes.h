// The usual mistakes of an exercise, each a shader of its own (mistakes/*.glsl): which of them explains what was drawn.
#pragma once

#include <deque>
#include <mutex>
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
    std::string path, text;  ///< its shader's file and what that holds
    CheckRuns runs;
    std::deque<std::pair<Run, DrawnValues>>
        drawn{};  ///< what was drawn so far; empty values: nothing that counts
    std::mutex drawing{};
    Mistake(std::string f, std::string w, bool h, std::string p, std::string t, CheckRuns r)
        : function(std::move(f)),
          words(std::move(w)),
          hides_rest(h),
          path(std::move(p)),
          text(std::move(t)),
          runs(std::move(r)) {}
  };
  void add_list(const Rubric& rubric, const embedded::Entry& list, const std::string& folder);
  static Expected<void> write_shader(const Mistake& mistake);
  static Expected<const DrawnValues*> draw(Mistake& mistake, const Run& run);
  std::deque<Mistake> all_;  ///< may be drawn by several threads
};

}  // namespace gnomon::grade
