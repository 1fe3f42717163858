// SPDX-License-Identifier: Apache-2.0
// A writer thread that feeds the topics of a run with steps of made-up values, 1 ms apart in time of the run.
#pragma once

#include "apps/binding/ros2_output.h"

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

class FedRun {
public:
    // request: as of --ros2, without the domain.
    explicit FedRun(const std::string& request, const std::vector<fathom::Ros2Joint>& joints = {});
    ~FedRun();

    void change(const std::function<void(fathom::TickRow&)>& how);
    // Changes each step once its time is set.
    void each(const std::function<void(fathom::TickRow&)>& how);
    void restart() { restart_ = true; } // at time 0
    double time() const { return t_; }  // [s]
    fathom::RunObserver& observer() { return *output_; }

private:
    void feed();

    std::unique_ptr<fathom::RunObserver> output_;
    fathom::HostFixtures set_;
    std::mutex mutex_; // guards the members below
    fathom::TickRow row_;
    std::function<void(fathom::TickRow&)> each_;
    std::atomic<double> t_{0.0};
    std::atomic<bool> stop_{false}, restart_{false};
    std::thread thread_;
};
