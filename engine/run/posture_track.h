// SPDX-License-Identifier: Apache-2.0
// Passes the recent postures of an arm, with their times, from one thread to another without locks.
#pragma once

#include "engine/model/arm_model.h"
#include "engine/types/clock.h"

#include <array>
#include <atomic>
#include <bit>
#include <chrono>
#include <cstdint>
#include <optional>

namespace fathom {

// One writer, one reader; both noexcept and wait-free. Each slot is a seqlock: the reader detects by the
// stamp that it is being written and skips it (Boehm, Can seqlocks get along with programming language memory
// models?, 2012).
class PostureTrack {
public:
    using Time = Clock::time_point;
    static constexpr size_t kKept = 256;
    // postures at shorter intervals are skipped, so that 0.5 s are kept
    static constexpr std::chrono::milliseconds kApart{2};

    // Writer, in order of time.
    void add(Time time, const ArmPosture& posture) noexcept;

    // Reader: the posture nearest to that time; nothing before the first add().
    std::optional<ArmPosture> nearest(Time time) const noexcept;

private:
    static constexpr size_t kWords = kMaxJoints + 1; // joints, grasp
    struct Slot {
        std::atomic<uint64_t> stamp{0}; // odd while it is written
        std::atomic<int64_t> time{0};   // [ns]
        std::array<std::atomic<uint64_t>, kWords> words{};
    };
    bool read(const Slot& slot, int64_t& time, ArmPosture& out) const noexcept;

    std::array<Slot, kKept> slots_;
    std::atomic<uint64_t> written_{0};
    Time last_{}; // writer's
};

} // namespace fathom
