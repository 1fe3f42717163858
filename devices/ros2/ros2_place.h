// SPDX-License-Identifier: Apache-2.0
// Where a ROS 2 graph is, and the words of requests: "FIRST,NAME=VALUE,NAME=VALUE".
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fathom {

// Where a ROS 2 graph is.
struct Ros2Place {
    uint32_t domain = 0; // 0 to 232
    // An interface's name, e.g. "eth0". "lo" is this machine only. "any": as CYCLONEDDS_URI or Cyclone
    // choose.
    std::string network = "lo";

    bool operator==(const Ros2Place&) const = default;
};

// One word of a request.
struct Ros2Word {
    std::string text, name, value; // "wait=2": name "wait", value "2"
};

// Most of wait=.
inline constexpr double kLongestRos2Wait = 3600.0; // [s]

// All words; the text has no escapes.
std::vector<Ros2Word> ros2Words(const std::string& text);

// The domain that the environment variable ROS_DOMAIN_ID gives, else 0. Throws BadInput.
uint32_t ros2Domain();

// Takes domain= and network= into `place`; false when the word is another one. option: for messages, e.g.
// "--source". Throws BadInput.
bool takePlace(const std::string& option, const Ros2Word& word, Ros2Place& place);

// The value as a number above 0. unit: "s". Throws BadInput for any other text or a larger number.
double ros2Number(const std::string& option, const Ros2Word& word, double most, const std::string& unit);

// "/camera/depth/image_raw" and the like. A leading slash is added where there is none. allowed: the form of
// the option. Throws BadInput.
std::string ros2Topic(const std::string& option, const Ros2Word& word, const std::string& allowed);

// Takes the word into the topic of its name; false when it has none of these names. Throws as ros2Topic().
bool takeTopic(const std::string& option, const Ros2Word& word, const std::string& allowed,
               std::initializer_list<std::pair<std::string_view, std::string*>> topics);

// The value as the name of a frame, e.g. "base_link". Throws BadInput.
std::string ros2Frame(const std::string& option, const Ros2Word& word);

} // namespace fathom
