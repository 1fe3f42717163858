// SPDX-License-Identifier: Apache-2.0
#include "engine/model/finger_ends.h"

#include "engine/model/arm_warnings.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <span>

namespace fathom {

namespace {

constexpr double kLeastMotion = 1e-3; // [m] a smaller change of distance decides nothing

// Mean distance of the leaves of a group, which move together, from those of all other fingers; of a group
// without others, from what carries it. Other groups are half closed.
class FingerDistance {
public:
    FingerDistance(const ArmModel& model, std::span<const uint32_t> group)
        : model_(model)
        , group_(group) {
        model.place({}, Pose{}, half_, 0.5);
    }

    // [m] mean distance at this grasp of the group; 0 without pairs.
    double at(double grasp) const {
        ArmFrames frames;
        model_.place({}, Pose{}, frames, grasp);
        double sum = 0.0;
        uint64_t pairs = 0;
        for (size_t a = 0; a < model_.leaves.size(); ++a) {
            if (!inGroup(model_.leaves[a].finger)) {
                continue;
            }
            for (size_t b = 0; b < model_.leaves.size(); ++b) {
                if (!counts(model_.leaves[a], model_.leaves[b])) {
                    continue;
                }
                const ArmFrames& others = inGroup(model_.leaves[b].finger) ? frames : half_;
                sum += glm::distance(model_.centre(frames, a), model_.centre(others, b));
                ++pairs;
            }
        }
        return pairs > 0 ? sum / static_cast<double>(pairs) : 0.0;
    }

private:
    bool inGroup(uint32_t finger) const { // 0 = none
        return finger != 0 && std::ranges::find(group_, finger - 1) != group_.end();
    }
    bool carries(uint32_t below, uint32_t finger) const {
        while (finger != 0 && finger != below) {
            finger = model_.fingers[finger - 1].carrier;
        }
        return finger == below;
    }
    // On another branch, and moved by the grasp.
    bool opposes(uint32_t finger, uint32_t other) const {
        return other != 0 && !model_.fingers[other - 1].mimic && !carries(finger, other) &&
               !carries(other, finger);
    }
    bool alone() const {
        return std::ranges::none_of(model_.leaves, [&](const ArmLeaf& leaf) {
            return std::ranges::any_of(group_, [&](uint32_t f) { return opposes(f + 1, leaf.finger); });
        });
    }
    bool counts(const ArmLeaf& own, const ArmLeaf& other) const {
        return alone_ ? other.finger == model_.fingers[own.finger - 1].carrier && other.joint == own.joint
                      : opposes(own.finger, other.finger);
    }

    const ArmModel& model_;
    std::span<const uint32_t> group_;
    ArmFrames half_;
    bool alone_ = alone();
};

// [m] by how much the fingers of a group come nearer to others when its grasp goes from 0 to 1.
double closingOf(const ArmModel& model, std::span<const uint32_t> group) {
    const FingerDistance distance(model, group);
    return distance.at(0.0) - distance.at(1.0);
}

} // namespace

std::vector<std::string> chooseFingerEnds(ArmModel& model, const ArmOptions& options,
                                          const std::map<std::string, JointTie>& ties) {
    std::map<std::string, std::vector<uint32_t>> groups; // by root
    for (uint32_t f = 0; f < model.fingers.size(); ++f) {
        groups[ties.at(model.fingers[f].name).root].push_back(f);
    }
    std::set<std::string> given; // roots
    for (const ArmOptions::Finger& wanted : options.fingers) {
        if (wanted.open || wanted.closed) {
            given.insert(ties.at(wanted.joint).root);
        }
    }
    std::vector<std::string> notes;
    for (const ArmOptions::Finger& wanted : options.fingers) {
        const auto named = std::ranges::find(model.fingers, wanted.joint, &ArmFinger::name);
        if (named == model.fingers.end() || named->mimic || (wanted.open && wanted.closed)) {
            continue;
        }
        if (wanted.open || wanted.closed) {
            notes.push_back(oneEndWarning(wanted.joint, wanted.open.has_value(), named->open, named->closed));
            continue;
        }
        const std::string& root = ties.at(wanted.joint).root;
        const double closing = given.count(root) == 0 ? closingOf(model, groups[root]) : 0.0;
        for (const uint32_t f : closing < -kLeastMotion ? groups[root] : std::vector<uint32_t>()) {
            std::swap(model.fingers[f].open, model.fingers[f].closed);
        }
        notes.push_back(
            endsWarning(wanted.joint, named->open, named->closed, std::abs(closing) > kLeastMotion));
    }
    return notes;
}

} // namespace fathom
