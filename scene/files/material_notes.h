// Notes on materials: what is said of 21 of them is one note, not 21.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace gnomon {

class MaterialNotes {
 public:
  /// `one`: of one material, with {} for `what`, where there is something to name; `several`: of more than one.
  void add(const std::string& material, const std::string& one, const std::string& several,
           const std::string& what = {});
  /// Puts them into the scene's notes, in the order in which they came up, and forgets them.
  void put(Scene& scene);

 private:
  struct Said {
    std::string material, what;
    bool operator==(const Said&) const = default;
  };
  struct Group {
    std::string one, several;
    std::vector<Said> of;
  };
  std::vector<Group> groups_;
};

/// The first three, and how many more there are.
std::string some_of(const std::vector<std::string>& names);

}  // namespace gnomon
