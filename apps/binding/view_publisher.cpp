// SPDX-License-Identifier: Apache-2.0
#include "apps/binding/view_publisher.h"

#include <algorithm>
#include <array>

namespace fathom {

namespace {

void copy(const dvec3& from, double (&to)[3]) noexcept {
    std::copy_n(std::array{from.x, from.y, from.z}.data(), 3, to);
}

void copy(const dquat& from, double (&to)[4]) noexcept {
    std::copy_n(std::array{from.w, from.x, from.y, from.z}.data(), 4, to);
}

} // namespace

void ViewPublisher::turn(const TurnRow& row) noexcept {
    if (turns_++ % kPollEvery == 0 && door_.poll()) {
        tellRegions();
    }
    if (!door_.watched()) {
        return;
    }
    const TurnRecord& r = row.record;
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
    state_.contacts = r.contacts;
    state_.state = static_cast<uint32_t>(r.state);
    door_.send(state_);
}

void ViewPublisher::frame(const Fixtures& set) noexcept {
    set_ = &set;
    if (set.generation != told_) {
        tellRegions();
    }
}

void ViewPublisher::tellRegions() noexcept {
    if (set_ == nullptr || !door_.watched()) {
        return;
    }
    const RegionSpheres& spheres = set_->spheres;
    regions_.frame = set_->frame;
    regions_.generation = told_ = set_->generation;
    copy(set_->origin, regions_.origin);
    regions_.total = static_cast<uint32_t>(spheres.size());
    regions_.first = 0;
    do { // an empty set is told, too
        regions_.count = std::min<uint32_t>(FATHOM_DOOR_SPHERES, regions_.total - regions_.first);
        for (uint32_t i = 0; i < regions_.count; ++i) {
            const size_t at = regions_.first + i;
            regions_.spheres[i] = {spheres.x[at], spheres.y[at], spheres.z[at], spheres.radius[at],
                                   spheres.fixture[at]};
        }
        door_.send(regions_);
        regions_.first += regions_.count;
    } while (regions_.first < regions_.total);
}

} // namespace fathom
