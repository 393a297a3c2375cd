// What becomes of the program when an allocation fails where no exception can pass. That is in a destructor, in a function of a
// library that promises not to throw, or while static objects are made, before main() begins. Such an allocation ends the process
// with ErrorKind::graphics and one line, instead of an abort. Everywhere else std::bad_alloc reaches run_command_line().
#include <exception>
#include <new>

#include "app/process/interrupt.h"
#include "scene/base/expected.h"

namespace gnomon::app {
namespace {

std::terminate_handler handler_before = nullptr;

bool is_out_of_memory() {
  try {
    if (const std::exception_ptr thrown = std::current_exception()) std::rethrow_exception(thrown);
  } catch (const std::bad_alloc&) {
    return true;
  } catch (...) {  // another error's end is another's
  }
  return false;
}

[[gnu::constructor(101)]] void begin_before_static_objects() {
  handler_before = std::set_terminate([] {
    if (is_out_of_memory()) end_process(static_cast<int>(ErrorKind::graphics), "out of memory");
    handler_before();
  });
}

}  // namespace
}  // namespace gnomon::app
