// Where a test finds what it reads and runs. The paths are compiled into places.cpp alone, so that every
// other object file is the same in each checkout and a compiler cache can share it.
#pragma once

#include <string>

namespace gnomon::test {

/// The root of the sources.
std::string source_dir();
/// The real models that tests may use (tests/support/model_files.h); the folder may be absent.
std::string shared_data();
/// The built program, and the module with which it reads images.
std::string program();
std::string image_module();
/// The library that makes calls of the C library fail (tests/faults/injector.cpp).
std::string fault_injector();

/// Whether the tests are compiled with AddressSanitizer: it has its own operator new, keeps freed memory back, reserves
/// terabytes of addresses, and looks for leaks by a process of its own.
#ifdef __SANITIZE_ADDRESS__
inline constexpr bool address_sanitizer = true;
#else
inline constexpr bool address_sanitizer = false;
#endif

}  // namespace gnomon::test
