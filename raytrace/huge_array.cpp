#include "raytrace/huge_array.h"

#include <cstdint>
#include <cstdlib>
#include <mutex>
#include <unordered_map>

#include "raytrace/kept_arrays.h"

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace gnomon::raytrace {
namespace {

constexpr std::size_t page = std::size_t{1} << 21;

/// Blocks of whole large pages: in use, and those to be used again, oldest first.
class Pages {
 public:
  static Pages& instance() {
    static Pages* pages = new Pages;  // never destroyed: arrays may outlive it
    return *pages;
  }

  void* take(std::size_t size) {
    const std::lock_guard lock(mutex_);
    if (void* kept = take_kept(size)) return kept;
    void* data = std::aligned_alloc(page, size);
    if (data == nullptr) throw std::bad_alloc();
#if defined(__linux__)
    madvise(data, size, MADV_HUGEPAGE);  // advice: nothing is lost without
#endif
    used_[data] = size;
    return data;
  }

  /// False when it is none of these.
  bool give(void* data) {
    const std::lock_guard lock(mutex_);
    const auto block = used_.find(data);
    if (block == used_.end()) return false;
    kept_.push_back({data, block->second}), kept_bytes_ += block->second;
    used_.erase(block);
    keep_at_most(most_kept_bytes);
    return true;
  }

  void return_kept() {
    const std::lock_guard lock(mutex_);
    keep_at_most(0);
  }

 private:
  struct Block {
    void* data;
    std::size_t size;
  };

  void keep_at_most(std::size_t bytes) {
    while (kept_bytes_ > bytes) {
      kept_bytes_ -= kept_.front().size;
      std::free(kept_.front().data);
      kept_.erase(kept_.begin());
    }
  }

  // The smallest that holds it, unless half of it were idle.
  void* take_kept(std::size_t size) {
    auto best = kept_.end();
    for (auto block = kept_.begin(); block != kept_.end(); ++block)
      if (block->size >= size && block->size / 2 <= size && (best == kept_.end() || block->size < best->size))
        best = block;
    if (best == kept_.end()) return nullptr;
    void* data = best->data;
    used_[data] = best->size, kept_bytes_ -= best->size;
    kept_.erase(best);
    return data;
  }

  std::mutex mutex_;
  std::unordered_map<void*, std::size_t> used_;
  std::vector<Block> kept_;
  std::size_t kept_bytes_ = 0;
};

}  // namespace

void return_kept_arrays() {
  Pages::instance().return_kept();
}

void* allocate_huge(std::size_t bytes) {
  if (bytes >= 2 * page) return Pages::instance().take((bytes + page - 1) / page * page);
  constexpr std::size_t line = 64;
  void* data = std::aligned_alloc(line, (bytes + line - 1) / line * line);
  if (data == nullptr) throw std::bad_alloc();
  return data;
}

void free_huge(void* data) {
  const bool whole_pages = reinterpret_cast<std::uintptr_t>(data) % page == 0;
  if (!whole_pages || !Pages::instance().give(data)) std::free(data);
}

}  // namespace gnomon::raytrace
