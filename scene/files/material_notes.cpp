#include "scene/files/material_notes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <span>

namespace gnomon {

std::string some_of(const std::vector<std::string>& names) {
  constexpr std::size_t most = 3;
  const std::span<const std::string> shown(names.data(), std::min(most, names.size()));
  std::string text = fmt::format("{}", fmt::join(shown, ", "));
  if (names.size() > most) text += fmt::format(" and {} more", names.size() - most);
  return text;
}

void MaterialNotes::add(const std::string& material, const std::string& one, const std::string& several,
                        const std::string& what) {
  auto group = std::find_if(groups_.begin(), groups_.end(), [&](const Group& g) { return g.one == one; });
  if (group == groups_.end()) group = groups_.insert(group, {one, several, {}});
  const Said said{material, what};
  if (std::find(group->of.begin(), group->of.end(), said) == group->of.end()) group->of.push_back(said);
}

void MaterialNotes::put(Scene& scene) {
  for (const Group& group : groups_) {
    if (group.of.size() == 1) {
      const Said& said = group.of.front();
      scene.notes.push_back(
          fmt::format("Material '{}': {}.", said.material, fmt::format(fmt::runtime(group.one), said.what)));
      continue;
    }
    std::vector<std::string> names;
    for (const Said& said : group.of)
      names.push_back(said.what.empty() ? said.material : fmt::format("{} ({})", said.material, said.what));
    scene.notes.push_back(fmt::format("{}: {}.", group.several, some_of(names)));
  }
  groups_.clear();
}

}  // namespace gnomon
