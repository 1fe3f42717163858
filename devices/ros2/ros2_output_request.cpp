// SPDX-License-Identifier: Apache-2.0
#include "devices/ros2/ros2_output_request.h"

#include "engine/types/error.h"

namespace fathom {

namespace {

constexpr const char* kOutputOption = "--ros2";

bool takeRobot(const Ros2Word& word, Ros2OutputRequest& request) {
    return takeTopic(
        kOutputOption, word, Ros2OutputRequest::kAllowed,
        {{"twist", &request.twist}, {"trajectory", &request.trajectory}, {"measured", &request.measured}});
}

} // namespace

Ros2OutputRequest parseRos2OutputRequest(const std::string& text) {
    Ros2OutputRequest request;
    request.place.domain = ros2Domain();
    const std::vector<Ros2Word> words = ros2Words(text);
    request.prefix = ros2Topic(kOutputOption, {"", "PREFIX", words.front().text}, request.kAllowed);
    for (size_t i = 1; i < words.size(); ++i) {
        const Ros2Word& word = words[i];
        if (word.name == "frame") {
            request.frame = ros2Frame(kOutputOption, word);
        } else if (word.name == "rate") {
            request.rate = ros2Number(kOutputOption, word, request.kMaxRate, "1/s");
        } else if (word.text == "commands=on") {
            request.commands = true;
        } else if (word.text == "tf=on") {
            request.frames = true;
        } else if (takeRobot(word, request)) {
            continue;
        } else if (!takePlace(kOutputOption, word, request.place)) {
            throw BadInput(kOutputOption, word.name, word.value, request.kAllowed);
        }
    }
    if (request.trajectory.empty() != request.measured.empty()) {
        throw BadInput(kOutputOption, "trajectory, measured", text, "both or neither");
    }
    return request;
}

} // namespace fathom
