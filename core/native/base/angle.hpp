// Angles from the four operations and sqrt, which IEEE 754 rounds: the same bits on every system. The functions of the
// C library are right to about the last bit, and which way they err differs between systems.
#pragma once

namespace satcheck {

// The angle of (x, y) from the x axis, between -pi and pi; 0 for (0, 0). Off by at most 16 roundoffs, in radians.
double direction_angle(double y, double x);

// The angle with this cosine, between 0 and pi. -1 <= cosine <= 1. Off by at most 16 roundoffs, in radians.
double angle_of_cosine(double cosine);

// The cosine of an angle from 0 to pi / 2. Off by at most 8 roundoffs.
double cosine_of(double angle);

}  // namespace satcheck
