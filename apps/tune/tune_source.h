// SPDX-License-Identifier: Apache-2.0
// The frames that `fathom tune` measures on, and the true surface that they are judged against.
#pragma once

#include "apps/profile/frame_sequence.h"
#include "apps/tune/still_part.h"

#include <filesystem>
#include <optional>
#include <string>

namespace fathom::tune {

// Frames of the recording or camera that a twin represents, spread over what was read, with the scene's own
// classes.
struct OwnFrames {
    Scene scene;
    FrameSequence frames;
};

// Equal settings see equal frames.
struct TuneSource {
    FrameSequence frames;  // shown in turn
    CameraInfo trueCamera; // of `truth`; its depth may have finer units
    SampleFrame truth;     // the image of the true surface
    Scene scene;           // classes for these frames: the scene's, or red and yellow ones for the twin
    bool twin = false;     // an analytic scene instead of the user's
    OwnFrames own;         // of a twin only
    std::string camera;    // what delivered the frames
    std::string judgedBy;  // what the truth is, and what it does not show, in a sentence
};

// The scene's camera or `source`: `most` frames of a simulated camera with its exact surface; or a part of a
// recording or live stream in which the camera stands still, with the mean of its frames; or else frames of
// an analytic scene through a camera of equal lens, size and noise. Throws BadInput when nothing can be
// judged.
TuneSource tuneSource(const Scene& scene, const std::optional<std::filesystem::path>& source, size_t most);

// Every nth column and row of an image: see engine/types/decimation.h.
SampleFrame decimatedImage(const CameraInfo& camera, const SampleFrame& image, uint32_t n);

} // namespace fathom::tune
