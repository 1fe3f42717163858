// SPDX-License-Identifier: Apache-2.0
// Whether depth and colour of a bag are stamped by one clock.
#include "devices/bag/bag_camera.h"

namespace fathom {

// Stamps of two clocks agree to a hundredth of a period by chance at most. Those that do, over most of the
// recording, are of one clock, however late a slow transport had the images of one topic recorded.
bool BagCamera::stampsAgree() {
    constexpr size_t kSamples = 15, kFewest = 3;
    constexpr double kNear = 0.02; // of the tolerance, half a period
    const std::vector<MessageEntry>& all = topicOf(choice_.depth).messages;
    size_t looked = 0, near = 0;
    sample(kSamples, [&](size_t i) {
        ++looked;
        near += colour_->nearest(depth_->stampOf(i), all[i].time, kNear * tolerance_) ? 1 : 0;
    });
    return near >= kFewest && 3 * near >= 2 * looked;
}

} // namespace fathom
