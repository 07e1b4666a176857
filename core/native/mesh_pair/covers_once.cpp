#include "mesh_pair/covers_once.hpp"

#include "mesh/self_contact.hpp"
#include "mesh_pair/samples.hpp"

namespace satcheck {
namespace {

// Whether a condition holds beside every piece. False if a sample gives no answer.
template <class Holds>
bool holds_beside_all(const Surface& solid, Holds holds) {
  bool all_hold = true;
  const auto all = [](std::uint32_t) { return true; };
  visit_uniform_pieces(solid, all, [&](std::uint32_t t, const Piece& piece, std::size_t others) {
    const bool known = sample_piece(piece, others, [&](const ExactPoint& p) {
      const auto sides = beside(solid, p, corners(solid.mesh, t));
      all_hold = all_hold && (!sides || holds(*sides));
      return sides.has_value();
    });
    all_hold = all_hold && known;
    return all_hold;
  });
  return all_hold;
}

}  // namespace

bool covers_once(const Surface& solid) {
  const auto at_most_once = [](int winding) { return winding == 0 || winding == 1; };
  return holds_beside_all(solid, [&](const Beside& b) { return at_most_once(b.front) && at_most_once(b.back); });
}

bool has_sheets(const Surface& solid) {
  return !holds_beside_all(solid, [](const Beside& b) { return !b.is_sheet(); });
}

}  // namespace satcheck
