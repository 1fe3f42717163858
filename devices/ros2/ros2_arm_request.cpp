// SPDX-License-Identifier: Apache-2.0
#include "devices/ros2/ros2_arm_request.h"

#include "engine/types/error.h"

namespace fathom {

namespace {

constexpr std::string_view kArmPrefix = "ros2:";
constexpr const char* kArmOption = "--arm";

} // namespace

bool isRos2Arm(const std::string& text) {
    return text.starts_with(kArmPrefix) || text == "ros2";
}

Ros2ArmRequest parseRos2ArmRequest(const std::string& text) {
    Ros2ArmRequest request;
    request.place.domain = ros2Domain();
    for (const Ros2Word& word : ros2Words(text.substr(std::min(text.size(), kArmPrefix.size())))) {
        if (word.name == "joints") {
            request.joints = ros2Topic(kArmOption, word, Ros2ArmRequest::kAllowed);
        } else if (word.name == "wait") {
            request.wait = ros2Number(kArmOption, word, kLongestRos2Wait, "s");
        } else if (!takePlace(kArmOption, word, request.place)) {
            throw BadInput(kArmOption, "ros2", text, Ros2ArmRequest::kAllowed);
        }
    }
    if (request.joints.empty()) {
        throw BadInput(kArmOption, "ros2", text, Ros2ArmRequest::kAllowed);
    }
    return request;
}

} // namespace fathom
