// SPDX-License-Identifier: Apache-2.0
// The settings that `fathom tune` chooses, the values that it tries, and their names.
#pragma once

#include "engine/scene/scene.h"

#include <string>
#include <vector>

namespace fathom::tune {

// One combination of settings.
struct Setting {
    uint32_t radius = 2;         // [pixels] of the depth filter; 0 = none
    double sigma = 0.01;         // [m] of the depth filter
    uint32_t memory = 0;         // [frames]
    double errorBudget = 0.0001; // [m]
    double friction = 0.0;
    double reach = 0.01;     // [m] of a contact query
    uint32_t decimation = 1; // image size: every nth column and row of the camera's

    bool operator==(const Setting&) const = default;
    // Whether both need the same regions: they differ at most in friction and reach.
    bool sameRegions(const Setting& other) const;
};

// The settings of a scene, and a scene with other ones.
Setting settingOf(const Scene& scene);
Scene sceneWith(Scene scene, const Setting& setting);

// What is varied, one after another, each with the best setting so far.
enum class Vary { Window, Sigma, Memory, Budget, Friction, Reach, Size };
inline constexpr Vary kVaried[] = {Vary::Window,   Vary::Sigma, Vary::Memory, Vary::Budget,
                                   Vary::Friction, Vary::Reach, Vary::Size};

const char* nameOf(Vary vary);                          // "filter radius"
std::string valueOf(const Setting& setting, Vary vary); // "2 pixels"
// `base` with other values of one setting; `base` itself is not among them.
std::vector<Setting> othersOf(const Setting& base, Vary vary);

// All settings in one line: "filter 5x5, sigma 10 mm, memory 0 frames, ...".
std::string wordsOf(const Setting& setting);

} // namespace fathom::tune
