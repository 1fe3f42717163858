// SPDX-License-Identifier: Apache-2.0
// What the frames of a camera hold: times, depth, colour; and the first frame as images.
#pragma once

#include "apps/inspect/histogram_image.h"
#include "devices/camera.h"

#include <filesystem>
#include <iosfwd>
#include <optional>
#include <vector>

namespace fathom {

// Counts of the frames that are read, at most kMaxFrames.
class FrameStudy {
public:
    // Reads frames. `out`: a folder for depth.png (near is light, black is not measured), colour.png and
    // histograms.png.
    FrameStudy(Camera& camera, const std::optional<std::filesystem::path>& out);

    void write(std::ostream& out) const;

    static constexpr uint32_t kMaxFrames = 300;

private:
    void add(const Frame& frame);
    void writeTimes(std::ostream& out) const;
    double quantile(double share) const; // [m] of the measured pixels
    DepthBars depthBars() const;
    void writeDepth(std::ostream& out) const;
    void writeColour(std::ostream& out) const;

    const CameraInfo info_;
    std::vector<double> stamps_;                                  // [s]
    std::vector<uint64_t> counts_ = std::vector<uint64_t>(65536); // of each depth value
    uint64_t grey_ = 0, coloured_ = 0; // pixels whose saturation is at most, or over, a tenth
    uint64_t measured_ = 0;            // pixels
    HueStudy hues_;
    uint32_t posed_ = 0, frameCount_ = 0, skipped_ = 0;
    bool more_ = false, live_ = false;
    std::string noColour_;
};

} // namespace fathom
