// SPDX-License-Identifier: Apache-2.0
// Warnings about values of a robot description that are valid but unlikely: other units, no limits.
#pragma once

#include <string>
#include <urdf_model/joint.h>

namespace fathom {

inline constexpr double kLongSlide = 5.0;  // [m] travel of a joint
inline constexpr double kLongFinger = 0.5; // [m] travel of a finger

// Each returns one line for ArmModel::notes, or an empty text. [rad], or [m] if the joint slides.
std::string limitWarning(const std::string& joint, bool slides, double lower, double upper, double longSlide);
std::string speedWarning(const std::string& joint, bool slides, double stated); // [rad/s], [m/s]
std::string heldWarning(const std::string& joint, bool slides, double value);
// On a joint that stays outside its limits.
std::string beyondWarning(const std::string& joint, double value, double lower, double upper);
// On a finger that another one takes there, beyond its own limits.
std::string takenWarning(const std::string& finger, double open, double closed, double lower, double upper);
// On a finger whose open or closed position the program chose. seen: by the shapes of the fingers.
std::string endsWarning(const std::string& finger, double open, double closed, bool seen);
// On a finger with only one end in the scene: openGiven, or else the closed one.
std::string oneEndWarning(const std::string& finger, bool openGiven, double open, double closed);

// Why limits bound no range, with their values; empty if they do. limits: may be null.
std::string limitFault(const urdf::JointLimits* limits);

} // namespace fathom
