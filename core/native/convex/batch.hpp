// Many convex pairs at once, on all cores.
#pragma once

#include <cstddef>
#include <functional>
#include <span>

#include "convex/convex_polygon.hpp"
#include "convex/pair_results.hpp"

namespace satcheck {

struct PairRequest {
  const Shape* a;
  const Shape* b;
  Pose pose_a, pose_b;
};

// check_pair() on request(0), ..., request(count - 1). request(i) is called once, by the thread that needs it. If some
// throw, the exception of the first one is rethrown.
PairResults check_pairs(std::size_t count, const std::function<PairRequest(std::size_t)>& request, Query query,
                        MethodChoice method, unsigned threads);

// check_polygons() on polygons[index_a[i]] and polygons[index_b[i]] for all i. The indices have one length;
// std::invalid_argument for one out of range.
PairResults check_polygons(const ConvexPolygons& polygons, std::span<const std::uint32_t> index_a,
                           std::span<const std::uint32_t> index_b, Query query, unsigned threads);

}  // namespace satcheck
