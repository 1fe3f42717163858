// SPDX-License-Identifier: Apache-2.0
// Twin of shaders/lib/hold.glsl: the memory of forbidden points that a new frame does not contradict.
#pragma once

#include "engine/reference/spheres.h"

namespace fathom::reference {

// Memory of two points per pixel: the forbidden point seen in the previous frame, and the held one.
class HoldMemory {
public:
    // Processes the next frame and returns the held spheres, one per pixel. classes: class of the forbidden
    // point seen now at each pixel. previousTime: capture time of the previous frame. A point stays if it was
    // last seen at most scene.holdSeconds ago and its pixel now has no depth, shows a surface nearer by more
    // than 3 sigma of depth, or is outside the image, or the class tests colour and the image is dark.
    std::vector<RegionSphere> step(const FrameView& view, double captureTime, double previousTime,
                                   std::span<const int> classes, const PointImage& points);

    // Pixels where some decision so far depended on less than 1e-6 m, 1e-3 pixels or a microsecond.
    const std::vector<uint8_t>& unsure() const { return unsure_; }

private:
    struct Memory {
        dvec3 at{0.0};
        int cls = -1;
        double time = 0.0;
        double grown = 0.0; // [m] growth for its sigma when it was seen
    };
    struct Verdict {
        bool stays = false, unsure = false;
    };
    static Verdict stays(const FrameView& view, const Memory& memory, double captureTime);

    std::vector<Memory> last_, held_;
    std::vector<uint8_t> unsure_;
};

} // namespace fathom::reference
