// SPDX-License-Identifier: Apache-2.0
// Twin of shaders/lib/hold.glsl: the memory of forbidden points that a new frame does not contradict.
#pragma once

#include "engine/reference/spheres.h"

namespace fathom::reference {

// A memory of two points per pixel: the forbidden point that it showed last frame, and the one that it holds.
class HoldMemory {
public:
    // The next frame: what is held in it, one sphere per pixel. classes: class of the forbidden point seen
    // now at each pixel. previousTime: the capture time at which the last frame's points were still seen. A
    // point stays while it was last seen at most scene.holdSeconds ago and its pixel now shows no depth, or
    // something nearer by more than 3 sigma of depth, or lies outside the frame.
    std::vector<RegionSphere> step(const FrameView& view, double captureTime, double previousTime,
                                   std::span<const int> classes, const PointImage& points);

    // Pixels where some decision so far hung on less than 1e-6 m, 1e-3 pixels or a microsecond.
    const std::vector<uint8_t>& unsure() const { return unsure_; }

private:
    struct Memory {
        dvec3 at{0.0};
        int cls = -1;
        double time = 0.0;
        double grown = 0.0; // [m] for its sigma, as it was seen
    };
    struct Verdict {
        bool stays = false, unsure = false;
    };
    static Verdict stays(const FrameView& view, const Memory& memory, double captureTime);

    std::vector<Memory> last_, held_;
    std::vector<uint8_t> unsure_;
};

} // namespace fathom::reference
