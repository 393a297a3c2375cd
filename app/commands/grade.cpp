// gnomon grade: a class's shadow shaders against a rubric.
#include "app/grade/grade.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "app/console.h"
#include "app/grade/kits.h"
#include "app/grade/page.h"
#include "app/grade/results.h"
#include "app/interrupt.h"
#include "app/invocation.h"
#include "app/option_kinds.h"
#include "app/options.h"
#include "app/output_path.h"
#include "app/render_json.h"
#include "app/run_files.h"
#include "scene/files/write_file.h"

namespace gnomon::app {

namespace {

struct GradeCommand {
  std::string rubric;
  std::vector<std::string> students;
  std::string folder, json, csv, kit_folder;
  int jobs = 0;
  bool quiet = false;
  std::string command_line;
};

Expected<ExitCode> write_new_kit(const GradeCommand& command, Console& console) {
  const std::string name = command.rubric.empty() ? grade::kit_names().front() : command.rubric;
  if (!grade::is_kit(name))
    return fail(ErrorKind::usage,
                fmt::format("--new: no such rubric of the program's own (got {}, allowed {})", name,
                            fmt::join(grade::kit_names(), ", ")));
  if (!command.students.empty()) return fail(ErrorKind::usage, "--new: takes no students");
  if (const auto made = make_output_folder(command.kit_folder); !made) return fail(made.error());
  const OutputGuard whole_outputs;
  if (const auto written = grade::write_kit(name, command.kit_folder); !written) return fail(written.error());
  console.message(fmt::format("{}: the steps are in {}/README.md", name, command.kit_folder));
  return ExitCode::done;
}

Expected<grade::Rubric> find_rubric(const GradeCommand& command, const std::string& work_folder) {
  if (command.rubric.empty())
    return fail(ErrorKind::usage, fmt::format("a rubric is needed: a file, or one of the program's own ({})",
                                              fmt::join(grade::kit_names(), ", ")));
  if (!grade::is_kit(command.rubric)) return grade::read_rubric(command.rubric);
  const std::string folder = work_folder + "/.kit";
  if (const auto written = grade::write_kit(command.rubric, folder); !written) return fail(written.error());
  return grade::read_rubric(folder + "/rubric.json");
}

/// Before anything is drawn; which scenes the rubric names is not known yet.
Expected<RunFiles> check_grade_files(const GradeCommand& command) {
  if (command.json == "-" && command.csv == "-")
    return fail(ErrorKind::usage, "--json and --csv: stdout takes one of the two (got - for both)");
  RunFiles files;
  if (!grade::is_kit(command.rubric)) files.reads(command.rubric);
  for (const std::string& students : command.students) files.reads_shaders(students);
  files.writes("--json", command.json);
  files.writes("--csv", command.csv);
  files.writes_folder("-o", command.folder, grade::class_file_names);
  if (const auto fine = files.check(); !fine) return fail(fine.error());
  return files;
}

Expected<void> keep_scenes(const grade::Rubric& rubric, RunFiles& files) {
  for (const grade::Check& check : rubric.checks)
    for (const grade::Run& run : check.runs) files.reads(SceneArgument{run.scene});
  return files.check();
}

Expected<void> write_all(const GradeCommand& command, const grade::ClassResult& result, Console& console) {
  const OutputGuard whole_outputs;
  if (!command.folder.empty()) {
    if (const auto made = make_output_folder(command.folder); !made) return made;
    if (const auto written = grade::write_pages(result, command.folder); !written) return written;
    console.message(fmt::format("pages: {}/index.html", command.folder));
  }
  if (const auto written = hand_out_json(command.json, grade::grade_json(result)); !written) return written;
  return hand_out_json(command.csv, grade::grade_csv(result));
}

/// The students, or without any the program's own shader: a rubric is tried before a class is graded with it.
Expected<std::vector<grade::StudentResult>> grade_all(const GradeCommand& command,
                                                      const grade::Rubric& rubric,
                                                      const std::string& work_folder, Console& console) {
  const auto students = grade::find_students(command.students);
  if (!students) return fail(students.error());
  auto grades = grade::grade_class(rubric, *students, work_folder,
                                   {command.jobs, [&](double done) { console.progress("grading", done); }});
  if (!grades) return fail(grades.error());
  if (students->empty()) return std::vector{grades->own};
  for (std::size_t i = 0; i < rubric.checks.size(); ++i)
    if (grades->own.checks[i].points < rubric.checks[i].points)
      console.note(fmt::format("the program's own shader does not pass \"{}\" ({})", rubric.checks[i].name,
                               grades->own.checks[i].reason));
  return std::move(grades->students);
}

Expected<ExitCode> run_grade(const GradeCommand& command) {
  Console console(command.quiet);
  if (!command.kit_folder.empty()) return write_new_kit(command, console);
  auto files = check_grade_files(command);
  if (!files) return fail(files.error());
  const TemporaryFolder work("gnomon-grade");
  if (work.path().empty()) return fail(ErrorKind::cannot_write, "no folder for temporary files can be made");
  const auto rubric = find_rubric(command, work.path());
  if (!rubric) return fail(rubric.error());
  if (const auto kept = keep_scenes(*rubric, *files); !kept) return fail(kept.error());
  const auto students = grade_all(command, *rubric, work.path(), console);
  if (!students) return fail(students.error());
  const grade::ClassResult result{*rubric, *students, command.command_line};
  console.clear_progress();
  const bool prints_data = command.json == "-" || command.csv == "-";
  if (!command.quiet && !prints_data) print_data(grade::grade_table(result));
  if (const auto written = write_all(command, result, console); !written) return fail(written.error());
  return ExitCode::done;
}

}  // namespace

void add_grade(CLI::App& program, Invocation& invocation) {
  CLI::App* app = program.add_subcommand("grade",
                                         "Grade students' shadow shaders against a rubric: points, the "
                                         "reason for each one lost, and the picture that shows it.");
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
