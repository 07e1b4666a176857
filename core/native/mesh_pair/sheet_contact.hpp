// Do two surfaces without inside cross where no two of their triangles do?
#pragma once

#include <optional>
#include <vector>

#include "mesh_pair/contact.hpp"
#include "mesh_pair/pair_facts.hpp"

namespace satcheck {

struct ContactVerdict {
  std::optional<Evidence> crossing;
  bool proven = true;
};

// A crossing through edges: along a shared segment each surface has points strictly on both sides of
// the other. Proven when true; when there is none, `proven` tells that no coplanar patch hides one.
ContactVerdict judge_sheet_contact(const Surface& a, const Surface& b,
                                   const std::vector<ContactPair>& contacts);

}  // namespace satcheck
