// The program's own pthread_create() takes the place of the C library's for every library that is loaded, and calls it.
#include "app/process/machine.h"

#include <dlfcn.h>
#include <pthread.h>

#include <exception>
#include <string_view>

#include "app/process/interrupt.h"
#include "scene/base/expected.h"
#include "scene/base/threads.h"

namespace gnomon::app {
namespace {

using Create = int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);

[[noreturn]] void end_without_threads() {
  end_process(static_cast<int>(ErrorKind::graphics),
              "a library cannot start a thread that it needs (a limit on processes, ulimit -u)");
}

/// std::thread throws: libraries do not expect it while they are loaded, and some wait for the thread nevertheless. oneTBB
/// throws, too, but in the program's own loops, and a graphics driver goes on without.
bool is_standard_library(const void* caller) {
  Dl_info object{};
  return dladdr(caller, &object) != 0 && object.dli_fname != nullptr &&
         std::string_view(object.dli_fname).find("libstdc++") != std::string_view::npos;
}

}  // namespace

void end_in_words_without_threads() {
  static std::terminate_handler before = nullptr;
  before = std::set_terminate([] {
    if (refused_threads() > 0) end_without_threads();
    before();
  });
}

}  // namespace gnomon::app

extern "C" __attribute__((visibility("default"))) int pthread_create(pthread_t* thread,
                                                                     const pthread_attr_t* attributes,
                                                                     void* (*run)(void*),
                                                                     void* argument) noexcept {
  static const auto create = reinterpret_cast<gnomon::app::Create>(dlsym(RTLD_NEXT, "pthread_create"));
  const int error = create(thread, attributes, run, argument);
  if (error == 0 || gnomon::RefusalIsHandled::here()) return error;
  gnomon::count_refused_thread();
  if (gnomon::app::is_standard_library(__builtin_return_address(0))) gnomon::app::end_without_threads();
  return error;
}
