// SPDX-License-Identifier: Apache-2.0
#include "apps/binding/view_publisher.h"

#include "engine/types/error.h"

#include <algorithm>
#include <array>
#include <iterator>

namespace fathom {

namespace {

void copy(const dvec3& from, double (&to)[3]) noexcept {
    std::copy_n(std::array{from.x, from.y, from.z}.data(), 3, to);
}

void copy(const dquat& from, double (&to)[4]) noexcept {
    std::copy_n(std::array{from.w, from.x, from.y, from.z}.data(), 4, to);
}

fathom_door_fixture rowOf(const GuidancePose& pose) {
    fathom_door_fixture row{};
    row.fixture = pose.fixture;
    row.kind = FATHOM_DOOR_TARGET;
    row.flags = pose.present ? FATHOM_DOOR_SEEN : 0u;
    row.points = pose.count;
    copy(pose.target.position, row.base_T_position);
    copy(pose.target.rotation, row.base_T_orientation);
    return row;
}

uint32_t kindOf(ShapeKind kind) {
    switch (kind) {
    case ShapeKind::Sphere:
        return FATHOM_DOOR_SPHERE;
    case ShapeKind::Box:
        return FATHOM_DOOR_BOX;
    case ShapeKind::Plane:
        return FATHOM_DOOR_PLANE;
    case ShapeKind::Cylinder:
        return FATHOM_DOOR_CYLINDER;
    case ShapeKind::Line:
        return FATHOM_DOOR_LINE;
    case ShapeKind::Axis:
        return FATHOM_DOOR_AXIS;
    case ShapeKind::None:
        break;
    }
    throw Error("a point class is not a shape");
}

fathom_door_fixture rowOf(const Shape& shape) {
    fathom_door_fixture row{};
    row.fixture = shape.fixture;
    row.kind = kindOf(shape.kind);
    row.flags = shape.keepIn ? FATHOM_DOOR_KEEP_IN : 0u;
    copy(shape.baseTshape.position, row.base_T_position);
    copy(shape.baseTshape.rotation, row.base_T_orientation);
    copy(shape.size, row.size);
    return row;
}

} // namespace

void ViewPublisher::step(const TickRow& row) {
    if (ticks_++ % kPollEvery == 0) {
        const bool newcomer = endpoint_.poll();
        if (newcomer) {
            sendRegions();
        }
        if (newcomer || shapesDiffer()) {
            sendFixtures();
        }
    }
    if (!endpoint_.watched()) {
        return;
    }
    const StepRecord& r = row.record;
    state_.t = r.t;
    copy(r.device.position, state_.base_T_hand_position);
    copy(r.device.rotation, state_.base_T_hand_orientation);
    copy(r.tool.position, state_.base_T_tool_position);
    copy(r.tool.rotation, state_.base_T_tool_orientation);
    copy(r.wrench.force, state_.force);
    copy(r.wrench.torque, state_.torque);
    state_.min_gap = r.minGap;
    state_.scene_age = r.sceneAge;
    state_.guidance = r.guidance;
    state_.frame = r.frame;
    state_.generation = row.generation;
    state_.contacts = r.contactCount;
    state_.state = static_cast<uint32_t>(r.state);
    endpoint_.send(state_);
}

void ViewPublisher::frame(const HostFixtures& set) {
    set_ = &set;
    if (set.generation != sent_) {
        sendRegions();
        sendFixtures();
    }
}

void ViewPublisher::setShapes(std::span<const Shape> shapes) {
    const std::lock_guard lock(mutex_);
    shapes_.assign(shapes.begin(), shapes.end());
    shapesChanged_ = true;
}

bool ViewPublisher::shapesDiffer() {
    const std::lock_guard lock(mutex_);
    return shapesChanged_;
}

void ViewPublisher::sendRegions() noexcept {
    if (set_ == nullptr || !endpoint_.watched()) {
        return;
    }
    const RegionSpheres& spheres = set_->spheres;
    regions_.frame = set_->frame;
    regions_.generation = sent_ = set_->generation;
    copy(set_->origin, regions_.origin);
    regions_.total = static_cast<uint32_t>(spheres.size());
    regions_.first = 0;
    do { // also send an empty set
        regions_.count = std::min<uint32_t>(FATHOM_DOOR_SPHERES, regions_.total - regions_.first);
        for (uint32_t i = 0; i < regions_.count; ++i) {
            const size_t at = regions_.first + i;
            regions_.spheres[i] = {spheres.x[at], spheres.y[at], spheres.z[at], spheres.radius[at],
                                   spheres.fixture[at]};
        }
        endpoint_.send(regions_);
        regions_.first += regions_.count;
    } while (regions_.first < regions_.total);
}

void ViewPublisher::sendFixtures() {
    rows_.clear();
    {
        const std::lock_guard lock(mutex_);
        std::transform(shapes_.begin(), shapes_.end(), std::back_inserter(rows_),
                       [](const Shape& shape) { return rowOf(shape); });
        shapesChanged_ = false;
    }
    if (set_ != nullptr) {
        std::transform(set_->guidance.begin(), set_->guidance.end(), std::back_inserter(rows_),
                       [](const GuidancePose& pose) { return rowOf(pose); });
        fixtures_.frame = set_->frame;
        fixtures_.generation = set_->generation;
    }
    fixtures_.total = static_cast<uint32_t>(rows_.size());
    fixtures_.first = 0;
    do { // also send when there is none
        fixtures_.count = std::min<uint32_t>(FATHOM_DOOR_ROWS, fixtures_.total - fixtures_.first);
        std::copy_n(rows_.begin() + fixtures_.first, fixtures_.count, fixtures_.rows);
        endpoint_.send(fixtures_);
        fixtures_.first += fixtures_.count;
    } while (fixtures_.first < fixtures_.total);
}

} // namespace fathom
