// SPDX-License-Identifier: Apache-2.0
// What the program made of an arm's files, for `plan` and the log.
#pragma once

#include "engine/cycle/arm_setup.h"

#include <string>
#include <vector>

namespace fathom {

// One line each: base and tip with the reasons, every joint of the chain with range, speed and where they
// come from, fingers, and joints that stay where they are. Allocates.
std::vector<std::string> describeArm(const ArmSetup& setup);

} // namespace fathom
