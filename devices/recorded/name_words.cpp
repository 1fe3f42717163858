// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/name_words.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace fathom {

std::vector<std::string> nameWords(std::string_view name) {
    std::vector<std::string> words;
    bool inWord = false, small = false; // the last character
    for (const char c : name) {
        const auto byte = static_cast<unsigned char>(c);
        const bool letter = std::isalnum(byte) != 0, camel = small && std::isupper(byte) != 0;
        if (letter && (!inWord || camel)) {
            words.emplace_back();
        }
        if (letter) {
            words.back() += static_cast<char>(std::tolower(byte));
        }
        inWord = letter;
        small = std::islower(byte) != 0 || std::isdigit(byte) != 0;
    }
    return words;
}

bool containsAny(std::string_view text, std::span<const std::string_view> parts) {
    return std::ranges::any_of(
        parts, [&](std::string_view part) { return text.find(part) != std::string_view::npos; });
}

bool nameOtherThing(const std::vector<std::string>& words) {
    constexpr std::array<std::string_view, 35> kThings{
        "object", "objects",  "obj",    "hand",   "hands", "human",   "person",  "body",     "joint",
        "joints", "tool",     "tcp",    "ee",     "eef",   "gripper", "device",  "marker",   "markers",
        "tag",    "tags",     "goal",   "target", "cmd",   "command", "desired", "setpoint", "initialpose",
        "face",   "skeleton", "fathom", "box",    "boxes", "bbox",    "asset",   "assets"};
    return std::ranges::any_of(words, [&](const std::string& word) { // "object2" as "object"
        const std::string_view plain(word.data(), word.find_last_not_of("0123456789") + 1);
        return std::ranges::find(kThings, plain) != kThings.end();
    });
}

} // namespace fathom
