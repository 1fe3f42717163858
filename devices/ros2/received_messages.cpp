// SPDX-License-Identifier: Apache-2.0
#include "devices/ros2/received_messages.h"

#include "devices/bag/message_cursor.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace fathom::ros2 {

namespace {

// Skips the stamp, which the arrival replaces, and returns the frame's name.
std::string frameIn(MessageCursor& cursor) {
    cursor.word();
    cursor.word();
    return cursor.name();
}

uint32_t countIn(MessageCursor& cursor, const char* what, uint32_t most) {
    const uint32_t count = cursor.word();
    if (count > most) {
        throw Error(std::to_string(count) + " " + what + " (allowed: at most " + std::to_string(most) + ")");
    }
    return count;
}

} // namespace

HandPose handPose(std::span<const uint8_t> message) {
    MessageCursor cursor(message, true);
    HandPose hand;
    hand.frame = frameIn(cursor);
    dvec3& p = hand.pose.position;
    for (double* number : {&p.x, &p.y, &p.z}) {
        *number = cursor.real();
    }
    dquat& q = hand.pose.rotation;
    for (double* number : {&q.x, &q.y, &q.z, &q.w}) {
        *number = cursor.real();
    }
    if (!isFinite(hand.pose) || glm::length(p) > kFarthestHand) {
        throw Error("a position or rotation that is not finite, zero, or over 10 m away");
    }
    if (std::abs(glm::length(q) - 1.0) > kUnitSlack) {
        throw Error("a rotation that is not of unit length");
    }
    q = glm::normalize(q);
    return hand;
}

std::vector<bool> joyButtons(std::span<const uint8_t> message) {
    MessageCursor cursor(message, true);
    frameIn(cursor);
    for (uint32_t left = countIn(cursor, "axes", kMaxJoy); left > 0; --left) {
        cursor.value<float>();
    }
    std::vector<bool> buttons(countIn(cursor, "buttons", kMaxJoy));
    for (size_t i = 0; i < buttons.size(); ++i) {
        buttons[i] = cursor.value<int32_t>() != 0;
    }
    return buttons;
}

std::vector<std::pair<std::string, double>> jointPositions(std::span<const uint8_t> message) {
    MessageCursor cursor(message, true);
    frameIn(cursor);
    std::vector<std::pair<std::string, double>> joints(countIn(cursor, "joints", kMaxJoints));
    for (auto& joint : joints) {
        joint.first = cursor.name();
    }
    if (countIn(cursor, "positions", kMaxJoints) != joints.size()) {
        throw Error("another number of positions than of names");
    }
    for (auto& joint : joints) {
        joint.second = cursor.real();
        if (!std::isfinite(joint.second)) {
            throw Error("position of " + joint.first + " is not finite");
        }
    }
    return joints;
}

} // namespace fathom::ros2
