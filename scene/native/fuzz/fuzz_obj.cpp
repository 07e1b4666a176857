#include "fuzz/invariants.hpp"
#include "fuzz/target.hpp"
#include "readers.hpp"

using namespace satcheck::scene;

FUZZ_TARGET(obj) {
  check(read_obj(data));
}
