// SPDX-License-Identifier: Apache-2.0
// Records the path of a live hand in step with the frames; `replay --operator` plays it.
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

// Reads the hand at 1 kHz on its own thread and sends it zero force. A lockstep replay shows frame j at j /
// 30 s, so samples between two captures are written at times between those two. The replay then has the same
// hand pose at the same frame even when frames came irregularly.
class HandLog {
public:
    // Throws Error when the file cannot be written.
    HandLog(std::unique_ptr<LiveHand> hand, const std::filesystem::path& file);
    HandLog(const HandLog&) = delete;
    HandLog& operator=(const HandLog&) = delete;
    ~HandLog(); // without a frame it removes the file

    // Call for every recorded frame. captureTime [s] of CLOCK_MONOTONIC.
    void frame(double captureTime);
    // Writes the samples since the last frame, at most one frame period, and ends. Throws Error when the disk
    // is full.
    void finish();

    uint64_t samples() const noexcept { return samples_.load(); } // samples read so far
    const LiveHand& hand() const { return *hand_; }

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
