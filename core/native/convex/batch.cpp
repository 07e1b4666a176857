#include "convex/batch.hpp"

#include <algorithm>
#include <stdexcept>

#include "base/parallel.hpp"
#include "convex/polygon_pair.hpp"

namespace satcheck {

PairResults check_pairs(std::size_t count, const std::function<PairRequest(std::size_t)>& request, Query query,
                        MethodChoice method, unsigned threads) {
  PairResults results(count, query != Query::overlap);
  // With blocks of this size the shared counter costs nothing, and they are small enough for an even load.
  parallel_for(count, threads, [&](std::size_t i) {
    const PairRequest r = request(i);
    results.set(i, check_pair(*r.a, r.pose_a, *r.b, r.pose_b, query, method));
  }, kRowsOfALine);
  return results;
}

PairResults check_polygons(const ConvexPolygons& polygons, std::span<const std::uint32_t> index_a,
                           std::span<const std::uint32_t> index_b, Query query, unsigned threads) {
  const auto exists = [&](std::uint32_t k) { return k < polygons.size(); };
  if (!std::ranges::all_of(index_a, exists) || !std::ranges::all_of(index_b, exists)) {
    throw std::invalid_argument("a polygon index is out of range");
  }
  PairResults results(index_a.size(), query != Query::overlap);
  parallel_for(index_a.size(), threads, [&](std::size_t i) {
    results.set(i, check_polygons(polygons[index_a[i]], polygons[index_b[i]], query));
  }, kRowsOfALine);
  return results;
}

}  // namespace satcheck
