#include "tests/fuzz/invariants.hpp"
#include "tests/fuzz/target.hpp"
#include "readers.hpp"

using namespace satcheck::scene;

FUZZ_TARGET(off) {
  check(read_off(data));
}
