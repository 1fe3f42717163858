// SPDX-License-Identifier: Apache-2.0
#include "devices/skipped_frames.h"

#include "engine/types/error.h"
#include "engine/types/log.h"

namespace fathom {

void SkippedFrames::add(const std::string& camera, const std::string& cause, uint32_t frames) {
    count_ += frames;
    last_ = frames > 0 ? cause : last_; // else none is lost
    if (causes_.size() < kMaxCauses && causes_.insert(cause).second) {
        log::warn("{}: {}{} (logged once)", camera, frames > 0 ? "frame skipped: " : "", cause);
    }
}

void SkippedFrames::fail(const std::string& camera) const {
    throw DeviceLost(camera + ": frames arrive, but none is usable; last: " + last_);
}

void SkippedFrames::limit(const std::string& camera, uint32_t before, double waited, double most) const {
    if (count_ != before && waited > most) {
        fail(camera);
    }
}

} // namespace fathom
