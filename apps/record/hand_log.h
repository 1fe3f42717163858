// SPDX-License-Identifier: Apache-2.0
// What a live hand does while pictures are recorded, as a path that `replay --operator` plays beside them.
#pragma once

#include "devices/live_hand.h"

#include <atomic>
#include <deque>
#include <filesystem>
#include <fstream>
#include <memory>
#include <mutex>
#include <thread>

namespace fathom {

// Reads the hand a thousand times a second on a thread of its own and gives it zero force. Lockstep shows
// picture j at j / 30 s: what the hand did between two pictures is written between their places there, so
// that a replay sees the same hand at the same picture, however irregular the pictures came.
class HandLog {
public:
    // Throws Error when the file cannot be written.
    HandLog(std::unique_ptr<LiveHand> hand, const std::filesystem::path& file);
    HandLog(const HandLog&) = delete;
    HandLog& operator=(const HandLog&) = delete;
    ~HandLog();

    // The next picture of the recording, taken at `captureTime` [s] of CLOCK_MONOTONIC.
    void frame(double captureTime);
    // Writes what came since the last picture, at most a frame's length, and ends. Throws Error when the disk
    // did not take all.
    void finish();

    uint64_t samples() const noexcept { return samples_.load(); } // read so far
    const LiveHand& hand() const { return *hand_; }

    static constexpr double kFramePeriod = 1.0 / 30.0; // [s] of lockstep

private:
    struct Sample {
        double t = 0.0; // [s]
        HandSample hand;
    };
    void watch() noexcept;
    void flush(double from, double to, double start, double scale);

    std::unique_ptr<LiveHand> hand_;
    std::ofstream out_;
    std::filesystem::path file_;
    std::mutex mutex_;
    std::deque<Sample> waiting_;
    std::atomic<uint64_t> samples_{0};
    std::atomic<bool> stop_{false};
    uint32_t frames_ = 0;
    double last_ = 0.0, written_ = -1.0; // [s] capture time of the last picture; last row's place
    std::thread thread_;
};

} // namespace fathom
