// Decides whether holes leave the relation of two surfaces open. At least one surface is open.
#pragma once

#include <memory>
#include <optional>

#include "mesh/boundary.hpp"
#include "mesh_pair/mesh_pair.hpp"

namespace satcheck {

// Two surfaces, both closed.
class ClosedPair {
 public:
  ClosedPair(const Surface& a, const Surface& b, OpenParts open, Budget* budget);

  const Surface& a() const { return of_a_ ? *of_a_->surface : a_; }
  const Surface& b() const { return of_b_ ? *of_b_->surface : b_; }
  // Null if the surface itself is closed.
  const Closing* closing_a() const { return of_a_.get(); }
  const Closing* closing_b() const { return of_b_.get(); }

 private:
  const Surface &a_, &b_;
  std::shared_ptr<const Closing> of_a_, of_b_;
};

// in_the_way: the hull of a hole meets more of the other body than its boundary, so some fills overlap the body and
// others do not. touched: there is no such hole, but the hull of one touches the other body.
struct Holes {
  std::optional<OpenHole> in_the_way, touched;
};

Holes holes_between(const ClosedPair& pair, Budget* budget = nullptr);

// The distance of the hulls of holes from the other surface and its hulls; empty if it is not less than `limit`.
std::optional<double> distance_of_holes(const Surface& a, const Surface& b, double limit, Budget* budget = nullptr);

}  // namespace satcheck
