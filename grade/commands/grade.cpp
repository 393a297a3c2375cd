// gnomon grade: a class's shaders against a rubric.
#include "grade/grade.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <memory>
#include <optional>

#include "app/commands.h"
#include "app/console.h"
#include "app/invocation.h"
#include "app/options/option_kinds.h"
#include "app/options/options.h"
#include "app/outputs/render_json.h"
#include "app/outputs/run_files.h"
#include "app/process/interrupt.h"
#include "grade/archive.h"
#include "grade/results.h"
#include "scene/base/expected.h"

namespace gnomon::app {

namespace {

constexpr std::pair<std::string_view, grade::CsvForm> csv_forms[] = {{"points", grade::CsvForm::points},
                                                                     {"moodle", grade::CsvForm::moodle},
                                                                     {"canvas", grade::CsvForm::canvas}};

struct GradeCommand {
  std::string rubric;
  std::vector<std::string> students;
  std::string folder, json, csv, kit_folder;
  grade::CsvForm csv_form = grade::CsvForm::points;
  int jobs = 0;
  bool quiet = false;
  std::string command_line;
};

/// As ./gnomon was typed, which says so; else by name.
std::string called() {
  const char* script = std::getenv("GNOMON_CALLED");
  return script == nullptr || *script == '\0' ? "gnomon" : script;
}

Expected<ExitCode> write_new_kit(const GradeCommand& command, Console& console) {
  const std::string name = command.rubric.empty() ? grade::kit_names().front() : command.rubric;
  if (!grade::is_kit(name))
    return fail(ErrorKind::usage,
                fmt::format("--new: no such rubric of the program's own (got {}, allowed {})", name,
                            fmt::join(grade::kit_names(), ", ")));
  if (!command.students.empty()) return fail(ErrorKind::usage, "--new: takes no students");
  const OutputGuard whole_outputs;
  if (const auto written = grade::write_kit(name, command.kit_folder, called()); !written)
    return fail(written.error());
  console.message(fmt::format("{}: the steps are in {}/README.md", name, command.kit_folder));
  return ExitCode::done;
}

Expected<grade::Rubric> find_rubric(const GradeCommand& command, const std::string& work_folder) {
  if (command.rubric.empty())
    return fail(ErrorKind::usage, fmt::format("a rubric is needed: a file, or one of the program's own ({})",
                                              fmt::join(grade::kit_names(), ", ")));
  if (!grade::is_kit(command.rubric)) return grade::read_rubric(command.rubric);
  const std::string folder = work_folder + "/kit";
  if (const auto written = grade::write_kit(command.rubric, folder); !written) return fail(written.error());
  return grade::read_rubric(folder + "/rubric.json");
}

std::vector<std::string> pages_of(const std::vector<grade::Student>& students) {
  std::vector<std::string> names;
  for (const grade::Student& student : students) names.push_back(one_line(student.name));
  if (names.empty())
    names.emplace_back(grade::own_shader_name);  // a rubric is tried before a class is graded with it
  return grade::page_names(names);
}

/// Before anything is drawn; which scenes the rubric names is not known yet.
Expected<RunFiles> check_grade_files(const GradeCommand& command,
                                     const std::vector<grade::Student>& students) {
  if (command.json == "-" && command.csv == "-")
    return fail(ErrorKind::usage, "--json and --csv: stdout takes one of the two (got - for both)");
  RunFiles files;
  if (!grade::is_kit(command.rubric)) files.reads(command.rubric);
  for (const std::string& folder : command.students) {
    if (grade::is_archive(folder)) files.reads(folder);
    files.reads_shaders(folder);
  }
  files.writes("--json", command.json);
  files.writes("--csv", command.csv);
  const std::vector<std::string> pages = pages_of(students);
  std::vector<std::string_view> names(grade::class_file_names.begin(), grade::class_file_names.end());
  names.insert(names.end(), pages.begin(), pages.end());
  files.writes_folder("-o", command.folder, names);
  if (const auto fine = files.check(); !fine) return fail(fine.error());
  if (command.folder.empty()) return files;
  if (const auto fine = grade::check_pages(command.folder, {names.begin(), names.end()}); !fine)
    return fail(fine.error());
  return files;
}

Expected<void> keep_scenes(const grade::Rubric& rubric, RunFiles& files) {
  for (const grade::Check& check : rubric.checks)
    for (const grade::Run& run : check.runs) files.reads(SceneArgument{run.scene});
  return files.check();
}

/// All files appear, or none; what goes onto stdout comes regardless.
Expected<void> write_all(const GradeCommand& command, const grade::ClassResult& result,
                         const std::vector<std::string>& inputs, Console& console) {
  const OutputGuard whole_outputs;
  const std::vector<FileText> texts{{command.json, grade::grade_json(result)},
                                    {command.csv, grade::grade_csv(result, command.csv_form)}};
  StagedFiles files;
  if (command.folder.empty()) return publish_texts(texts, files);
  const auto written = grade::write_pages(result, command.folder, inputs, texts_for_files(texts));
  print_texts(texts);
  if (!written) return written;
  console.message(fmt::format("pages: {}/index.html", command.folder));
  return {};
}

Expected<std::vector<grade::StudentResult>> grade_all(const GradeCommand& command,
                                                      const grade::Rubric& rubric,
                                                      const std::vector<grade::Student>& students,
                                                      const std::string& work_folder, Console& console) {
  auto grades = grade::grade_class(rubric, students, work_folder,
                                   {command.jobs, [&](double done) { console.progress("grading", done); }});
  if (!grades) return fail(grades.error());
  if (students.empty()) return std::vector{grades->own};
  for (std::size_t i = 0; i < rubric.checks.size(); ++i)
    if (grades->own.checks[i].points < rubric.checks[i].points)
      console.note(fmt::format("the program's own shader does not pass \"{}\" ({})", rubric.checks[i].name,
                               grades->own.checks[i].reason));
  return std::move(grades->students);
}

/// Students who could not be graded have no points and are one error; the others have theirs.
Expected<ExitCode> ungraded(const std::vector<grade::StudentResult>& students) {
  std::optional<Error> first;
  std::string list;
  for (const grade::StudentResult& student : students) {
    if (!student.error) continue;
    list += fmt::format("{}{} ({})", list.empty() ? "" : ", ", student.name, student.error->message());
    if (!first) first = student.error;
  }
  if (!first) return ExitCode::done;
  return fail(first->kind,
              fmt::format("not graded: {}; mend that and grade again, all others have their points", list));
}

Expected<ExitCode> run_grade(const GradeCommand& command) {
  Console console(command.quiet);
  if (!command.kit_folder.empty()) return write_new_kit(command, console);
  const TemporaryFolder work("gnomon-grade");
  if (work.path().empty()) return fail(ErrorKind::cannot_write, "no folder for temporary files can be made");
  const auto students = grade::find_students(command.students, work.path() + "/unpacked");
  if (!students) return fail(students.error());
  auto files = check_grade_files(command, *students);
  if (!files) return fail(files.error());
  const auto rubric = find_rubric(command, work.path());
  if (!rubric) return fail(rubric.error());
  if (const auto kept = keep_scenes(*rubric, *files); !kept) return fail(kept.error());
  const auto graded = grade_all(command, *rubric, *students, work.path(), console);
  if (!graded) return fail(graded.error());
  std::vector<grade::Answer> answers;
  for (const grade::StudentResult& student : *graded) answers.push_back(student.answer);
  const grade::ClassResult result{*rubric, *graded, command.command_line, grade::alike_in(answers, *rubric)};
  console.clear_progress();
  const bool prints_data = command.json == "-" || command.csv == "-";
  if (!command.quiet && !prints_data) print_data(grade::grade_table(result));
  if (const auto written = write_all(command, result, files->inputs(), console); !written)
    return fail(written.error());
  return ungraded(*graded);
}

}  // namespace

GNOMON_COMMAND(grade, 150,
               "Grade students' shaders against a rubric: points, the reason for each one lost, and the "
               "picture that shows it.") {
  app->footer(
      "gnomon grade --new homework                       a rubric, scenes and a shader to fill in\n"
      "gnomon grade homework/rubric.json class -o grades     every folder in class/ is a student\n"
      "gnomon grade first-shadow-map anna bert --json -\n"
      "gnomon grade my-rubric.json                       does the program's own shader pass it?");
  const auto command = std::make_shared<GradeCommand>();
  command->command_line = invocation.command_line;
  app->add_option("RUBRIC", command->rubric,
                  fmt::format("a rubric's file (gnomon/rubric/1), or one of the program's own: {}",
                              fmt::join(grade::kit_names(), ", ")));
  app->add_option("STUDENTS", command->students,
                  "folders with a student's shaders, or with such folders in them; none: the program's own "
                  "shader is graded");
  add_output(*app, "-o,--output", command->folder, "DIR",
             "folder for a page for each student, index.html, grades.json and grades.csv [default: none]");
  add_output(*app, "--csv", command->csv, "FILE|-", "also write the points as CSV [default: none]");
  add_choice(*app, "--csv-form", command->csv_form, csv_forms, "NAME",
             "columns of --csv: points of each check, or those that Moodle or Canvas reads in");
  add_output(*app, "--new", command->kit_folder, "DIR",
             "instead write what a class needs to begin: the rubric, its scenes, and the shader with its "
             "steps to fill in");
  add_integer(*app, "--jobs", command->jobs, 0, 256, "0: one for each processor",
              "students graded at a time");
  add_json(*app, command->json, "the points and reasons");
  add_quiet(*app, command->quiet);
  app->callback([command, &invocation] { invocation.action = [command] { return run_grade(*command); }; });
}

}  // namespace gnomon::app
