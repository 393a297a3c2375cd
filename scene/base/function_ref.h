// Somebody else's callable behind two pointers: what is called through it is compiled once, not once per callable.
#pragma once

#include <memory>
#include <utility>

namespace gnomon {

template <class Signature>
class FunctionRef;

/// Refers to the callable, which must outlive it.
template <class Result, class... Arguments>
class FunctionRef<Result(Arguments...)> {
 public:
  template <class Callable>
  FunctionRef(const Callable& callable)
      : callable_(std::addressof(callable)), call_([](const void* self, Arguments... arguments) -> Result {
          return (*static_cast<const Callable*>(self))(std::forward<Arguments>(arguments)...);
        }) {}
  Result operator()(Arguments... arguments) const {
    return call_(callable_, std::forward<Arguments>(arguments)...);
  }

 private:
  const void* callable_;
  Result (*call_)(const void* self, Arguments... arguments);
};

}  // namespace gnomon
