// SPDX-License-Identifier: Apache-2.0
// Twin of shaders/estimate.comp: the depth of each pixel, averaged over frames.
#pragma once

#include "engine/reference/frame_view.h"

#include <optional>

namespace fathom::reference {

// Memory of one estimate per pixel. `masks` and `points` are those of surface(), which step() replaces.
class DepthEstimates {
public:
    // Processes the next frame. listed: the pixel's patch has work; elsewhere estimates end. before: pose of
    // the camera in the last frame; empty = the estimates start anew. A trusted estimate averages the
    // filtered depth over scene.filter.memory frames. It is trusted while the measured depth is within 3
    // sigma, and the recent mean of its differences from the filtered depth within min(0.6 sigma, 0.6 mm),
    // half of it for a surface that comes nearer. It is drawn to within min(sigma, 0.4 mm) of the filtered
    // depth. Points follow it in steps of over min(0.2 sigma, 0.2 mm). A pixel of a forbidden class that has
    // no point keeps its estimate for as many frames, unless its depth is more than 3 sigma off; an estimate
    // of 8 frames also keeps it for two frames in which the depth is over 10 mm farther.
    void step(const FrameView& view, std::span<const uint8_t> listed, const std::optional<Pose>& before,
              std::vector<uint32_t>& masks, PointImage& points);

    // Pixels where some decision so far depended on less than 1 um (drift: 2 um) or 1e-3 pixels.
    const std::vector<uint8_t>& unsure() const { return unsure_; }
    uint32_t weight(size_t pixel) const { return now_[pixel].weight; }

private:
    struct Estimate {
        double mean = 0.0, shown = 0.0, drift = 0.0; // [m]
        uint32_t weight = 0, classes = 0, missed = 0;
    };
    Estimate carried(const FrameView& view, const Pose& beforeTnow, int u, int v, double z,
                     bool& unsure) const;
    static bool suddenlyFarther(const Scene& scene, const Estimate& e, double raw, bool& unsure);
    static Estimate updated(const Scene& scene, Estimate e, double z, double raw, double sigma, bool& unsure);
    static Estimate outlasting(const Scene& scene, Estimate e, double raw, double sigma, bool& unsure);

    std::vector<Estimate> last_, now_;
    std::vector<uint8_t> unsure_, unsureLast_;
};

} // namespace fathom::reference
