#include "scene/files/image_library.h"

#include <dlfcn.h>
#include <fmt/core.h>

#include <filesystem>

#include "scene/files/path_status.h"

namespace gnomon {
namespace {

/// Beside the program when it is installed (bin and lib/gnomon), else where it was built.
std::vector<std::string> module_paths() {
  std::error_code none;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", none);
  const std::filesystem::path file(GNOMON_IMAGE_MODULE);
  std::vector<std::string> paths;
  if (!none)
    paths.push_back((program.parent_path() / GNOMON_IMAGE_MODULE_FROM_BIN / file.filename()).string());
  paths.push_back(file.string());
  return paths;
}

Expected<const ImageLibrary*> load() {
  std::string why;
  for (const std::string& path : module_paths()) {
    const auto there = is_there(path);
    if (!there || !*there) {
      why += fmt::format("{}{} {}", why.empty() ? "" : "; ", path,
                         there ? "is not there" : there.error().reason);
      continue;
    }
    void* module = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);  // for good: it holds the library's own state
    void* symbol = module == nullptr ? nullptr : dlsym(module, "gnomon_image_library");
    if (symbol != nullptr) return reinterpret_cast<const ImageLibrary* (*)()>(symbol)();
    why += fmt::format("{}{}", why.empty() ? "" : "; ", dlerror());
  }
  return fail(ErrorKind::internal, fmt::format("cannot load the module for image files: {}", why));
}

}  // namespace

Expected<const ImageLibrary*> image_library() {
  static const Expected<const ImageLibrary*> library = load();
  return library;
}

}  // namespace gnomon
