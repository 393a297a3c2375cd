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
  const std::string beside = (own_program().parent_path() / name).string();
  return file_kind_or_none(beside) == FileKind::file
             ? beside
             : (std::filesystem::path(GNOMON_PROGRAMS_BUILT) / name).string();
}

}  // namespace gnomon
