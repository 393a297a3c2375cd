// Whether the tests are compiled with AddressSanitizer: it has its own operator new, keeps freed memory back, reserves
// terabytes of addresses, and looks for leaks by a process of its own.
#pragma once

namespace gnomon::test {

#ifdef __SANITIZE_ADDRESS__
inline constexpr bool address_sanitizer = true;
#else
inline constexpr bool address_sanitizer = false;
#endif

}  // namespace gnomon::test
