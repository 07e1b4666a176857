// A small test harness: UNIT registers a test by its name, CHECK counts and prints failures.
#pragma once

#include <cstdio>

namespace satcheck::testing {

#if defined(__SANITIZE_ADDRESS__)
constexpr bool kSanitized = true;
#elif defined(__has_feature)
constexpr bool kSanitized = __has_feature(address_sanitizer);
#else
constexpr bool kSanitized = false;
#endif

// Rounds of a random test, and what they must meet. Sanitizers watch each read and overflow, for which a
// quarter is enough: the build without them judges the figures of all rounds.
constexpr int rounds(int all) { return kSanitized ? (all + 3) / 4 : all; }

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

struct Unit {
  const char* name;
  void (*run)();
  Unit* next;
};
inline Unit* units = nullptr;

// Puts a static unit into the list, which needs no order of initialization.
inline bool register_unit(Unit& unit) {
  unit.next = units;
  units = &unit;
  return true;
}

}  // namespace satcheck::testing

#define CHECK(expression) \
  ::satcheck::testing::check(static_cast<bool>(expression), #expression, __FILE__, __LINE__)

#define UNIT(name)                                                                                             \
  static void run_##name();                                                                                    \
  static ::satcheck::testing::Unit unit_##name{#name, run_##name, nullptr};                                    \
  [[maybe_unused]] static const bool registered_##name = ::satcheck::testing::register_unit(unit_##name);      \
  static void run_##name()
