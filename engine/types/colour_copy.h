// SPDX-License-Identifier: Apache-2.0
// A frame's colours for who reads them on the host.
#pragma once

#include "engine/types/frame.h"

#include <vector>

namespace fathom {

// R8 G8 B8 A8 of whatever the camera sent; empty when it sent no colour.
void readColours(const Frame::Content& content, std::vector<uint32_t>& rgba);

// A copy that is made before the frame goes on, and unpacked when it has: what waits for the frame does not
// wait for that.
class ColourCopy {
public:
    void take(const Frame::Content& content);
    // As readColours(), of what was taken last. The memory in `rgba` may be kept for the next.
    void giveTo(std::vector<uint32_t>& rgba);

private:
    std::vector<uint32_t> words_;
    bool yuyv_ = false;
};

} // namespace fathom
