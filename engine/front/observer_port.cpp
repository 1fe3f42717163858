// SPDX-License-Identifier: Apache-2.0
#include "engine/front/observer_port.h"

namespace fathom::front {

void fill(v0::Regions& out, const HostFixtures& set) {
    out.frame = set.frame;
    out.origin = external(set.origin);
    const RegionSpheres& from = set.spheres;
    out.spheres.resize(from.size());
    for (size_t i = 0; i < from.size(); ++i) {
        out.spheres[i] = {{from.x[i], from.y[i], from.z[i]}, from.radius[i], from.fixture[i]};
    }
    out.targets.clear();
    for (const GuidancePose& pose : set.guidance) {
        out.targets.push_back({pose.fixture, pose.present, external(pose.target)});
    }
}

} // namespace fathom::front

namespace fathom::v0 {

ObserverPort::ObserverPort(std::unique_ptr<Impl> impl) noexcept
    : impl_(std::move(impl)) {}
ObserverPort::ObserverPort(ObserverPort&&) noexcept = default;
ObserverPort& ObserverPort::operator=(ObserverPort&&) noexcept = default;
ObserverPort::~ObserverPort() = default;

bool ObserverPort::regions(Regions& out) {
    impl_->pending = impl_->shared->regions.refresh() || impl_->pending; // stays, if copying throws
    const bool newer = impl_->pending;
    if (newer) {
        out = impl_->shared->regions.front();
        impl_->pending = false;
    }
    return newer;
}

bool ObserverPort::step(StepSnapshot& out) noexcept {
    const bool newer = impl_->shared->steps.refresh();
    if (newer) {
        out = impl_->shared->steps.front();
    }
    return newer;
}

} // namespace fathom::v0
