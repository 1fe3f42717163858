// SPDX-License-Identifier: Apache-2.0
// A robot whose driver publishes its joints.
#pragma once

#include "tests/ros2/speaker.h"

#include <atomic>
#include <mutex>
#include <string>
#include <thread>

// Publishes its joints every few milliseconds on a thread of its own.
class Robot {
public:
    Robot()
        : speaker_("/joint_states", "JointState")
        , thread_([this] { run(); }) {}
    ~Robot() {
        stop_ = true;
        thread_.join();
    }
    // A line of ros2_speaker; "" = silent.
    void isAt(const std::string& joints) {
        const std::lock_guard lock(mutex_);
        joints_ = joints;
    }

private:
    void run() {
        while (!stop_) {
            std::string joints;
            {
                const std::lock_guard lock(mutex_);
                joints = joints_;
            }
            if (!joints.empty()) {
                speaker_.say(joints);
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
    }

    Speaker speaker_;
    std::atomic<bool> stop_{false};
    std::mutex mutex_; // guards the joints
    std::string joints_;
    std::thread thread_;
};
