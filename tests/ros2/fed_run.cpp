// SPDX-License-Identifier: Apache-2.0
#include "tests/ros2/fed_run.h"

#include "tests/ros2/peer.h"

using namespace fathom;

namespace {

StepRecord someRecord() {
    StepRecord r;
    r.state = StepState::Contact;
    r.wrench = {{1.0, 2.0, 3.0}, {0.1, 0.2, 0.3}};
    r.deviceWrench = {{-1.0, 0.0, 0.5}, {}};
    r.tool = {{0.25, -0.5, 0.75}, {0.5, 0.5, 0.5, 0.5}};
    r.device = {{0.25, -0.5, 0.7}, {1.0, 0.0, 0.0, 0.0}};
    r.guidanceClass = 0;
    r.guidanceTarget = {{0.0, 0.0, 0.8}, {1.0, 0.0, 0.0, 0.0}};
    r.sceneAge = 0.02;
    r.armHold = false;
    r.arm.posture.q[0] = 0.5;
    r.arm.posture.q[1] = -0.25;
    return r;
}

HostFixtures someSet() {
    HostFixtures set;
    set.frame = 3;
    set.generation = 1;
    set.origin = {10.0, 0.0, 0.0};
    set.baseTcamera.position = {0.0, 0.5, 0.0};
    set.spheres.x = {0.5f, 0.6f, 0.7f};
    set.spheres.y = {-0.25f, 0.0f, 0.0f};
    set.spheres.z = {1.0f, 1.0f, 1.0f};
    set.spheres.radius = {0.0625f, 0.0625f, 0.125f};
    set.spheres.source = {0, 1, 2};
    set.spheres.fixture = {2, 2, 2};
    return set;
}

std::vector<Shape> someShapes() {
    Shape box, axis;
    box.kind = ShapeKind::Box;
    box.keepIn = true;
    box.size = {0.5, 0.6, 0.7};
    box.baseTshape.position = {0.1, 0.2, 0.3};
    box.fixture = 4;
    axis.kind = ShapeKind::Axis;
    axis.fixture = 5;
    return {box, axis};
}

} // namespace

FedRun::FedRun(const std::string& request, const std::vector<Ros2Joint>& joints)
    : output_(
          openRos2Output(parseRos2OutputRequest(request + ",domain=" + std::to_string(testDomain())), joints))
    , set_(someSet()) {
    row_.record = someRecord();
    output_->setShapes(someShapes());
    thread_ = std::thread([this] { feed(); });
}

FedRun::~FedRun() {
    stop_ = true;
    thread_.join();
}

void FedRun::change(const std::function<void(TickRow&)>& how) {
    const std::lock_guard lock(mutex_);
    how(row_);
}

void FedRun::each(const std::function<void(TickRow&)>& how) {
    const std::lock_guard lock(mutex_);
    each_ = how;
}

void FedRun::feed() {
    output_->frame(set_);
    for (uint64_t i = 0; !stop_; ++i) {
        i = restart_.exchange(false) ? 0 : i;
        TickRow row;
        {
            const std::lock_guard lock(mutex_);
            row = row_;
            row.record.t = 1e-3 * static_cast<double>(i);
            if (each_) {
                each_(row);
            }
        }
        output_->step(row);
        t_ = row.record.t;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}
