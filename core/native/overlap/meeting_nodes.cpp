#include "overlap/meeting_nodes.hpp"

namespace satcheck {

std::uint32_t MeetingNodes::add(const Incidence& at) {
  const std::uint32_t node = number(at);
  if (!added_.insert(node).second) return node;
  if (at.a.is_edge()) on_edge_[0][at.a].push_back(node);
  if (at.b.is_edge()) on_edge_[1][at.b].push_back(node);
  return node;
}

std::uint32_t MeetingNodes::number(const Incidence& at) {
  if (at.a.is_vertex()) {
    if (at.b.is_vertex()) same_as_[at.b.first] = at.a.first;
    return at.a.first;
  }
  if (at.b.is_vertex()) return static_cast<std::uint32_t>(meshes_[0]->vertices.size()) + at.b.first;
  const auto [known, is_new] = number_.emplace(at, static_cast<std::uint32_t>(count()));
  if (is_new) incidences_.push_back(at);
  return known->second;
}

std::uint32_t MeetingNodes::of_vertex(int mesh, std::uint32_t vertex) const {
  if (mesh == 0) return vertex;
  const auto same = same_as_.find(vertex);
  return same != same_as_.end() ? same->second : static_cast<std::uint32_t>(meshes_[0]->vertices.size()) + vertex;
}

const std::vector<std::uint32_t>& MeetingNodes::inside(int mesh, MeshFeature edge) const {
  static const std::vector<std::uint32_t> none;
  const auto nodes = on_edge_[mesh].find(edge);
  return nodes == on_edge_[mesh].end() ? none : nodes->second;
}

const ExactPoint& MeetingNodes::at(std::uint32_t node) const {
  if (where_.size() < count()) where_.resize(count());
  if (!where_[node]) where_[node] = std::make_unique<const ExactPoint>(locate_node(node));
  return *where_[node];
}

ExactPoint MeetingNodes::locate_node(std::uint32_t node) const {
  const std::size_t of_a = meshes_[0]->vertices.size();
  if (node < of_a) return make_exact_point(meshes_[0]->vertices[node]);
  if (node < first_incidence()) return make_exact_point(meshes_[1]->vertices[node - of_a]);
  return place_of(incidences_[node - first_incidence()], *meshes_[0], *meshes_[1]);
}

}  // namespace satcheck
