// The smallest test harness that serves: CHECK counts and prints failures, the process exit status
// is the verdict.
#pragma once

#include <cstdio>

namespace satcheck::testing {

inline int failures = 0;
inline int checks = 0;

inline bool check(bool passed, const char* expression, const char* file, int line) {
  ++checks;
  if (!passed) {
    ++failures;
    std::fprintf(stderr, "%s:%d: failed: %s\n", file, line, expression);
  }
  return passed;
}

inline int exit_status() {
  std::printf("%d checks, %d failures\n", checks, failures);
  return failures == 0 && checks > 0 ? 0 : 1;
}

}  // namespace satcheck::testing

#define CHECK(expression) \
  ::satcheck::testing::check(static_cast<bool>(expression), #expression, __FILE__, __LINE__)
