// SPDX-License-Identifier: Apache-2.0
// Links of an arm that a placed shape does not leave alone, although the hand does nothing.
#pragma once

#include "engine/cycle/arm_setup.h"

#include <string>
#include <vector>

namespace fathom {

// One line per placed shape for links that start outside of a `keep_in` shape, which pulls all links inside,
// and for links inside of a forbidden one that no joint moves.
std::vector<std::string> startOverlaps(const ArmSetup& arm, const Scene& scene);

} // namespace fathom
