// SPDX-License-Identifier: Apache-2.0
// The topics of ros2_output.h.
#pragma once

#include "apps/binding/ros2_commands.h"
#include "apps/binding/ros2_diagnosis.h"
#include "apps/binding/ros2_servo.h"
#include "devices/ros2/ros2_graph.h"
#include "devices/ros2/ros2_output_request.h"

#include <memory>
#include <string>
#include <vector>

namespace fathom {

// One thread. No message is made for a topic without subscribers.
class Ros2Topics {
public:
    // Throws BadInput, Error.
    Ros2Topics(const Ros2OutputRequest& request, const std::vector<Ros2Joint>& joints);

    void tick(const Ros2Tick& tick);
    void regions(const Ros2Regions& regions);
    void receive() {
        if (commands_) {
            commands_->receive();
        }
    }
    RemoteRequests takeRequests() { return commands_ ? commands_->take() : RemoteRequests{}; } // any thread
    void rest(); // no tick comes for now: a robot stands still
    // Whether regions() would send anything.
    bool regionsWatched() const noexcept { return regions_.cloud.watched() || regions_.markers.watched(); }

private:
    void send(Ros2Writer& writer, const ros2::Message& message) noexcept;
    void diagnose(const Ros2Tick& tick);
    void sendFrames(const Ros2Tick& tick);

    static constexpr uint64_t kDiagnosisPeriod = 1'000'000'000; // [ns]

    struct Wrenches {
        Ros2Writer hand, device;
    };
    struct Poses {
        Ros2Writer tool, device, target;
    };
    struct RegionWriters {
        Ros2Writer cloud, markers;
    };

    std::shared_ptr<Ros2Graph> graph_;
    std::string frame_;
    std::vector<std::string> joints_;
    Wrenches wrenches_;
    Poses poses_;
    RegionWriters regions_;
    Ros2Writer diagnostics_;
    std::unique_ptr<Ros2Writer> jointState_; // null = no arm
    std::unique_ptr<Ros2Writer> frames_;     // null = none
    std::unique_ptr<Ros2Servo> servo_;       // null = no robot
    std::unique_ptr<Ros2Commands> commands_; // null = none are obeyed
    Ros2Diagnosis diagnosis_;
    uint64_t diagnosed_ = 0; // [ns] time of the last diagnostics
    uint64_t unsent_ = 0;    // messages
};

} // namespace fathom
