#include "scene/files/own_program.h"

#include <system_error>

#include "scene/files/path_status.h"

namespace gnomon {

std::filesystem::path own_program() {
  std::error_code none;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", none);
  return none ? std::filesystem::path() : program;
}

std::string program_beside(std::string_view name) {
  std::error_code none;
  const std::filesystem::path own = own_program();
  const std::filesystem::path built = std::filesystem::weakly_canonical(GNOMON_PROGRAMS_BUILT, none);
  const std::string beside = (own.parent_path() / name).string();
  const bool is_of_the_build = own.string().starts_with(built.parent_path().string() + "/");
  return is_of_the_build && file_kind_or_none(beside) != FileKind::file ? (built / name).string() : beside;
}

}  // namespace gnomon
