// SPDX-License-Identifier: Apache-2.0
#include "apps/binding/run_observers.h"

#include "apps/binding/ros2_output.h"
#include "apps/binding/view_publisher.h"

#include <algorithm>
#include <iterator>

namespace fathom {

namespace {

std::vector<Ros2Joint> jointsOf(const ArmSetup* arm) {
    std::vector<Ros2Joint> joints;
    if (arm != nullptr) {
        std::transform(arm->model.joints.begin(), arm->model.joints.end(), std::back_inserter(joints),
                       [](const ArmJoint& joint) {
                           return Ros2Joint{joint.name, joint.slides, joint.mimic.has_value()};
                       });
    }
    return joints;
}

} // namespace

RunObservers::RunObservers(const ObserverOptions& options, const ArmSetup* arm) {
    if (!options.viewEndpoint.empty()) {
        all_.push_back(std::make_unique<ViewPublisher>(options.viewEndpoint));
    }
    if (!options.ros2.empty()) {
        all_.push_back(openRos2Output(parseRos2OutputRequest(options.ros2), jointsOf(arm)));
    }
}

void RunObservers::step(const TickRow& row) {
    for (const auto& observer : all_) {
        observer->step(row);
    }
}

void RunObservers::frame(const HostFixtures& set) {
    for (const auto& observer : all_) {
        observer->frame(set);
    }
}

void RunObservers::setShapes(std::span<const Shape> shapes) {
    for (const auto& observer : all_) {
        observer->setShapes(shapes);
    }
}

RemoteRequests RunObservers::takeRequests() {
    RemoteRequests all;
    for (const auto& observer : all_) {
        const RemoteRequests requests = observer->takeRequests();
        all.forcesOff = all.forcesOff || requests.forcesOff;
        all.guidance = requests.guidance ? requests.guidance : all.guidance;
        all.frozen = requests.frozen ? requests.frozen : all.frozen;
    }
    return all;
}

void RunObservers::forget() noexcept {
    for (const auto& observer : all_) {
        observer->forget();
    }
}

} // namespace fathom
