#include "overlap/meeting_nodes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "exact/point_in_triangle.hpp"

namespace satcheck {
namespace {

// The order of two points on a line that is not perpendicular to the axis.
bool comes_before_along(const ExactPoint& p, const ExactPoint& q, int axis) {
  const double gap = q.rounded[axis] - p.rounded[axis];
  if (std::fabs(gap) > 2 * (p.error[axis] + q.error[axis])) return gap > 0;
  return (coordinate(q, axis) * p.w - coordinate(p, axis) * q.w).sign() > 0;
}

}  // namespace

std::uint32_t MeetingNodes::add(const Incidence& at) {
  const std::uint32_t node = number(at);
  if (!of_node_.emplace(node, at).second) return node;
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

void MeetingNodes::sort_edges() {
  for (const int mesh : {0, 1}) {
    const std::vector<Vec3>& vertices = meshes_[mesh]->vertices;
    for (auto& [edge, nodes] : on_edge_[mesh]) {
      if (nodes.size() < 2) continue;
      const Vec3 way = vertices[edge.second] - vertices[edge.first];
      const int axis = projection_axis(way);
      std::sort(nodes.begin(), nodes.end(), [&](std::uint32_t i, std::uint32_t k) {
        return i != k && comes_before_along(at(way[axis] > 0 ? i : k), at(way[axis] > 0 ? k : i), axis);
      });
    }
  }
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

MeshFeature MeetingNodes::feature(int mesh, std::uint32_t node) const {
  const Incidence& at = of_node_.at(node);
  return mesh == 0 ? at.a : at.b;
}

const ExactPoint& MeetingNodes::at(std::uint32_t node) const {
  if (where_.size() < count()) where_.resize(count());
  if (!where_[node]) where_[node] = std::make_unique<const ExactPoint>(locate_node(node));
  return *where_[node];
}

ExactPoint MeetingNodes::locate_node(std::uint32_t node) const {
  const std::size_t of_a = meshes_[0]->vertices.size();
  if (node < first_incidence()) {
    return make_exact_point(node < of_a ? meshes_[0]->vertices[node] : meshes_[1]->vertices[node - of_a]);
  }
  ExactPoint p = locate(incidences_[node - first_incidence()], *meshes_[0], *meshes_[1]);
  // Adds the rounding error, which locate() leaves out.
  return make_exact_point(std::move(p.x), std::move(p.y), std::move(p.z), std::move(p.w));
}

}  // namespace satcheck
