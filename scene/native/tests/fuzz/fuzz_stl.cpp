#include "tests/fuzz/invariants.hpp"
#include "tests/fuzz/target.hpp"
#include "readers.hpp"

FUZZ_TARGET(stl) { check(satcheck::scene::read_stl(data)); }
