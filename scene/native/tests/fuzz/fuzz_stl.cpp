// STL from memory and, if it is binary, in pieces: both ways must agree.
#include <algorithm>

#include "tests/fuzz/invariants.hpp"
#include "tests/fuzz/target.hpp"
#include "readers.hpp"

namespace {

using namespace satcheck::scene;

ReadOutcome read_in_pieces(std::string_view bytes) {
  return read_binary_stl(bytes.size(), [&](std::span<char> room) {
    const std::size_t count = std::min(room.size(), bytes.size());
    std::copy_n(bytes.begin(), count, room.begin());
    bytes.remove_prefix(count);
    return count;
  });
}

bool is_binary(const ReadOutcome& whole) {
  const MeshData* mesh = std::get_if<MeshData>(&whole);
  return mesh != nullptr && mesh->number_format == NumberFormat::float32;
}

}  // namespace

FUZZ_TARGET(stl) {
  const ReadOutcome whole = read_stl(data), pieces = read_in_pieces(data);
  check(whole);
  check(pieces);
  const MeshData* mesh = std::get_if<MeshData>(&pieces);
  require(is_binary(whole) == (mesh != nullptr));
  if (mesh == nullptr) return;
  require(mesh->vertices == std::get<MeshData>(whole).vertices && mesh->triangles == std::get<MeshData>(whole).triangles);
}
