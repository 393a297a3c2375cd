#include "app/process/machine.h"

#include <cstdlib>
#include <string>

#if defined(__GLIBC__) && defined(__linux__)
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "scene/files/own_program.h"
#endif

namespace gnomon::app {

bool are_asked_for(std::string_view choices) {
  return choices.find("[madvise]") != std::string_view::npos;
}

void start_with_large_pages([[maybe_unused]] char** argv) {
#if defined(__GLIBC__) && defined(__linux__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
  constexpr const char* tunables = "GLIBC_TUNABLES";
  if (std::getenv(tunables) != nullptr) return;
  std::string choices;
  std::getline(std::ifstream("/sys/kernel/mm/transparent_hugepage/enabled"), choices);
  if (!are_asked_for(choices)) return;
  const std::filesystem::path program = own_program();
  if (program.empty() || setenv(tunables, "glibc.malloc.hugetlb=1", 0) != 0) return;
  execv(program.c_str(), argv);  // an error is no loss but of time
#endif
}

}  // namespace gnomon::app
