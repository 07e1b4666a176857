// Memory for large arrays in large pages, if the system has them. The first write then costs one page fault for 2 MiB
// instead of one for 4 KiB, and random reads need smaller page tables.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <memory>
#include <new>
#include <vector>

#if defined(__linux__)
#include <malloc.h>
#include <sys/mman.h>
#endif

namespace satcheck {

// A hint for memory that is not written yet. It affects only time.
inline void prefer_large_pages([[maybe_unused]] void* start, [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__) && defined(MADV_HUGEPAGE)
  constexpr std::size_t kWorthACall = 1 << 21, kPage = 1 << 12;
  if (bytes < kWorthACall) return;
  // Includes pages shared with neighbours. A page without the hint would prevent a large page across the border.
  const auto first = reinterpret_cast<std::uintptr_t>(start) & ~(kPage - 1);
  const auto last = (reinterpret_cast<std::uintptr_t>(start) + bytes + kPage - 1) & ~(kPage - 1);
  madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);
#endif
}

// For a process that answers one query and ends: keeps freed memory for later allocations instead of returning it to
// the system. Only with glibc; it affects only time.
inline void keep_freed_memory() {
#if defined(__GLIBC__)
  mallopt(M_MMAP_THRESHOLD, 1 << 25);  // the largest value that is allowed
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
#endif
}

// An empty vector with capacity for `count` values.
template <class T>
std::vector<T> with_room(std::size_t count) {
  std::vector<T> room;
  room.reserve(count);
  prefer_large_pages(room.data(), count * sizeof(T));
  return room;
}

struct Free {
  void operator()(void* memory) const { std::free(memory); }
};

// `count` values of zero bits. Fresh memory is zero without being written.
template <class T>
std::unique_ptr<T[], Free> zeroed(std::size_t count) {
  std::unique_ptr<T[], Free> array(static_cast<T*>(std::calloc(count, sizeof(T))));
  if (array == nullptr) throw std::bad_alloc();
  prefer_large_pages(array.get(), count * sizeof(T));
  return array;
}

// `count` values that are not initialized.
template <class T>
std::unique_ptr<T[]> unwritten(std::size_t count) {
  auto array = std::make_unique_for_overwrite<T[]>(count);
  prefer_large_pages(array.get(), count * sizeof(T));
  return array;
}

}  // namespace satcheck
