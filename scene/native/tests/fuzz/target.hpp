// FUZZ_TARGET(name) { ... } uses the bytes `data`. With SATCHECK_FUZZ it is the entry of libFuzzer, otherwise a unit
// test that runs all seeds, those of the other readers too, and their beginnings.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#if defined(SATCHECK_FUZZ)

#define FUZZ_TARGET(name) \
  static void use(std::string_view data); \
  extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) { \
    use({reinterpret_cast<const char*>(bytes), size}); \
    return 0; \
  } \
  static void use(std::string_view data)

#else

#include "tests/fuzz/seeds.hpp"
#include "tests/check.hpp"

#define FUZZ_TARGET(name) \
  static void use_##name(std::string_view data); \
  UNIT(fuzz_##name) { CHECK(satcheck::scene::run_seeds(use_##name) > 0); } \
  static void use_##name(std::string_view data)

#endif
