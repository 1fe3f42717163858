// SPDX-License-Identifier: Apache-2.0
#include "devices/ros2/ros2_request.h"

#include "devices/recorded/text_file.h"
#include "devices/ros2/open_ros2.h"
#include "engine/types/error.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>

namespace fathom {

namespace {

constexpr std::string_view kRos2Prefix = "ros2:";
constexpr uint32_t kMostDomain = 232; // its ports are below 65536

uint32_t domainOf(const std::string& where, const std::string& field, const std::string& text) {
    uint32_t domain = 0;
    if (!parseNumber(std::string_view(text), domain) || domain > kMostDomain) {
        throw BadInput(where, field, text, "0 to " + std::to_string(kMostDomain));
    }
    return domain;
}

std::string networkOf(const std::string& name) {
    const auto fits = [](unsigned char c) {
        return std::isalnum(c) != 0 ||
               std::string_view("_.-:@").find(static_cast<char>(c)) != std::string_view::npos;
    };
    constexpr size_t kLongest = 15; // IFNAMSIZ without its terminator
    if (name.empty() || name.size() > kLongest || !std::all_of(name.begin(), name.end(), fits)) {
        throw BadInput("--source", "network", name, "lo, any, or the name of a network interface");
    }
    return name;
}

double waitOf(const std::string& text) {
    double seconds = 0.0;
    if (!parseNumber(std::string_view(text), seconds) || !(seconds > 0.0 && seconds <= 3600.0)) {
        throw BadInput("--source", "wait", text, "a number above 0, at most 3600 [s]");
    }
    return seconds;
}

// Takes what recordings do not have out of the words; returns the rest.
std::string takeOwn(const std::string& text, Ros2Request& request) {
    std::string rest;
    for (size_t at = 0; at <= text.size();) {
        const size_t end = std::min(text.find(',', at), text.size());
        const std::string word = text.substr(at, end - at), name = word.substr(0, word.find('=')),
                          value = word.substr(std::min(word.size(), name.size() + 1));
        if (name == "domain") {
            request.place.domain = domainOf("--source", name, value);
        } else if (name == "network") {
            request.place.network = networkOf(value);
        } else if (name == "wait") {
            request.wait = waitOf(value);
        } else {
            rest += "," + word;
        }
        at = end + 1;
    }
    return rest;
}

} // namespace

uint32_t ros2Domain() {
    const char* given = std::getenv("ROS_DOMAIN_ID");
    return given == nullptr || *given == '\0' ? 0 : domainOf("environment", "ROS_DOMAIN_ID", given);
}

std::string ros2Topic(const std::string& field, const std::string& name) {
    const std::string full = name.starts_with('/') ? name : "/" + name;
    const auto fits = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '/'; };
    if (full.size() < 2 || full.size() > 200 || full.back() == '/' || full.find("//") != std::string::npos ||
        !std::all_of(full.begin(), full.end(), fits)) {
        throw BadInput("--source", field, name, std::string("a topic's full name; ") + Ros2Request::kAllowed);
    }
    return full;
}

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
        throw BadInput("--source", "ros2", text, Ros2Request::kAllowed);
    }
    if (options.start != 0.0 || std::isfinite(options.duration)) {
        throw BadInput("--source", "start, duration", text, "neither: topics have no beginning");
    }
    options.depth = ros2Topic("depth", options.depth);
    options.colour = options.colour.empty() ? "none" : options.colour;
    options.colour = options.colour == "none" ? "none" : ros2Topic("colour", options.colour);
    options.info = options.info.empty() ? "" : ros2Topic("info", options.info);
    options.checkMetres(text); // that of 16-bit depth is stricter, and checked once the encoding is known
    return request;
}

bool isRos2Request(const std::string& source) {
    return source.starts_with(kRos2Prefix) || source == "ros2";
}

} // namespace fathom
