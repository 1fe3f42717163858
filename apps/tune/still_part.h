// SPDX-License-Identifier: Apache-2.0
// Estimates depth noise and the true surface from frames of a camera at rest: where the camera is still, how
// large the noise is, and the mean image of a still part. Pure functions of frames.
#pragma once

#include "apps/profile/frame_bench.h"

namespace fathom::tune {

using profile::FrameSequence;
using profile::SampleFrame;

inline constexpr size_t kMinStill = 8; // [frames] that make a reference

// Standard deviation of a depth reading at one range.
struct DepthNoise {
    double sigma = 0.0;   // [m]
    double range = 0.0;   // [m] along the optical axis: the median of the readings
    bool measured = true; // over time; else at least that of the simulated camera is assumed
};

// The noise of one image: differences of three neighbours in a row, which a smooth surface cancels. At least
// that of rounding to units. Zero range: no readings.
DepthNoise noiseWithin(const CameraInfo& camera, const SampleFrame& image);

// The noise of a pixel over time, from differences of three successive frames, which a steady motion of the
// camera cancels; at least the noise within the first image. Within an image alone it cannot be measured,
// because neighbours of many sensors are alike: with less than three frames, or frames that show different
// things, it is at least that of the simulated camera. There must be a frame.
DepthNoise noiseOverTime(const FrameSequence& source);

// The longest run of frames in which camera and scene stand still: equal poses, where there are poses, and
// pixels whose change does not grow with the time between two frames.
struct StillPart {
    size_t first = 0, count = 0;

    bool enough() const { return count >= kMinStill; }
};
StillPart longestStill(const FrameSequence& source);

// The mean image of a still part: depth of pixels that are measured in at least half of its frames and do
// not flicker between two surfaces, in finer units than the camera's; mean colours.
struct MeanImage {
    CameraInfo camera;
    SampleFrame image;
    DepthNoise noise; // of a pixel over time, the median of all pixels
};
MeanImage meanOf(const FrameSequence& source, const StillPart& part);

} // namespace fathom::tune
