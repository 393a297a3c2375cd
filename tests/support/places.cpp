#include "tests/support/places.h"

namespace gnomon::test {

std::string source_dir() {
  return GNOMON_SOURCE_DIR;
}

std::string shared_data() {
  return source_dir() + "/../shared/data";
}

std::string program() {
  return GNOMON_PROGRAM;
}

std::string image_module() {
  return GNOMON_IMAGE_MODULE;
}
std::string fault_injector() {
  return GNOMON_FAULT_INJECTOR;
}

}  // namespace gnomon::test
