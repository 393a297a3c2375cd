#include "grade/grade.h"

#include <fmt/core.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <deque>
#include <future>
#include <mutex>
#include <shared_mutex>
#include <thread>
#include <utility>

#include "compare/result/number_text.h"
#include "functions/functions.h"
#include "grade/answers.h"
#include "grade/judgement.h"
#include "scene/base/expected.h"
#include "scene/base/threads.h"
#include "scene/files/path_status.h"
#include "scene/files/read_file.h"

namespace gnomon::grade {

namespace {

std::string caption_of(const std::string& file) {
  if (file == "raster.png") return "drawn with this shader";
  if (file == "raytrace.png") return "the truth, ray traced";
  return "where it is wrong, and why";
}

Expected<std::vector<Picture>> load_pictures(const Run& run, const RunResult& result) {
  if (!run.function.empty()) return answer_pictures(run, result);
  std::vector<Picture> pictures;
  const auto names = pictures_of(result);
  if (!names) return fail(names.error());
  for (const std::string& name : *names) {
    auto png = read_file(result.folder + "/" + name);
    if (!png) return fail(png.error());
    pictures.push_back({caption_of(name), std::move(*png),
                        name.starts_with("labels") ? labels_of(result) : std::vector<compare::Label>{}});
  }
  return pictures;
}

/// Every run of the rubric once.
std::vector<Run> all_runs(const Rubric& rubric) {
  std::vector<Run> runs;
  for (const Check& check : rubric.checks)
    for (const Run& run : check.runs)
      if (std::find(runs.begin(), runs.end(), run) == runs.end()) runs.push_back(run);
  return runs;
}

/// What else tells mistakes apart that explain this run: the rubric's other comparisons, or all of the function's cases.
std::vector<Run> beside(const Rubric& rubric, const Run& known) {
  if (known.function.empty()) return all_runs(rubric);
  std::vector<Run> runs;
  for (const std::string_view group : functions::groups_of(*functions::find_function(known.function))) {
    runs.push_back(known);
    runs.back().cases = group;
  }
  return runs;
}

/// The function's other checks, one run of each kind of cases.
std::vector<Run> other_checks(const Rubric& rubric, const Run& known) {
  std::vector<Run> runs;
  for (const Run& run : all_runs(rubric))
    if (!known.function.empty() && run.function == known.function && run.cases != known.cases)
      runs.push_back(run);
  return runs;
}

/// How far a mistake explains what a function's other checks show.
struct Explanation {
  std::uint64_t wrong = 0, explained = 0;     ///< numbers of answers
  std::uint64_t would_be = 0, confirmed = 0;  ///< that the mistake makes wrong, and that are wrong like this
  bool is_contradicted = false;               ///< a check is all right where the mistake would show
  /// It explains most of what is wrong, and what it would make wrong is mostly so.
  bool holds() const {
    if (2 * explained < wrong) return false;
    return 3 * confirmed >= 2 * would_be || (!is_contradicted && 2 * confirmed >= would_be);
  }
};

/// Tenths of points, fewer than all of them.
double part_of(double points, double share) {
  return std::min(std::floor(10.0 * points * share) / 10.0, points - 0.1);
}

/// A drawing's mistake stands before what was measured; of a function the wrong answer comes first.
std::string explained(const Run& run, const std::string& mistake, const Agreement& agreement,
                      const std::string& reason) {
  const std::string alike = compare::percent(agreement.alike());
  if (run.function.empty())
    return fmt::format("drawn as if {}, on {} of the pixels; {}", mistake, alike, reason);
  return fmt::format("{}; answered as if {}, on {} of the cases", reason, mistake, alike);
}

/// One student, or the program's own shader.
class Grader {
 public:
  Grader(Class& of, CheckRuns& runs) : class_(of), runs_(runs) {}

  Expected<CheckResult> grade(const Check& check) {
    CheckResult result;
    result.command = runs_.command(check.runs.front());
    double share = 1.0;
    for (const Run& run : check.runs) {
      const auto judgement = try_run(check, run, result);
      if (!judgement) return fail(judgement.error());
      if (judgement->passed && result.reason.empty()) result.reason = judgement->reason;
      if (judgement->passed || judgement->share >= share) continue;
      share = judgement->share, result.reason = judgement->reason;
      result.command = runs_.command(run);
      if (share == 0.0) break;
    }
    result.points = share < 1.0 ? part_of(check.points, share) : check.points;
    if (share == 1.0) result.pictures.clear();
    return result;
  }

 private:
  Expected<Judgement> try_run(const Check& check, const Run& run, CheckResult& result) {
    if (std::find(hanging_.begin(), hanging_.end(), run.function) != hanging_.end())
      return Judgement{false, run.function.empty() ? "not tried: a drawing before it did not end in time"
                                                   : "not tried: the function did not end in time"};
    const auto drawing = draw_undisturbed(runs_, run, class_.quiet);
    if (!drawing) return fail(drawing.error());
    if (!(*drawing)->result) {
      if ((*drawing)->out_of_time) hanging_.push_back(run.function);
      result.excerpt = (*drawing)->excerpt;
      return Judgement{false, (*drawing)->failure};
    }
    const RunResult& drawn = *(*drawing)->result;
    auto judgement = judge(check, run, drawn, runs_, class_);
    if (!judgement || judgement->passed) return judgement;
    if (check.kind != CheckKind::time) {
      auto explained = explain(run, drawn, std::move(*judgement), result);
      if (!explained || explained->passed) return explained;
      judgement = std::move(explained);
    }
    auto pictures = load_pictures(run, drawn);
    if (!pictures) return fail(pictures.error());
    result.pictures = std::move(*pictures);
    return judgement;
  }

  /// Names the mistake that explains a drawing which did not pass; one that was named before is taken as mended.
  Expected<Judgement> explain(const Run& run, const RunResult& drawn, Judgement judgement,
                              CheckResult& result) {
    if (rest_is_hidden_) return judgement;
    const auto right = own_values(run);
    if (!right) return fail(right.error());
    const auto values = read_values(run, drawn);
    if (!values) return fail(values.error());
    for (const std::size_t known : named_) {
      const auto agreement = class_.mistakes.agreement(known, run, *values, **right);
      if (!agreement) return fail(agreement.error());
      if (agreement->is_like() && !result.mistake_named)
        return Judgement{true, "right but for the mistake named above", 1.0};
    }
    auto found = class_.mistakes.explaining(run, *values, **right);
    if (!found) return fail(found.error());
    for (std::size_t i = found->size(); i-- > 0;) {
      const auto holds = holds_elsewhere((*found)[i], run);
      if (!holds) return fail(holds.error());
      if (!*holds) found->erase(found->begin() + static_cast<std::ptrdiff_t>(i));
    }
    if (found->empty()) return judgement;
    const auto one = most_likely(run, std::move(*found));
    if (!one) return fail(one.error());
    const auto agreement = class_.mistakes.agreement(*one, run, *values, **right);
    if (!agreement) return fail(agreement.error());
    rest_is_hidden_ = class_.mistakes.hides_rest(*one);
    if (!rest_is_hidden_) named_.push_back(*one), result.mistake_named = true;
    result.mistake = class_.mistakes.words(*one);
    judgement.reason = explained(run, class_.mistakes.words(*one), *agreement, judgement.reason);
    judgement.share = 0.0;  // later checks forgive it, however little shows of it here
    return judgement;
  }

  /// A few cases may look like a mistake that is not there: it has to explain what the function's other checks show, too.
  Expected<bool> holds_elsewhere(std::size_t mistake, const Run& known) {
    Explanation sum;
    for (const Run& run : other_checks(class_.rubric, known)) {
      const auto drawing = draw_undisturbed(runs_, run, class_.quiet);
      if (!drawing) return fail(drawing.error());
      if (!(*drawing)->result) continue;
      const auto right = own_values(run);
      if (!right) return fail(right.error());
      const auto values = read_values(run, *(*drawing)->result);
      if (!values) return fail(values.error());
      const auto agreement = class_.mistakes.agreement(mistake, run, *values, **right);
      if (!agreement) return fail(agreement.error());
      sum.is_contradicted = sum.is_contradicted || (agreement->wrong == 0 && agreement->other_wrong > 0);
      sum.wrong += agreement->wrong, sum.explained += agreement->explained;
      sum.would_be += agreement->other_wrong, sum.confirmed += agreement->explained;
      if (2 * agreement->explained >= agreement->wrong) continue;
      // Another mistake that is known may be there as well.
      const auto others = class_.mistakes.explaining(run, *values, **right);
      if (!others) return fail(others.error());
      if (!others->empty()) sum.explained += agreement->wrong - agreement->explained;
    }
    return sum.holds();
  }

  /// Several mistakes may draw a run as the student did. Returns the one that draws the other runs so, too.
  Expected<std::size_t> most_likely(const Run& known, std::vector<std::size_t> mistakes) {
    for (const Run& run : beside(class_.rubric, known)) {
      if (mistakes.size() == 1) break;
      if (run == known) continue;
      const auto drawing = draw_undisturbed(runs_, run, class_.quiet);
      if (!drawing) return fail(drawing.error());
      if (!(*drawing)->result) continue;
      const auto right = own_values(run);
      if (!right) return fail(right.error());
      const auto values = read_values(run, *(*drawing)->result);
      if (!values) return fail(values.error());
      std::vector<std::size_t> left;
      for (const std::size_t mistake : mistakes) {
        const auto agreement = class_.mistakes.agreement(mistake, run, *values, **right);
        if (!agreement) return fail(agreement.error());
        if (agreement->is_like()) left.push_back(mistake);
      }
      if (!left.empty()) mistakes = std::move(left);
    }
    return mistakes.front();
  }

  /// What the program's own shader draws.
  Expected<const DrawnValues*> own_values(const Run& run) {
    const std::lock_guard lock(class_.own_mutex);
    for (const auto& [known, values] : class_.own_values)
      if (known == run) return &values;
    const auto own = class_.own.draw(run);
    if (!own) return fail(own.error());
    auto values = read_values(run, *(*own)->result);
    if (!values) return fail(values.error());
    return &class_.own_values.emplace_back(run, std::move(*values)).second;
  }

  Class& class_;
  CheckRuns& runs_;
  std::vector<std::size_t> named_;    ///< mistakes
  std::vector<std::string> hanging_;  ///< the functions that did not end in time; "": drawings
  bool rest_is_hidden_ = false;       ///< by a mistake that was named, so that nothing further can be
};

CheckResult no_points(std::string reason) {
  CheckResult result;
  result.reason = std::move(reason);
  return result;
}

/// Why a check is not looked at; empty where it is.
std::string missing_need(const Rubric& rubric, const Check& check, const std::vector<CheckResult>& earlier) {
  for (const std::size_t needed : check.needs)
    if (2.0 * earlier[needed].points <= rubric.checks[needed].points && !earlier[needed].mistake_named)
      return fmt::format("waits until \"{}\" has more than half its points", rubric.checks[needed].name);
  return {};
}

Expected<StudentResult> grade_checks(Class& of, const std::string& name, CheckRuns& runs) {
  StudentResult result{name, {}};
  Grader grader(of, runs);
  for (const Check& check : of.rubric.checks) {
    if (std::string first = missing_need(of.rubric, check, result.checks); !first.empty()) {
      result.checks.push_back(no_points(std::move(first)));
      continue;
    }
    auto graded = grader.grade(check);
    if (!graded) return fail(graded.error());
    result.checks.push_back(std::move(*graded));
  }
  return result;
}

/// `name`: plain text, whatever the folder is called.
Expected<StudentResult> judge_student(Class& of, const Student& student, const std::string& name,
                                      const std::string& folder) {
  const auto handed_in = take_in(student, of.rubric);
  if (!handed_in) return fail(handed_in.error());
  if (!handed_in->refused.empty())
    return StudentResult{name, {of.rubric.checks.size(), no_points(handed_in->refused)}};
  const std::string shaders = folder + "/shaders";
  if (const auto written = write_with_given(*handed_in, of.rubric, shaders); !written)
    return fail(written.error());
  CheckRuns runs(of.rubric, shaders, folder);
  runs.call_shaders(handed_in->files);
  auto result = grade_checks(of, name, runs);
  if (result) result->answer = answer_of(*handed_in);
  // A class of drawings would fill the disk.
  if (const auto removed = remove_all_of(folder); !removed && result) return fail(removed.error());
  return result;
}

/// What goes wrong with one costs the others nothing.
StudentResult grade_student(Class& of, const Student& student, std::size_t index) {
  const std::string name = one_line(student.name);
  auto result = judge_student(of, student, name, fmt::format("{}/{}", of.work_folder, index));
  if (!result)
    result =
        StudentResult{name, {of.rubric.checks.size(), no_points(result.error().message())}, result.error()};
  result->participant = student.participant;
  return std::move(*result);
}

/// What the program itself cannot draw is the rubric's fault.
Expected<void> check_drawings(Class& of) {
  for (const Check& check : of.rubric.checks) {
    for (const Run& run : check.runs) {
      const auto drawing = draw_undisturbed(of.own, run, of.quiet);
      if (!drawing) return fail(drawing.error());
      if (!(*drawing)->result)
        return fail(ErrorKind::bad_input, fmt::format("check \"{}\": {}: {}", check.name, of.own.command(run),
                                                      (*drawing)->failure));
    }
  }
  return {};
}

}  // namespace

double StudentResult::points() const {
  double sum = 0.0;
  for (const CheckResult& check : checks) sum += check.points;
  return sum;
}

Expected<Grades> grade_class(const Rubric& rubric, const std::vector<Student>& students,
                             const std::string& work_folder, const GradeOptions& options) {
  const std::string own_shaders = rubric.technique.empty() ? work_folder + "/own/shaders" : "";
  if (!own_shaders.empty())
    if (const auto written = write_right_functions(rubric, own_shaders); !written)
      return fail(written.error());
  Class of{rubric, work_folder, CheckRuns(rubric, own_shaders, work_folder + "/own"),
           Mistakes(rubric, work_folder + "/mistakes")};
  if (const auto drawn = check_drawings(of); !drawn) return fail(drawn.error());
  auto own = grade_checks(of, std::string(own_shader_name), of.own);
  if (!own) return fail(own.error());
  of.own.end_process();
  std::vector<StudentResult> graded(students.size());
  std::atomic<std::size_t> next{0};
  std::size_t done = 0;
  std::mutex progress_mutex;
  const auto work = [&] {
    for (std::size_t i = next++; i < students.size(); i = next++) {
      graded[i] = grade_student(of, students[i], i);
      const std::lock_guard lock(progress_mutex);
      ++done;
      if (options.progress)
        options.progress(static_cast<double>(done) / static_cast<double>(students.size()));
    }
  };
  const std::size_t processors = std::max(1u, std::thread::hardware_concurrency());
  const std::size_t jobs = options.jobs > 0 ? static_cast<std::size_t>(options.jobs) : processors;
  std::vector<std::future<void>> workers;
  while (workers.size() + 1 < std::min(students.size(), jobs)) workers.push_back(in_background(work));
  work();
  for (std::future<void>& worker : workers) worker.get();
  return Grades{std::move(*own), std::move(graded)};
}

}  // namespace gnomon::grade
