// SPDX-License-Identifier: Apache-2.0
#include "devices/ros2/ros2_hand_request.h"

#include "devices/recorded/text_file.h"
#include "devices/ros2/received_messages.h"
#include "engine/types/error.h"

namespace fathom {

namespace {

constexpr const char* kHandOption = "--topics";

uint32_t buttonOf(const Ros2Word& word) {
    uint32_t button = 0;
    if (!parseNumber(std::string_view(word.value), button) || button >= ros2::kMaxJoy) {
        throw BadInput(kHandOption, word.name, word.value,
                       "a button's number, 0 to " + std::to_string(ros2::kMaxJoy - 1));
    }
    return button;
}

bool takeHandTopic(const Ros2Word& word, Ros2HandRequest& request) {
    return takeTopic(kHandOption, word, Ros2HandRequest::kAllowed,
                     {{"pose", &request.pose}, {"wrench", &request.wrench}, {"joy", &request.joy}});
}

bool takeButton(const Ros2Word& word, Ros2HandRequest& request) {
    if (word.name == "guidance") {
        request.guidance = buttonOf(word);
    } else if (word.name == "clutch") {
        request.clutch = buttonOf(word);
    } else if (word.name == "dead_man") {
        request.deadMan = buttonOf(word);
    } else {
        return false;
    }
    return true;
}

} // namespace

Ros2HandRequest parseRos2HandRequest(const std::string& text) {
    Ros2HandRequest request;
    if (text.empty()) {
        throw BadInput("guard", kHandOption, "missing", request.kAllowed);
    }
    request.place.domain = ros2Domain();
    for (const Ros2Word& word : ros2Words(text)) {
        if (word.name == "preset") {
            request.preset = word.value;
        } else if (!takeHandTopic(word, request) && !takeButton(word, request) &&
                   !takePlace(kHandOption, word, request.place)) {
            throw BadInput(kHandOption, word.name, word.value, request.kAllowed);
        }
    }
    if (request.pose.empty()) {
        throw BadInput(kHandOption, "pose", text, request.kAllowed);
    }
    if (request.deadMan && request.joy.empty()) {
        throw BadInput(kHandOption, "dead_man", std::to_string(*request.deadMan), "together with joy=TOPIC");
    }
    if (request.wrench.empty()) {
        request.wrench = request.pose.substr(0, request.pose.rfind('/')) + "/wrench";
    }
    return request;
}

} // namespace fathom
