// Every index once, on however many threads there are.
#include "base/parallel.hpp"

#include <atomic>
#include <cstddef>
#include <vector>

#include "tests/check.hpp"

#if defined(__GLIBC__)
#include <pthread.h>
#endif

using namespace satcheck;

namespace {

void check_each_once(std::size_t count, unsigned threads, std::size_t chunk) {
  std::vector<std::atomic<int>> calls(count);
  parallel_for(count, threads, [&](std::size_t i) { ++calls[i]; }, chunk);
  bool once = true;
  for (const auto& n : calls) once = once && n == 1;
  CHECK(once);
}

#if defined(__GLIBC__)
// Stacks larger than any address space: no thread can be started.
void test_a_system_that_grants_no_threads() {
  pthread_attr_t usual, impossible;
  pthread_getattr_default_np(&usual);
  pthread_attr_init(&impossible);
  pthread_attr_setstacksize(&impossible, std::size_t{1} << 60);
  CHECK(pthread_setattr_default_np(&impossible) == 0);
  pthread_t thread;
  CHECK(pthread_create(&thread, nullptr, [](void*) -> void* { return nullptr; }, nullptr) != 0);
  check_each_once(1000, 8, 3);
  pthread_setattr_default_np(&usual);
}
#endif

}  // namespace

UNIT(parallel) {
  for (const std::size_t count : {0u, 1u, 63u, 64u, 65u, 1000u}) {
    for (const unsigned threads : {0u, 1u, 2u, 7u}) {
      check_each_once(count, threads, 1);
      check_each_once(count, threads, 64);
    }
  }
#if defined(__GLIBC__)
  test_a_system_that_grants_no_threads();
#endif
}
