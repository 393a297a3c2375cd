#include "grade/mistakes.h"

#include <embedded/grade_mistakes.h>
#include <fmt/core.h>

#include <algorithm>

#include "functions/functions.h"
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

Mistakes::Mistakes(const Rubric& rubric, const std::string& folder)
    : runs_(rubric, "", folder), folder_(folder) {
  for (const embedded::Entry* list : lists_of(rubric)) add_list(rubric, *list);
}

void Mistakes::add_list(const Rubric& rubric, const embedded::Entry& list) {
  const std::string name(list.name.substr(0, list.name.rfind('.')));
  std::size_t number = 0;
  for (Named& named : mistakes_in(list.bytes))
    all_.push_back({rubric.technique.empty() ? name : "", std::move(named.words), named.hides_rest,
                    file_of(list), fmt::format("#define MISTAKE {}\n{}", ++number, list.bytes)});
}

std::string Mistakes::shaders_of(const std::string& function) const {
  return fmt::format("{}/shaders/{}", folder_, function.empty() ? "technique" : function);
}

Expected<void> Mistakes::write_shaders(const std::string& function) const {
  for (std::size_t i = 0; i < all_.size(); ++i) {
    if (all_[i].function != function) continue;
    const std::string path = fmt::format("{}/{}/{}", shaders_of(function), i, all_[i].file);
    if (const auto made = make_folder_for(path); !made) return made;
    if (const auto written = write_file(path, all_[i].text); !written) return written;
  }
  return {};
}

Expected<void> Mistakes::read_called_of(Files& files) const {
  files.called.resize(all_.size());
  for (std::size_t i = 0; i < all_.size(); ++i) {
    if (all_[i].function != files.run.function) continue;
    auto called = read_each_called(files.run, fmt::format("{}/{}", files.place, i));
    if (!called) return fail(called.error());
    files.called[i] = std::move(*called);
  }
  return {};
}

Expected<const Mistakes::Files*> Mistakes::draw_files(Run run) {
  run.cases.clear();  // one call of a function answers all of them
  const std::string& function = run.function;
  const auto known = std::ranges::find(files_, run, &Files::run);
  if (known != files_.end()) return &*known;
  const bool first = std::ranges::none_of(files_, [&](const Files& f) { return f.run.function == function; });
  if (first)
    if (const auto written = write_shaders(function); !written) return fail(written.error());
  Files files{run, fmt::format("{}/{}", folder_, files_.size()), {}};
  if (const auto drawn = runs_.draw_each(run, shaders_of(function), files.place); !drawn)
    return fail(drawn.error());
  if (!function.empty())
    if (const auto read = read_called_of(files); !read) return fail(read.error());
  return &files_.emplace_back(std::move(files));
}

Expected<const Mistakes::DrawnRun*> Mistakes::draw(const Run& run, const DrawnValues& right) {
  const std::lock_guard lock(drawing_);
  if (const auto known = std::ranges::find(drawn_, run, &DrawnRun::run); known != drawn_.end())
    return &*known;
  const auto files = draw_files(run);
  if (!files) return fail(files.error());
  DrawnRun drawn{run, std::vector<DrawnValues>(all_.size())};
  for (std::size_t i = 0; i < all_.size(); ++i) {
    if (all_[i].function != run.function) continue;
    const bool is_function = !run.function.empty();
    if (is_function && !(*files)->called[i]) continue;
    auto values = is_function ? read_values(run, *(*files)->called[i])
                              : read_drawn(fmt::format("{}/{}", (*files)->place, i), right);
    if (!values) return fail(values.error());
    drawn.values[i] = std::move(*values);
  }
  return &drawn_.emplace_back(std::move(drawn));
}

Expected<Agreement> Mistakes::agreement(std::size_t mistake, const Run& run, const DrawnValues& drawn,
                                        const DrawnValues& right) {
  constexpr Agreement none{.either = 1, .unlike = 1};
  if (all_[mistake].function != run.function) return none;
  const auto all = draw(run, right);
  if (!all) return fail(all.error());
  const DrawnValues& values = (*all)->values[mistake];
  return values.visibility.empty() ? none : compare_drawings(drawn, values, right);
}

Expected<std::vector<std::size_t>> Mistakes::explaining(const Run& run, const DrawnValues& drawn,
                                                        const DrawnValues& right) {
  if (drawn.is_uniform) return std::vector<std::size_t>{};
  const auto all = draw(run, right);
  if (!all) return fail(all.error());
  std::vector<std::pair<std::uint64_t, std::size_t>> found;
  for (std::size_t i = 0; i < all_.size(); ++i) {
    if ((*all)->values[i].is_uniform) continue;  // nor is it known by its answers
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
