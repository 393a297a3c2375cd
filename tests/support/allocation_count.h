// How much the program has asked operator new for so far. Linking support/allocation_count.cpp replaces it.
#pragma once

#include <cstdint>

namespace gnomon::test {

std::uint64_t allocated_bytes();

}  // namespace gnomon::test
