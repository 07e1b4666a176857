#include "mesh_pair/covers_once.hpp"

#include "mesh/self_contact.hpp"
#include "mesh_pair/samples.hpp"

namespace satcheck {

bool covers_once(const Surface& solid) {
  bool once = true;
  const auto at_most_once = [](int winding) { return winding == 0 || winding == 1; };
  const auto all = [](std::uint32_t) { return true; };
  visit_uniform_pieces(solid, all, [&](std::uint32_t t, const Piece& piece, std::size_t others) {
    const bool known = sample_piece(piece, others, [&](const ExactPoint& p) {
      const auto sides = beside(solid, p, corners(solid.mesh, t));
      once = once && (!sides || (at_most_once(sides->front) && at_most_once(sides->back)));
      return sides.has_value();
    });
    once = once && known;
    return once;
  });
  return once;
}

}  // namespace satcheck
