// Loaded before the program (LD_PRELOAD): from the GNOMON_TEST_NO_THREAD_FROM'th on, no thread is started.
#include <dlfcn.h>
#include <pthread.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>

namespace {

std::atomic<long> asked{0};

}  // namespace

extern "C" int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*run)(void*),
                              void* argument) noexcept {
  using Create = int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
  static const auto create = reinterpret_cast<Create>(dlsym(RTLD_NEXT, "pthread_create"));
  const char* from = std::getenv("GNOMON_TEST_NO_THREAD_FROM");
  if (from != nullptr && ++asked >= std::atol(from)) return EAGAIN;
  return create(thread, attributes, run, argument);
}
