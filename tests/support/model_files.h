// The real models that tests may use when they are there; none of them belongs to the project.
#pragma once

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/places.h"

namespace gnomon::test {

inline std::filesystem::path data_folder() {
  return gnomon::test::shared_data();
}

inline bool data_is_absent() {
  return !std::filesystem::is_directory(data_folder());
}

/// Every scene file outside the folders of broken ones, in a fixed order.
inline std::vector<std::string> well_formed_models() {
  std::vector<std::string> files;
  if (data_is_absent()) return files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(data_folder())) {
    const std::string path = entry.path().string();
    const std::string extension = entry.path().extension().string();
    const bool scene =
        extension == ".gltf" || extension == ".glb" || extension == ".obj" || extension == ".ply";
    if (scene && path.find("malformed") == std::string::npos) files.push_back(path);
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace gnomon::test
