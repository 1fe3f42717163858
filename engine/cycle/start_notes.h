// SPDX-License-Identifier: Apache-2.0
// Warnings about placed shapes that push the tool or arm at the start of a run, and so a hand at rest.
#pragma once

#include "engine/cycle/arm_setup.h"
#include "engine/cycle/step_record.h"

#include <string>
#include <vector>

namespace fathom {

// One line per forbidden shape and link (without an arm: the tool) that starts inside of it, and per keep_in
// shape that a tool without an arm starts outside of. With the depth [mm] of the deepest sphere. Not for
// links that no joint moves (shapeNotes()), nor for links outside of a keep_in shape, which does not hold
// them. arm: null = `tool` moves freely from start.pose; otherwise the arm starts at start.arm, and `tool` is
// not read.
std::vector<std::string> startNotes(const Scene& scene, const Tool& tool, const ArmSetup* arm,
                                    const ToolPlace& start);

// Logs them as warnings. Not on the haptic thread.
void warnOfStart(const Scene& scene, const Tool& tool, const ArmSetup* arm, const ToolPlace& start);

} // namespace fathom
