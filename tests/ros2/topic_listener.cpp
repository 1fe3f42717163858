// SPDX-License-Identifier: Apache-2.0
#include "tests/ros2/topic_listener.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <doctest/doctest.h>
#include <sstream>

Line::Line(const std::string& text)
    : text_(text) {
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        words_.push_back(word);
    }
}

double Line::number(size_t word) const {
    return word < words_.size() ? std::strtod(words_[word].c_str(), nullptr) : std::nan("");
}

std::string Line::words(size_t first, size_t count) const {
    std::string text;
    for (size_t i = first; i < std::min(words_.size(), first + count); ++i) {
        text += (text.empty() ? "" : " ") + words_[i];
    }
    return text;
}

bool Line::is(const std::string& rest) const {
    const bool same = words(1, words_.size()) == rest;
    if (!same) {
        MESSAGE("heard: " << text_);
    }
    return same;
}

TopicListener::TopicListener(const std::string& topic, const std::string& type, const std::string& program)
    : peer_(program, {std::to_string(testDomain()), topic, type}) {
    REQUIRE(peer_.line() == "ready");
}

Line TopicListener::next() {
    return Line(peer_.line().value_or(""));
}

Line TopicListener::until(const std::function<bool(const Line&)>& holds) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (std::chrono::steady_clock::now() < end) {
        if (const Line line = next(); line.any() && holds(line)) {
            return line;
        }
    }
    return Line();
}

double utcNow() {
    return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}
