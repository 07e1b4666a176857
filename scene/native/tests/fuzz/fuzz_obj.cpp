#include "tests/fuzz/invariants.hpp"
#include "tests/fuzz/target.hpp"
#include "readers.hpp"

using namespace satcheck::scene;

FUZZ_TARGET(obj) {
  const ReadOutcome outcome = read_obj(data);
  check(outcome);
  const MeshData* whole = std::get_if<MeshData>(&outcome);
  if (whole == nullptr) return;
  std::size_t corners = 0;
  const auto objects = split_objects(*whole);
  for (const Object& object : objects) {
    check(object.mesh);
    corners += object.mesh.triangles.size();
  }
  require(objects.empty() || corners == whole->triangles.size());
}
