// Arrays that start without values, in large pages where the system has them: what is read here and there would
// otherwise spend its time in missing page tables.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>
#include <vector>

namespace gnomon::raytrace {

/// Memory for `bytes`, aligned to cache lines, in large pages when there are many.
void* allocate_huge(std::size_t bytes);
void free_huge(void* data);

template <class T>
class HugeArray {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

 public:
  HugeArray() = default;
  explicit HugeArray(std::size_t count) : size_(count) {
    if (count > 0) data_.reset(static_cast<T*>(allocate_huge(count * sizeof(T))));
  }
  T& operator[](std::size_t i) { return data_.get()[i]; }
  const T& operator[](std::size_t i) const { return data_.get()[i]; }
  T* data() { return data_.get(); }
  const T* data() const { return data_.get(); }
  std::size_t size() const { return size_; }
  std::size_t bytes() const { return size_ * sizeof(T); }

 private:
  struct Free {
    void operator()(T* p) const { free_huge(p); }
  };
  std::unique_ptr<T, Free> data_;
  std::size_t size_ = 0;
};

/// For vectors alike: resize() leaves new elements without values.
template <class T>
struct HugeAllocator {
  using value_type = T;
  HugeAllocator() = default;
  template <class U>
  explicit HugeAllocator(const HugeAllocator<U>&) {}
  T* allocate(std::size_t count) { return static_cast<T*>(allocate_huge(count * sizeof(T))); }
  void deallocate(T* p, std::size_t) { free_huge(p); }
  template <class U>
  void construct(U* p) {
    ::new (static_cast<void*>(p)) U;
  }
  template <class U, class... Values>
  void construct(U* p, Values&&... values) {
    ::new (static_cast<void*>(p)) U(std::forward<Values>(values)...);
  }
  bool operator==(const HugeAllocator&) const { return true; }
};
template <class T>
using HugeVector = std::vector<T, HugeAllocator<T>>;

}  // namespace gnomon::raytrace
