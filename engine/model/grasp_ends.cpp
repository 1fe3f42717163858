// SPDX-License-Identifier: Apache-2.0
#include "engine/model/grasp_ends.h"

#include <cmath>

namespace fathom {

namespace {

// Where fingers are open and closed in most descriptions, unless their shapes tell (finger_ends.h): they
// slide towards 0, or turn from lower to upper.
std::pair<double, double> usualEnds(const urdf::Joint& joint) {
    const double lower = joint.limits->lower, upper = joint.limits->upper;
    const bool down = joint.type == urdf::Joint::PRISMATIC && std::abs(upper) >= std::abs(lower);
    return down ? std::pair{upper, lower} : std::pair{lower, upper};
}

// Of a finger with one given end: the limit farther from it, so that the finger moves. On a tie the usual
// one.
double farther(const urdf::Joint& joint, double given, double usual) {
    const double lower = joint.limits->lower, upper = joint.limits->upper;
    const double down = given - lower, up = upper - given;
    return down == up ? usual : down > up ? lower : upper;
}

} // namespace

std::pair<double, double> graspEnds(const ArmOptions::Finger& wanted, const urdf::Joint& joint) {
    const auto [open, closed] = usualEnds(joint);
    return {wanted.open     ? *wanted.open
            : wanted.closed ? farther(joint, *wanted.closed, open)
                            : open,
            wanted.closed ? *wanted.closed
            : wanted.open ? farther(joint, *wanted.open, closed)
                          : closed};
}

} // namespace fathom
