// SPDX-License-Identifier: Apache-2.0
#include "engine/run/posture_track.h"

#include <algorithm>

namespace fathom {

void PostureTrack::add(Time time, const ArmPosture& posture) noexcept {
    const uint64_t count = written_.load(std::memory_order_relaxed);
    if (count > 0 && time - last_ < kApart) {
        return;
    }
    last_ = time;
    Slot& slot = slots_[count % kKept];
    const uint64_t stamp = slot.stamp.load(std::memory_order_relaxed);
    slot.stamp.store(stamp + 1, std::memory_order_relaxed);
    // Release stores after an odd stamp: a reader that sees one of the new words also sees the odd stamp.
    slot.time.store(nanosecondsOf(time), std::memory_order_release);
    for (size_t k = 0; k < kMaxJoints; ++k) {
        slot.words[k].store(std::bit_cast<uint64_t>(posture.q[k]), std::memory_order_release);
    }
    slot.words[kMaxJoints].store(std::bit_cast<uint64_t>(posture.grasp), std::memory_order_release);
    slot.stamp.store(stamp + 2, std::memory_order_release);
    written_.store(count + 1, std::memory_order_release);
}

bool PostureTrack::read(const Slot& slot, int64_t& time, ArmPosture& out) const noexcept {
    const uint64_t before = slot.stamp.load(std::memory_order_acquire);
    time = slot.time.load(std::memory_order_acquire);
    for (size_t k = 0; k < kMaxJoints; ++k) {
        out.q[k] = std::bit_cast<double>(slot.words[k].load(std::memory_order_acquire));
    }
    out.grasp = std::bit_cast<double>(slot.words[kMaxJoints].load(std::memory_order_acquire));
    return before % 2 == 0 && slot.stamp.load(std::memory_order_relaxed) == before;
}

std::optional<ArmPosture> PostureTrack::nearest(Time wanted) const noexcept {
    const int64_t goal = nanosecondsOf(wanted);
    const uint64_t count = written_.load(std::memory_order_acquire);
    std::optional<ArmPosture> best;
    int64_t bestAway = 0;
    // Searches back from the newest, as long as times come nearer.
    for (uint64_t back = 1; back <= std::min<uint64_t>(count, kKept); ++back) {
        int64_t time = 0;
        ArmPosture posture;
        if (!read(slots_[(count - back) % kKept], time, posture)) {
            continue;
        }
        const int64_t away = std::abs(time - goal);
        if (best && away >= bestAway) {
            break;
        }
        best = posture;
        bestAway = away;
    }
    return best;
}

} // namespace fathom
