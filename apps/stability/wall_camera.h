// SPDX-License-Identifier: Apache-2.0
// A camera before a flat wall that may stand anywhere in every frame, with noise and missing pixels: new data
// at will.
#pragma once

#include "apps/stability/image_fixtures.h"
#include "apps/stability/rng.h"

#include <cstdint>
#include <vector>

namespace fathom::stability {

struct WallView {
    double z = 0.5;       // [m] of the wall before the camera at the base origin, which looks along +z
    double noise = 0.0;   // [m] sigma of every depth
    double missing = 0.0; // share of the pixels without depth
};

// Every pixel is forbidden; regions of 40 mm; frames at 30 Hz. One thread.
class WallCamera {
public:
    static constexpr double kRegion = 0.04; // [m]
    static constexpr double kFrame = 1.0 / 30.0;

    WallCamera(bool hold, uint64_t seed);
    Fixtures look(const WallView& look);

    // Farthest that any point of the last wall within 30 mm of (x, y) is from a pixel with depth [m].
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
