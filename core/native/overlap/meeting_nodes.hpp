// The vertices of two meshes and the points where their features meet, by number.
#pragma once

#include <map>
#include <memory>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "mesh/incidence.hpp"

namespace satcheck {

// Numbers: the vertices of a, the vertices of b, then the other incidences. Each point has one number: a vertex of b on
// a vertex of a has the number of the latter.
class MeetingNodes {
 public:
  MeetingNodes(const Mesh& a, const Mesh& b) : meshes_{&a, &b} {}

  std::uint32_t add(const Incidence& at);

  std::size_t count() const { return first_incidence() + incidences_.size(); }
  std::uint32_t of_vertex(int mesh, std::uint32_t vertex) const;
  // The nodes inside an edge of one mesh (0: a, 1: b), in no order.
  const std::vector<std::uint32_t>& inside(int mesh, MeshFeature edge) const;
  const ExactPoint& at(std::uint32_t node) const;

 private:
  std::uint32_t first_incidence() const {
    return static_cast<std::uint32_t>(meshes_[0]->vertices.size() + meshes_[1]->vertices.size());
  }
  std::uint32_t number(const Incidence& at);
  ExactPoint locate_node(std::uint32_t node) const;

  const Mesh* meshes_[2];
  std::map<Incidence, std::uint32_t> number_;
  std::vector<Incidence> incidences_;
  std::unordered_set<std::uint32_t> added_;
  std::unordered_map<std::uint32_t, std::uint32_t> same_as_;  // vertices of b that lie on one of a
  std::map<MeshFeature, std::vector<std::uint32_t>> on_edge_[2];
  mutable std::vector<std::unique_ptr<const ExactPoint>> where_;  // by number
};

}  // namespace satcheck
