// SPDX-License-Identifier: Apache-2.0
// Runs a simulated arm on a pseudo-terminal in real time, on its own thread, for a program to drive.
#pragma once

#include "tests/devices/pty_line.h"
#include "tests/support/eventually.h"

#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

namespace fathom::testing {

class ArmBench {
public:
    // port: a symbolic link to the terminal while it is plugged in.
    ArmBench(ArmSimulator& arm, std::filesystem::path port)
        : arm_(arm)
        , port_(std::move(port)) {
        plug();
        thread_ = std::thread([this] { run(); });
    }
    ~ArmBench() {
        stop_ = true;
        thread_.join();
    }

    void plug() {
        const std::lock_guard lock(mutex_);
        line_.emplace(arm_, true);
        std::filesystem::remove(port_);
        std::filesystem::create_symlink(line_->name(), port_);
    }
    void unplug() {
        const std::lock_guard lock(mutex_);
        std::filesystem::remove(port_);
        line_.reset();
    }
    void faults(const LineFaults& faults) {
        const std::lock_guard lock(mutex_);
        line_->faults = faults;
    }
    // Reads or changes the arm between two of its steps.
    template <class Look>
    auto with(Look&& look) {
        const std::lock_guard lock(mutex_);
        return look();
    }
    // Waits until `state` is true of the arm between two of its steps.
    bool wait(const std::function<bool()>& state) {
        return eventually([&] { return with(state); });
    }

private:
    void run() {
        auto before = std::chrono::steady_clock::now();
        const auto began = before;
        while (!stop_) {
            const auto now = std::chrono::steady_clock::now();
            {
                const std::lock_guard lock(mutex_);
                if (line_) {
                    line_->exchange(std::chrono::duration<double>(now - began).count());
                }
                arm_.step(std::chrono::duration<double>(now - before).count());
            }
            before = now;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    }

    ArmSimulator& arm_;
    std::filesystem::path port_;
    std::optional<PtyLine> line_;
    std::mutex mutex_;
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

} // namespace fathom::testing
