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

// Copies of the head, with the share of each; one also when there is nothing to send.
template <class T>
ViewSocket::List<T> inParts(const T& head, uint32_t most) {
    const uint32_t parts = std::max(1u, (head.total + most - 1) / most);
    auto list = std::make_shared<std::vector<T>>(parts, head);
    for (uint32_t i = 0; i < parts; ++i) {
        T& part = (*list)[i];
        part.first = i * most;
        part.count = std::min(most, head.total - part.first);
    }
    return list;
}

} // namespace

void ViewPublisher::step(const TickRow& row) {
    if (ticks_++ % kPollEvery == 0) {
        endpoint_.poll();
        offerUpdates();
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
    offerUpdates();
}

void ViewPublisher::forget() noexcept {
    set_ = nullptr;
    offered_ = 0;
    endpoint_.offer(ViewSocket::List<fathom_door_regions>());
}

void ViewPublisher::offerUpdates() {
    if (!endpoint_.watched()) {
        return;
    }
    const bool newSet = set_ != nullptr && set_->generation != offered_;
    if (newSet) {
        offerRegions();
        offered_ = set_->generation;
    }
    if (newSet || newestShapes_.changed()) {
        offerFixtures();
    }
}

void ViewPublisher::offerRegions() {
    const RegionSpheres& spheres = set_->spheres;
    fathom_door_regions head{};
    head.frame = set_->frame;
    head.generation = set_->generation;
    copy(set_->origin, head.origin);
    head.total = static_cast<uint32_t>(spheres.size());
    const auto parts = inParts(head, FATHOM_DOOR_SPHERES);
    for (fathom_door_regions& part : *parts) {
        for (uint32_t i = 0; i < part.count; ++i) {
            const size_t at = part.first + i;
            part.spheres[i] = {spheres.x[at], spheres.y[at], spheres.z[at], spheres.radius[at],
                               spheres.fixture[at]};
        }
    }
    endpoint_.offer(parts);
}

void ViewPublisher::offerFixtures() {
    rows_.clear();
    newestShapes_.copyTo(shapes_);
    std::transform(shapes_.begin(), shapes_.end(), std::back_inserter(rows_),
                   [](const Shape& shape) { return rowOf(shape); });
    fathom_door_fixtures head{};
    if (set_ != nullptr) {
        std::transform(set_->guidance.begin(), set_->guidance.end(), std::back_inserter(rows_),
                       [](const GuidancePose& pose) { return rowOf(pose); });
        head.frame = set_->frame;
        head.generation = set_->generation;
    }
    head.total = static_cast<uint32_t>(rows_.size());
    const auto parts = inParts(head, FATHOM_DOOR_ROWS);
    for (fathom_door_fixtures& part : *parts) {
        std::copy_n(rows_.begin() + part.first, part.count, part.rows);
    }
    endpoint_.offer(parts);
}

} // namespace fathom
