// SPDX-License-Identifier: Apache-2.0
// A still hand at the surface of a static scene: where the tool rests, and how the force ripples while each
// frame brings a new set of regions.
#pragma once

#include "apps/profile/spread.h"
#include "engine/contact/host_fixtures.h"
#include "engine/contact/tool.h"
#include "engine/scene/scene.h"

#include <vector>

namespace fathom::profile {

struct FeltSurface {
    double error = 0.0;   // [m] RMS distance of the resting tool from the true resting place
    double bias = 0.0;    // [m] mean of the same; positive: in front of it
    double ripple = 0.0;  // [N] RMS of the force about its mean, at 1000 N/m
    double band = 0.0;    // [N] its part in 10 to 35 Hz
    double step = 0.0;    // [N] largest change from tick to tick, at 1000 N/m
    double passive = 0.0; // [N s/m] smallest passive margin; NaN = the device's damping is unknown
    Cost query, tick;     // [ms] of one contact query, of one haptic step
};

// Up to three places on a surface where a tool rests, found once for all settings.
class FeltPlaces {
public:
    // truth: regions of the exact surface, as the camera at `baseTcamera` sees it. The tool, which must
    // outlive this object, has the camera's orientation. Throws Error when it touches nothing.
    FeltPlaces(const Tool& tool, const HostFixtures& truth, const Pose& baseTcamera = {});

    // Lets the hand press the tool 5 mm deep away from the camera, or less far on a device that cannot push
    // so hard, and shows it `frames` in turn at rateHz for `seconds` per place. The sets need no generation.
    FeltSurface feel(const Scene& scene, const std::vector<HostFixtures>& frames, double rateHz,
                     double seconds) const;

    size_t count() const { return places_.size(); }

private:
    struct Place {
        Pose rest;          // base_T_tool
        dvec3 in;           // unit, from the camera to the surface
        HostFixtures truth; // the part near the tool's path
    };
    const Tool& tool_;
    std::vector<Place> places_;
};

} // namespace fathom::profile
