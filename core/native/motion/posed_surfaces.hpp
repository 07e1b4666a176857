// Two surfaces in one pose, compared in the file frame of A. No vertex is placed in the world.
#pragma once

#include <optional>

#include "base/budget.hpp"
#include "motion/posed_body.hpp"

namespace satcheck {

enum class Meeting : std::uint8_t { unclear, apart, deep, by_fill };

// The middle of the segment that two triangles have in common, rounded, and the way from there into both bodies, as long
// as the segment. World units.
struct CommonSegment {
  Vec3 middle, inward;
};

struct SurfaceMeeting {
  Meeting meeting = Meeting::unclear;
  std::optional<CommonSegment> common;  // only if the meeting is unclear
};

// Where two surfaces in file coordinates cross; empty if they do not, if it was not found, or if the budget is spent.
std::optional<CommonSegment> crossing_of(const Surface& a, const PosedPlace& at_a, const Surface& b, const PosedPlace& at_b,
                                         Budget& budget);

// apart: the bodies are farther apart than `gap`. deep: two triangles cross, and no translation up to `depth` ends that,
// or the surfaces are that far apart and a part of one is in the material of the other. Each triangle bounds material, is
// within it or is a sheet, so the bodies overlap. All this holds for any fill of holes within the hull of their rim.
// by_fill: the surfaces are farther apart than `gap`, and neither body encloses a part of the other without the fill of a
// hole. gap, depth: world units. The bodies have meshes. When the budget is spent, the meeting is unclear.
SurfaceMeeting meeting_of(PosedBody& a, const PosedPlace& at_a, PosedBody& b, const PosedPlace& at_b, double gap,
                          double depth, Budget& budget);

}  // namespace satcheck
