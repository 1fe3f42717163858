// SPDX-License-Identifier: Apache-2.0
// The lines under an exported image: time, pilot, state, force, gap and the job.
#pragma once

#include "apps/operate/depth_cues.h"
#include "apps/operate/mode.h"
#include "apps/output/image.h"

#include <string>
#include <vector>

namespace fathom::operate {

struct CaptionInput {
    ModeInput mode;
    const DepthCues& cues;
    const std::string& pilot;            // empty = none
    const std::vector<std::string>& job; // lines
};

// First the time (of a recording: its own and the frame, else the clock's) and the pilot, then the subtitle
// with state, force and gap, then the job.
std::vector<std::string> captionOf(const CaptionInput& input);

// Height [pixels] of these lines under an image of this width.
int captionHeight(int width, size_t lines);
// Draws them from the row `top` on, shortened where they are too long.
void drawCaption(const Image& image, int top, const std::vector<std::string>& lines);

} // namespace fathom::operate
