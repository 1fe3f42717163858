// SPDX-License-Identifier: Apache-2.0
#include "devices/ros2/ros2_place.h"

#include "devices/recorded/text_file.h"
#include "engine/types/error.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>

namespace fathom {

namespace {

constexpr uint32_t kMaxDomain = 232; // its ports are below 65536

uint32_t domainOf(const std::string& where, const std::string& field, const std::string& text) {
    uint32_t domain = 0;
    if (!parseNumber(std::string_view(text), domain) || domain > kMaxDomain) {
        throw BadInput(where, field, text, "0 to " + std::to_string(kMaxDomain));
    }
    return domain;
}

std::string networkOf(const std::string& option, const std::string& name) {
    const auto fits = [](unsigned char c) {
        return std::isalnum(c) != 0 ||
               std::string_view("_.-:@").find(static_cast<char>(c)) != std::string_view::npos;
    };
    constexpr size_t kLongest = 15; // IFNAMSIZ without its terminator
    if (name.empty() || name.size() > kLongest || !std::all_of(name.begin(), name.end(), fits)) {
        throw BadInput(option, "network", name, "lo, any, or the name of a network interface");
    }
    return name;
}

} // namespace

std::vector<Ros2Word> ros2Words(const std::string& text) {
    std::vector<Ros2Word> words;
    for (size_t at = 0; at <= text.size();) {
        const size_t end = std::min(text.find(',', at), text.size());
        Ros2Word word{text.substr(at, end - at), "", ""};
        word.name = word.text.substr(0, word.text.find('='));
        word.value = word.text.substr(std::min(word.text.size(), word.name.size() + 1));
        words.push_back(std::move(word));
        at = end + 1;
    }
    return words;
}

uint32_t ros2Domain() {
    const char* given = std::getenv("ROS_DOMAIN_ID");
    return given == nullptr || *given == '\0' ? 0 : domainOf("environment", "ROS_DOMAIN_ID", given);
}

bool takePlace(const std::string& option, const Ros2Word& word, Ros2Place& place) {
    if (word.name == "domain") {
        place.domain = domainOf(option, word.name, word.value);
    } else if (word.name == "network") {
        place.network = networkOf(option, word.value);
    } else {
        return false;
    }
    return true;
}

double ros2Number(const std::string& option, const Ros2Word& word, double most, const std::string& unit) {
    double number = 0.0;
    if (!parseNumber(std::string_view(word.value), number) || !(number > 0.0 && number <= most)) {
        throw BadInput(option, word.name, word.value,
                       "a number above 0, at most " + std::to_string(static_cast<int>(most)) + " [" + unit +
                           "]");
    }
    return number;
}

std::string ros2Topic(const std::string& option, const Ros2Word& word, const std::string& allowed) {
    const std::string full = word.value.starts_with('/') ? word.value : "/" + word.value;
    const auto fits = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '/'; };
    if (full.size() < 2 || full.size() > 200 || full.back() == '/' || full.find("//") != std::string::npos ||
        !std::all_of(full.begin(), full.end(), fits)) {
        throw BadInput(option, word.name, word.value, "a topic's full name; " + allowed);
    }
    return full;
}

bool takeTopic(const std::string& option, const Ros2Word& word, const std::string& allowed,
               std::initializer_list<std::pair<std::string_view, std::string*>> topics) {
    for (const auto& [name, topic] : topics) {
        if (word.name == name) {
            *topic = ros2Topic(option, word, allowed);
            return true;
        }
    }
    return false;
}

std::string ros2Frame(const std::string& option, const Ros2Word& word) {
    constexpr size_t kLongest = 100;
    const auto fits = [](unsigned char c) {
        return std::isalnum(c) != 0 || c == '_' || c == '/' || c == '-';
    };
    const std::string& name = word.value;
    if (name.empty() || name.size() > kLongest || !std::all_of(name.begin(), name.end(), fits)) {
        throw BadInput(option, word.name, name, "a frame's name of letters, digits, _, - and /");
    }
    return name;
}

} // namespace fathom
