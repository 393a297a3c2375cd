#include "scene/files/pictures/image_library.h"

#include <dlfcn.h>
#include <fmt/core.h>

#include <filesystem>

#include "scene/base/parallel.h"
#include "scene/base/threads.h"
#include "scene/files/own_program.h"
#include "scene/files/path_status.h"

namespace gnomon {
namespace {

/// Beside the program when it is installed (bin and lib/gnomon), else where it was built.
std::vector<std::string> module_paths() {
  const std::filesystem::path program = own_program();
  const std::filesystem::path file(GNOMON_IMAGE_MODULE);
  std::vector<std::string> paths;
  if (!program.empty())
    paths.push_back((program.parent_path() / GNOMON_IMAGE_MODULE_FROM_BIN / file.filename()).string());
  paths.push_back(file.string());
  return paths;
}

/// Libraries that come along start them while they are loaded, and end the process where they are refused (log4cplus).
constexpr int threads_of_loading = 4;

/// Besides, for OpenEXR.
int threads_of_reading() {
  return threads_in_use() > 1 ? threads_in_use() : 0;
}

Expected<void> check_threads() {
  const int wanted = threads_of_loading + threads_of_reading(), startable = startable_threads(wanted);
  if (startable == wanted) return {};
  return fail(
      ErrorKind::graphics,
      fmt::format("the library for image files starts {} threads, and only {} more can be started ({})",
                  wanted, startable, thread_limit_words));
}

Expected<const ImageLibrary*> load() {
  if (const auto startable = check_threads(); !startable) return fail(startable.error());
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
    if (symbol != nullptr)
      return reinterpret_cast<const ImageLibrary* (*)(int)>(symbol)(threads_of_reading());
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
