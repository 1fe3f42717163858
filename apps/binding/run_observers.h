// SPDX-License-Identifier: Apache-2.0
// The observers requested for a realtime run.
#pragma once

#include "apps/binding/run_observer.h"
#include "engine/cycle/arm_setup.h"
#include "engine/run/record_drain.h"

#include <memory>
#include <string>
#include <vector>

namespace fathom {

// Help texts of --view-door and --ros2.
inline constexpr const char* kViewEndpointHelp =
    "socket that sends every tick and fixture set to observers (fathom/device_socket.h)";
inline constexpr const char* kRos2Help = "publish the run as topics of ROS 2 below this name: "
                                         "NAME or /NAME[,KEY=VALUE]... (man fathom)";

// Who receives the state of a run.
struct ObserverOptions {
    std::string viewEndpoint; // socket for observers (devices/bridge); empty = none
    std::string ros2;         // parseRos2OutputRequest(); empty = none
};

// All of them as one; may be none. Threads as for one.
class RunObservers final : public RunObserver {
public:
    // arm: null = the tool moves freely. Throws BadInput.
    RunObservers(const ObserverOptions& options, const ArmSetup* arm);

    void step(const TickRow& row) override;
    void frame(const HostFixtures& set) override;
    void setShapes(std::span<const Shape> shapes) override;
    void forget() noexcept override;
    RemoteRequests takeRequests() override;

private:
    std::vector<std::unique_ptr<RunObserver>> all_;
};

// Forwards everything to one sink, and to the observers.
class PublishedSink final : public ForwardingSink {
public:
    // Both outlive this.
    PublishedSink(RunSink& next, RunObserver& observers)
        : ForwardingSink(next)
        , observers_(observers) {}
    void frame(const PublishedFrame& frame, const HostFixtures& set) override {
        ForwardingSink::frame(frame, set);
        observers_.frame(set);
    }
    void step(const TickRow& row, const ObeyedSet& obeyed) override {
        ForwardingSink::step(row, obeyed);
        observers_.step(row);
    }

private:
    RunObserver& observers_;
};

} // namespace fathom
