#include <pthread.h>
#include <sys/resource.h>

#include <algorithm>
#include <thread>

#include "app/process/machine.h"

namespace gnomon::app {

int with_enough_stack(int (*run)(int, char**), int argc, char** argv) {
  constexpr rlim_t enough = rlim_t{8} << 20;  // what Linux gives where nobody has set it
  rlimit limit{};
  if (getrlimit(RLIMIT_STACK, &limit) != 0 || limit.rlim_cur >= enough) return run(argc, argv);
  limit.rlim_cur = std::min(limit.rlim_max, enough);
  setrlimit(RLIMIT_STACK, &limit);  // for programs that are started
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, enough);
  pthread_setattr_default_np(&attributes);
  pthread_attr_destroy(&attributes);
  int code = 0;
  std::thread([&] { code = run(argc, argv); }).join();
  return code;
}

}  // namespace gnomon::app
