// Loaded before the program (LD_PRELOAD): the GNOMON_TEST_FAULT_AT'th allocation outside the main thread throws.
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <new>
#include <stdexcept>

namespace {

std::atomic<long> allocations{0};

long fault_at() {
  static const long at = [] {
    const char* text = std::getenv("GNOMON_TEST_FAULT_AT");
    return text == nullptr ? -1L : std::atol(text);
  }();
  return at;
}

}  // namespace

void* operator new(std::size_t size) {
  if (::gettid() != ::getpid() && ++allocations == fault_at()) throw std::runtime_error("injected");
  if (void* p = std::malloc(size == 0 ? 1 : size)) return p;
  throw std::bad_alloc();
}
void operator delete(void* p) noexcept {
  std::free(p);
}
void operator delete(void* p, std::size_t) noexcept {
  std::free(p);
}
