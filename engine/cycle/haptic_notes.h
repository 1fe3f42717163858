// SPDX-License-Identifier: Apache-2.0
// Warnings about settings that weaken or remove forces, one line each.
#pragma once

#include "engine/scene/scene.h"

#include <string>
#include <vector>

namespace fathom {

// Why forces cannot come on when HapticOptions::forceLimit is 0.
inline constexpr const char* kNoForce = "the force limit is 0: set haptics.limits.force or choose a pilot";

// For the warnings of a run. One line per setting that keeps forces below what a hand feels (force limit,
// slew limit, stiffness), if guidance mode `paper` has no spring left, and if the stiffness exceeds twice the
// passive bound. Throws BadInput as makeHapticOptions().
std::vector<std::string> forceWarnings(const Scene& scene);

// forceWarnings() of every pilot, and further: limits or stiffness above the device's, a stiffness over the
// passive bound, torques that no hand feels, and hand speeds that the settings cannot follow. Throws BadInput
// as makeHapticOptions().
std::vector<std::string> hapticNotes(const Scene& scene);

} // namespace fathom
