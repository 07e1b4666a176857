// The triangles that two surfaces have in common: those with the same three corners.
//
// Where no other triangle meets two of them that share an edge, nothing else is near a generic point of that edge. The
// winding numbers beside both are therefore the same, and one sample shows those of a whole region of flush faces.
#pragma once

#include <optional>
#include <vector>

#include "mesh/self_contact.hpp"
#include "mesh/surface.hpp"
#include "mesh_pair/contact.hpp"

namespace satcheck {

class CommonTriangles {
 public:
  CommonTriangles(const Surface& a, const Surface& b, Budget* budget);

  std::size_t count() const { return count_; }

  // Notes a triangle of A and one of B whose boxes meet. True: what they share follows from the common triangles.
  // Consecutive calls for one triangle of A are fast.
  bool note(std::uint32_t ta, std::uint32_t tb);

  // After note() of all pairs of triangles whose boxes meet: common triangles that no other triangle of their surfaces
  // meets but at shared corners and edges, in regions with the same winding numbers; and the other common triangles.
  std::vector<std::vector<ContactPair>> regions() const;
  std::vector<ContactPair> irregular() const;

 private:
  static constexpr std::uint32_t kSeveral = kNoIndex - 1;

  void note_neighbour(std::uint32_t t, const Corners& other, std::uint32_t number);

  const Surface &a_, &b_;
  Budget* budget_;
  std::size_t count_ = 0;
  std::vector<std::uint32_t> of_a_, of_b_;  // of each triangle of A that of B, and the other way round, or kNoIndex
  std::vector<std::uint32_t> across_;       // each edge of A's triangles: the common triangle there, of A
  std::vector<bool> irregular_;             // by triangle of A
  std::optional<MeshTriangle> compared_;    // ta, or its copy in B
  std::uint32_t last_ = kNoIndex;              // the ta of compared_
};

}  // namespace satcheck
