// SPDX-License-Identifier: Apache-2.0
// A camera in front of a flat wall whose position, noise and missing pixels can change in every frame.
#pragma once

#include "apps/stability/image_fixtures.h"
#include "engine/reference/rng.h"

#include <cstdint>
#include <vector>

namespace fathom::stability {

struct WallView {
    double z = 0.5;       // [m] of the wall; the camera is at the base origin and looks along +z
    double noise = 0.0;   // [m] sigma of every depth
    double missing = 0.0; // fraction of pixels without depth
};

// Every pixel is forbidden, with regions of 40 mm radius and frames at 30 Hz. For one thread.
class WallCamera {
public:
    static constexpr double kRegion = 0.04; // [m]
    static constexpr double kFrame = 1.0 / 30.0;

    WallCamera(bool hold, uint64_t seed);
    HostFixtures look(const WallView& look);

    // Largest distance [m] to the nearest pixel with depth, over points of the last wall within 30 mm of (x,
    // y).
    double largestHole(double x, double y) const;

private:
    static Scene scene();
    static CameraInfo camera();
    CameraInfo camera_;
    ImageFixtures make_;
    Rng rng_;
    std::vector<uint16_t> depth_;
    double z_ = 0.0, time_ = 0.0;
};

} // namespace fathom::stability
