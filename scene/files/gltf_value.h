// Members of the free-form objects that glTF's extensions are, with defaults for what is not there.
#pragma once

#include <tiny_gltf.h>

#include <string>
#include <vector>

namespace gnomon {

inline const tinygltf::Value* extension(const tinygltf::ExtensionMap& extensions, const std::string& name) {
  const auto found = extensions.find(name);
  return found == extensions.end() ? nullptr : &found->second;
}

inline bool has(const tinygltf::Value* object, const std::string& key) {
  return object && object->IsObject() && object->Has(key);
}

inline double number(const tinygltf::Value* object, const std::string& key, double otherwise) {
  return has(object, key) && object->Get(key).IsNumber() ? object->Get(key).GetNumberAsDouble() : otherwise;
}

/// As many as `otherwise` has.
inline std::vector<double> numbers(const tinygltf::Value* object, const std::string& key,
                                   std::vector<double> otherwise) {
  if (!has(object, key) || !object->Get(key).IsArray()) return otherwise;
  const tinygltf::Value& list = object->Get(key);
  if (list.ArrayLen() != otherwise.size()) return otherwise;
  for (std::size_t i = 0; i < otherwise.size(); ++i)
    if (list.Get(i).IsNumber()) otherwise[i] = list.Get(i).GetNumberAsDouble();
  return otherwise;
}

}  // namespace gnomon
