// The words for outcomes in Python.
#pragma once

#include "base/best_first.hpp"
#include "convex/narrow_phase.hpp"
#include "mesh_pair/mesh_pair.hpp"

namespace satcheck {

inline const char* name_of(Outcome outcome) {
  constexpr const char* names[] = {"separated", "touching", "penetrating", "undecided"};
  return names[static_cast<int>(outcome)];
}

inline const char* name_of(Method method) {
  constexpr const char* names[] = {"none", "sat", "gjk", "epa", "exact", "portal"};
  return names[static_cast<int>(method)];
}

inline const char* name_of(Feature feature) {
  constexpr const char* names[] = {"none", "face-a", "face-b", "edge-edge", "vertices", "curved"};
  return names[static_cast<int>(feature)];
}

inline const char* name_of(Relation relation) {
  constexpr const char* names[] = {"separated", "touching", "penetrating", "contains", "inside", "coincident"};
  return names[static_cast<int>(relation)];
}

inline const char* name_of(SearchStop stop) {
  constexpr const char* names[] = {"narrow", "decided", "work spent"};
  return names[static_cast<int>(stop)];
}

}  // namespace satcheck
