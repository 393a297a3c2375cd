// OBJ files without their material libraries.
#include "fuzz_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  gnomon::fuzz::load_as(".obj", data, size);
  return 0;
}

std::vector<std::string> gnomon::fuzz::seeds() {
  return {
      "v 0 0 0\nv 1 0 0 1 0.5 -2\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\n"
      "f 1/1/1 2/2/1 3/3/1\nf -4//1 -2//1 -1//1\n",
      "mtllib missing.mtl\no box\ng side\nusemtl red\ns 1\nv 0 0 0 1\nv 2 0 0\nv 2 2 0\nv 1 3 0\nv 0 2 0\n"
      "f 1 2 3 4 5\n",
      "# a comment\r\nv 1e-3 -2.5E+2 .5\r\nv 1. 0 0\r\nv 0 1 0\r\nf 1 2 3 \\\r\n\r\n"};
}
