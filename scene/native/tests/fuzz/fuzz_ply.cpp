#include "tests/fuzz/invariants.hpp"
#include "tests/fuzz/target.hpp"
#include "readers.hpp"

using namespace satcheck::scene;

FUZZ_TARGET(ply) {
  check(read_ply(data));
}
