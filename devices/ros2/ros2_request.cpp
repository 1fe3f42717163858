// SPDX-License-Identifier: Apache-2.0
#include "devices/ros2/ros2_request.h"

#include "devices/ros2/open_ros2.h"
#include "engine/types/error.h"

#include <cmath>

namespace fathom {

namespace {

constexpr std::string_view kRos2Prefix = "ros2:";
constexpr const char* kCameraOption = "--source";

// Takes what recordings do not have out of the words; returns the rest.
std::string takeOwn(const std::string& text, Ros2Request& request) {
    std::string rest;
    for (const Ros2Word& word : ros2Words(text)) {
        if (word.name == "wait") {
            request.wait = ros2Number(kCameraOption, word, kLongestRos2Wait, "s");
        } else if (word.name == "frame") {
            request.frame = ros2Frame(kCameraOption, word);
        } else if (!takePlace(kCameraOption, word, request.place)) {
            rest += "," + word.text;
        }
    }
    return rest;
}

std::string topicOf(const std::string& field, const std::string& topic) {
    return ros2Topic(kCameraOption, {"", field, topic}, Ros2Request::kAllowed);
}

} // namespace

Ros2Request parseRos2Request(const std::string& text) {
    Ros2Request request;
    request.text = text;
    request.place.domain = ros2Domain();
    const std::string words =
        takeOwn(text.starts_with(kRos2Prefix) ? text.substr(kRos2Prefix.size()) : text, request);
    const SourceRequest source = parseSource("ros2" + words);
    request.options = source.options;
    SourceOptions& options = request.options;
    if (source.file != "ros2" || options.depth.empty()) {
        throw BadInput(kCameraOption, "ros2", text, Ros2Request::kAllowed);
    }
    if (options.start != 0.0 || std::isfinite(options.duration)) {
        throw BadInput(kCameraOption, "start, duration", text, "neither: topics have no beginning");
    }
    options.depth = topicOf("depth", options.depth);
    options.colour = options.colour.empty() ? "none" : options.colour;
    options.colour = options.colour == "none" ? "none" : topicOf("colour", options.colour);
    options.info = options.info.empty() ? "" : topicOf("info", options.info);
    options.checkMetres(text); // that of 16-bit depth is stricter, and checked once the encoding is known
    return request;
}

bool isRos2Request(const std::string& source) {
    return source.starts_with(kRos2Prefix) || source == "ros2";
}

} // namespace fathom
