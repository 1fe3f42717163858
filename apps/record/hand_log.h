// SPDX-License-Identifier: Apache-2.0
// Records a live hand with the frames, as a path that `replay --operator` plays with them.
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

// Reads the hand at 1 kHz on its own thread and sends it zero force. Lockstep shows frame j at j / 30 s, so
// samples between two frames are written between those times. A replay then sees the same hand at the same
// frame, even if the frames came irregularly.
class HandLog {
public:
    // Throws Error when the file cannot be written.
    HandLog(std::unique_ptr<LiveHand> hand, const std::filesystem::path& file);
    HandLog(const HandLog&) = delete;
    HandLog& operator=(const HandLog&) = delete;
    ~HandLog();

    // The next frame of the recording, captured at `captureTime` [s] of CLOCK_MONOTONIC.
    void frame(double captureTime);
    // Writes the samples since the last frame, at most one frame period, and ends. Throws Error when the disk
    // is full.
    void finish();

    uint64_t samples() const noexcept { return samples_.load(); } // samples read so far
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
    double last_ = 0.0, written_ = -1.0; // [s] capture time of the last frame; time of the last row
    std::thread thread_;
};

} // namespace fathom
