#include "grade/mistakes.h"

#include <embedded/grade_mistakes.h>
#include <fmt/core.h>

#include <algorithm>

#include "functions/functions.h"
#include "scene/files/path_status.h"
#include "scene/files/write_file.h"

namespace gnomon::grade {
namespace {

/// The file that a list's shaders are: "technique/hard.glsl".
std::string file_of(const embedded::Entry& list) {
  const std::string_view name = list.name;
  const bool of_function = functions::find_function(name.substr(0, name.rfind('.'))) != nullptr;
  return fmt::format("{}/{}", of_function ? "function" : "technique", name);
}

/// The lists for the files that are handed in or that stand for those.
std::vector<const embedded::Entry*> lists_of(const Rubric& rubric) {
  const auto asked = [&](const std::string& name) {
    return std::find(rubric.hand_in.begin(), rubric.hand_in.end(), name) != rubric.hand_in.end() ||
           std::any_of(rubric.given.begin(), rubric.given.end(),
                       [&](const GivenFile& given) { return given.name == name; });
  };
  std::vector<const embedded::Entry*> lists;
  for (const embedded::Entry& entry : embedded::grade_mistakes_entries())
    if (asked(file_of(entry))) lists.push_back(&entry);
  return lists;
}

struct Named {
  std::string words;
  bool hides_rest = false;
};

/// The sentences of "// mistake 3: up was mirrored" or "// mistake 3, which hides the rest: ...", in their order.
std::vector<Named> mistakes_in(std::string_view text) {
  std::vector<Named> names;
  for (;;) {
    const std::string mark = fmt::format("\n// mistake {}", names.size() + 1);
    const std::size_t at = text.find(mark);
    if (at == std::string_view::npos) return names;
    const std::string_view line = text.substr(at + 1, text.find('\n', at + 1) - at - 1);
    const std::size_t colon = line.find(": ");
    names.push_back({std::string(line.substr(colon + 2)), line.substr(0, colon).ends_with("hides the rest")});
  }
}

}  // namespace

bool has_known_mistakes(const Rubric& rubric) {
  return !lists_of(rubric).empty();
}

Expected<void> write_right_functions(const Rubric& rubric, const std::string& folder) {
  for (const embedded::Entry* list : lists_of(rubric)) {
    const std::string path = fmt::format("{}/{}", folder, file_of(*list));
    if (const auto made = make_folder_for(path); !made) return made;
    if (const auto written = write_file(path, fmt::format("#define MISTAKE 0\n{}", list->bytes)); !written)
      return written;
  }
  return {};
}

Mistakes::Mistakes(const Rubric& rubric, const std::string& folder) {
  for (const embedded::Entry* list : lists_of(rubric)) add_list(rubric, *list, folder);
}

void Mistakes::add_list(const Rubric& rubric, const embedded::Entry& list, const std::string& folder) {
  const std::string file = file_of(list), name(list.name.substr(0, list.name.rfind('.')));
  std::size_t number = 0;
  for (Named& named : mistakes_in(list.bytes)) {
    const std::string own = fmt::format("{}/{}", folder, all_.size() + 1), shaders = own + "/shaders";
    all_.emplace_back(rubric.technique.empty() ? name : "", std::move(named.words), named.hides_rest,
                      fmt::format("{}/{}", shaders, file),
                      fmt::format("#define MISTAKE {}\n{}", ++number, list.bytes),
                      CheckRuns(rubric, shaders, own));
  }
}

Expected<void> Mistakes::write_shader(const Mistake& mistake) {
  const auto there = is_there(mistake.path, ErrorKind::cannot_write);
  if (!there) return fail(there.error());
  if (*there) return {};
  if (const auto made = make_folder_for(mistake.path); !made) return made;
  return write_file(mistake.path, mistake.text);
}

Expected<const DrawnValues*> Mistakes::draw(Mistake& mistake, const Run& run) {
  const std::lock_guard lock(mistake.drawing);
  for (const auto& [known, values] : mistake.drawn)
    if (known == run) return &values;
  if (const auto written = write_shader(mistake); !written) return fail(written.error());
  const auto drawing = mistake.runs.draw(run);
  if (!drawing) return fail(drawing.error());
  auto values = (*drawing)->result ? read_values(run, *(*drawing)->result) : DrawnValues{};
  if (!values) return fail(values.error());
  return &mistake.drawn.emplace_back(run, std::move(*values)).second;
}

Expected<Agreement> Mistakes::agreement(std::size_t mistake, const Run& run, const DrawnValues& drawn,
                                        const DrawnValues& right) {
  if (all_[mistake].function != run.function) return Agreement{.either = 1, .unlike = 1};
  const auto values = draw(all_[mistake], run);
  if (!values) return fail(values.error());
  if ((*values)->visibility.empty()) return Agreement{.either = 1, .unlike = 1};
  return compare_drawings(drawn, **values, right);
}

Expected<std::vector<std::size_t>> Mistakes::explaining(const Run& run, const DrawnValues& drawn,
                                                        const DrawnValues& right) {
  if (drawn.is_uniform) return std::vector<std::size_t>{};
  std::vector<std::pair<std::uint64_t, std::size_t>> found;
  for (std::size_t i = 0; i < all_.size(); ++i) {
    const auto beside = agreement(i, run, drawn, right);
    if (!beside) return fail(beside.error());
    if (beside->wrong > 0 && beside->is_like()) found.emplace_back(beside->unlike, i);
  }
  std::sort(found.begin(), found.end());
  std::vector<std::size_t> mistakes;
  for (const auto& [unlike, mistake] : found) mistakes.push_back(mistake);
  return mistakes;
}

}  // namespace gnomon::grade
