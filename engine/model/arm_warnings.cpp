// SPDX-License-Identifier: Apache-2.0
#include "engine/model/arm_warnings.h"

#include "engine/types/printed.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

namespace fathom {

std::string limitWarning(const std::string& joint, bool slides, double lower, double upper,
                         double longSlide) {
    constexpr double kFourTurns = 8.0 * std::numbers::pi;
    const double span = std::isfinite(upper - lower) ? upper - lower : 0.0;
    std::ostringstream line;
    line << "joint " << joint << ": limits " << lower << " to " << upper << (slides ? " m" : " rad");
    if (lower == upper) {
        line << ": it cannot move"
             << (lower == 0.0 ? "; they are 0 where <limit> has no lower and upper" : "");
    } else if (slides && span > longSlide) {
        line << " span more than " << longSlide << " m; in millimetres, or without limits?";
    } else if (!slides && span > kFourTurns) {
        line << " span more than four turns; in degrees?";
    } else {
        return "";
    }
    return line.str();
}

std::string limitFault(const urdf::JointLimits* limits) {
    if (limits == nullptr) {
        return "no limits";
    }
    return limits->lower <= limits->upper ? ""
                                          : printed("lower %.15g, upper %.15g", limits->lower, limits->upper);
}

std::string speedWarning(const std::string& joint, bool slides, double stated) {
    if (stated < 0.0) {
        std::ostringstream none;
        none << "joint " << joint << ": the file states a speed of " << stated << ", which counts as none";
        return none.str();
    }
    constexpr double kFastTurn = 4.0 * std::numbers::pi, kFastSlide = 5.0;
    std::ostringstream line;
    line << "joint " << joint << ": speed " << stated
         << (slides ? " m/s; in millimetres per second?" : " rad/s; in degrees per second?");
    return stated > (slides ? kFastSlide : kFastTurn) ? line.str() : "";
}

std::string heldWarning(const std::string& joint, bool slides, double value) {
    std::ostringstream line;
    line << "joint " << joint << ": stays at " << value
         << (slides ? " m; in millimetres?" : " rad; in degrees?");
    return std::abs(value) > (slides ? kLongSlide : 4.0 * std::numbers::pi) ? line.str() : "";
}

std::string beyondWarning(const std::string& joint, double value, double lower, double upper) {
    constexpr double kRounding = 1e-6; // [rad], [m]
    std::ostringstream line;
    line << "joint " << joint << ": stays at " << value << ", beyond its limits " << lower << " to " << upper;
    return value < lower - kRounding || value > upper + kRounding ? line.str() : "";
}

std::string takenWarning(const std::string& finger, double open, double closed, double lower, double upper) {
    const double most = std::max(open, closed), least = std::min(open, closed);
    const double rounding = 0.01 * (most - least); // files state limits with two digits
    std::ostringstream line;
    line << "finger " << finger << ": its mimic takes it from " << open << " to " << closed
         << ", beyond its limits " << lower << " to " << upper;
    return least < lower - rounding || most > upper + rounding ? line.str() : "";
}

std::string endsWarning(const std::string& finger, double open, double closed, bool seen) {
    std::ostringstream line;
    line << "finger " << finger << ": open at " << open << " and closed at " << closed
         << (seen ? ", as the shapes of the fingers show"
                  : " by default; the shapes of the fingers do not tell")
         << "; grasp.fingers sets both";
    return line.str();
}

std::string oneEndWarning(const std::string& finger, bool openGiven, double open, double closed) {
    std::ostringstream line;
    line << "finger " << finger << ": " << (openGiven ? "closed at " : "open at ")
         << (openGiven ? closed : open) << " is assumed, the limit farther from "
         << (openGiven ? "open at " : "closed at ") << (openGiven ? open : closed)
         << "; grasp.fingers sets both";
    return line.str();
}

} // namespace fathom
