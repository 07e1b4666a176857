// The triangles of a surface that do not meet the other one.
#pragma once

#include <vector>

#include "mesh_pair/samples.hpp"

namespace satcheck {

// Regions of triangles without contact, connected through common corners. Each region is completely inside or outside
// of the other solid.
class FreeRegions {
 public:
  // in_contact: by triangle of side.self; empty when there is no contact at all.
  FreeRegions(const Side& side, std::vector<bool> in_contact);

  // Whether any region is inside the other solid.
  bool any_inside() const;

  // Notes the facts of one sample for each region. For a clean surface these are all facts.
  void sample_first(Samples& samples) const;
  // Notes the remaining facts.
  void sample_rest(Samples& samples) const;

 private:
  struct Region {
    std::uint32_t triangle;
    int theirs;  // winding number of the other solid
  };

  bool is_free(std::uint32_t t) const { return in_contact_.empty() || !in_contact_[t]; }
  void add(std::uint32_t triangle);
  // False: the winding number of its own surface is not decided.
  bool sample_centre(std::uint32_t t, int theirs, Samples& samples) const;
  void sample_every_piece(Samples& samples) const;

  Side side_;
  std::vector<bool> in_contact_;
  std::vector<Region> regions_;
  bool known_ = true;  // every winding number was decided
};

}  // namespace satcheck
