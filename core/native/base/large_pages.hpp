// Room for large arrays in large pages, where the system has them: what is written for the first time costs a page
// fault for each of 2 MiB instead of each of 4 KiB, and what is read in no order is found through shorter tables.
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

// Of memory that is not yet written. A wish: nothing but time depends on what becomes of it, here or beside it.
inline void prefer_large_pages([[maybe_unused]] void* start, [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__) && defined(MADV_HUGEPAGE)
  constexpr std::size_t kWorthACall = 1 << 21, kPage = 1 << 12;
  if (bytes < kWorthACall) return;
  // Pages that are shared with a neighbour included: one without the wish would keep a large page from spanning both.
  const auto first = reinterpret_cast<std::uintptr_t>(start) & ~(kPage - 1);
  const auto last = (reinterpret_cast<std::uintptr_t>(start) + bytes + kPage - 1) & ~(kPage - 1);
  madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);
#endif
}

// For a process that answers one question and ends: what is freed is kept for what comes next, instead of being handed
// back and fetched again, page by page. glibc alone; it changes nothing but time.
inline void keep_freed_memory() {
#if defined(__GLIBC__)
  mallopt(M_MMAP_THRESHOLD, 1 << 25);  // the most that it takes
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
#endif
}

// Empty, with room for so many.
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

// So many values of zero bits, which fresh memory is without being written.
template <class T>
std::unique_ptr<T[], Free> zeroed(std::size_t count) {
  std::unique_ptr<T[], Free> array(static_cast<T*>(std::calloc(count, sizeof(T))));
  if (array == nullptr) throw std::bad_alloc();
  prefer_large_pages(array.get(), count * sizeof(T));
  return array;
}

// So many values of nothing yet.
template <class T>
std::unique_ptr<T[]> unwritten(std::size_t count) {
  auto array = std::make_unique_for_overwrite<T[]>(count);
  prefer_large_pages(array.get(), count * sizeof(T));
  return array;
}

}  // namespace satcheck
