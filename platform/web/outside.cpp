// What lies outside a page: other programs, and the libraries that are opened or linked on Linux alone. Whoever asks is told
// in words what is missing here.
#include <sys/mman.h>

#include <hwy/targets.h>
#include <cerrno>

#include "scene/base/run_apart.h"
#include "scene/base/run_program.h"
#include "scene/base/terminal.h"
#include "scene/files/gltf/gltf_data.h"
#include "scene/files/gltf/gltf_value.h"

/// The files in memory that other programs inherit: there are none.
int memfd_create(const char*, unsigned) {
  errno = ENOSYS;
  return -1;
}

/// What Highway asks of its library: which instruction set runs, of which there is one here.
hwy::ChosenTarget& hwy::GetChosenTarget() {
  static ChosenTarget chosen;
  return chosen;
}

namespace gnomon {
namespace {

tl::unexpected<Error> only_on_linux(const std::string& what) {
  return fail(ErrorKind::bad_input, what + ", which Gnomon does on Linux alone");
}

tl::unexpected<Error> no_program(const std::vector<std::string>& words) {
  return fail(ErrorKind::graphics,
              (words.empty() ? "" : words.front()) + ": a page cannot start other programs");
}

}  // namespace

Expected<int> run_program(std::vector<std::string> words, std::optional<double>, int, const ProgramStart&) {
  return no_program(words);
}
Expected<ApartEnd> run_apart(const ApartProgram& program) {
  return no_program(program.words({}, {}));
}
Expected<ProgramEnd> run_and_listen(std::vector<std::string> words, std::optional<double>,
                                    const std::function<void(std::string_view)>&) {
  return no_program(words);
}
void end_programs() {}

/// Messages leave the module line by line, into a console or a log: a line that is drawn again and again would fill it.
bool is_terminal(int) {
  return false;
}

Expected<void> unpack_draco(GltfDocument& document, GltfData&) {
  for (const JsonValue& mesh : gltf_list(document.json.root, "meshes"))
    for (const JsonValue& primitive : gltf_list(mesh, "primitives"))
      if (member(member(&primitive, "extensions"), "KHR_draco_mesh_compression") != nullptr)
        return only_on_linux("the file's meshes are packed by Draco (KHR_draco_mesh_compression)");
  return {};
}

}  // namespace gnomon
