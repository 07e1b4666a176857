// Sorts the pairs of many poses: those that are proven apart, those that are proven to overlap deeply, those that the
// fill of a hole decides, and the others, which climb the ladder. No body is placed: directions, or the other body, are
// taken into its frame.
//
// Every proof holds for the vertices in the world after each coordinate is rounded once, because it exceeds a bound of
// all rounding (kPosedRounding).
#pragma once

#include <cstdint>
#include <vector>

#include "base/budget.hpp"
#include "mesh_pair/mesh_pair.hpp"
#include "motion/posed_body.hpp"

namespace satcheck {

enum class Sifted : std::uint8_t {
  open,       // none of these is proven
  apart,      // by more than the gap limit of the pair
  deep,       // a point lies deeper in both bodies than `depth`, or no translation up to `crossing` ends the overlap;
              // not looked for if `depth` is infinite
  undecided,  // the surfaces are apart, and whether the bodies overlap depends on the fill of a hole
};

// One pair of bodies in all poses.
struct SiftedPair {
  std::uint32_t a, b;
  double gap_limit, depth, crossing;
};

// matrices: of each body in each pose, pose by pose, three rows of four numbers each. margins: for each pair in each
// pose, added to its gap limit; NaN: the pair is left open there. Null: no margins. Returns a value for each pair in
// each pose, pose by pose, the same for any number of threads (0: one a core). budget: shared evenly by blocks of poses;
// pairs of a block that has spent its share are left open. Null: without an end.
std::vector<Sifted> sift(const std::vector<PosedBody*>& bodies, const std::vector<SiftedPair>& pairs,
                         const double* matrices, const double* margins, std::size_t poses, unsigned threads,
                         Budget* budget = nullptr);

// A pair that is deep in one of the poses.
struct DeepPair {
  std::uint32_t pose, a, b;
  double margin;
};

// Whether each body of a pair reaches out of the other one by more than the margin.
std::vector<bool> neither_holds(const std::vector<PosedBody*>& bodies, const std::vector<DeepPair>& pairs,
                                const double* matrices);

}  // namespace satcheck
