// SPDX-License-Identifier: Apache-2.0
// A subscriber of one topic (tests/ros2_listener), and the lines that it prints.
#pragma once

#include "tests/ros2/peer.h"

#include <functional>
#include <string>
#include <vector>

// A message: its stamp [s], then words. Empty: there was none.
class Line {
public:
    explicit Line(const std::string& text = "");

    bool any() const { return !text_.empty(); }
    double stamp() const { return number(0); }
    double number(size_t word) const;
    // Whether what follows the stamp is this.
    bool is(const std::string& rest) const;
    bool holds(const std::string& part) const { return text_.find(part) != std::string::npos; }
    // `count` words from that one on.
    std::string words(size_t first, size_t count) const;

private:
    std::string text_;
    std::vector<std::string> words_;
};

class TopicListener {
public:
    // type: without its package. Returns when it listens.
    TopicListener(const std::string& topic, const std::string& type,
                  const std::string& program = ROS2_LISTENER);

    Line next();
    // The next message for which it holds, within a minute.
    Line until(const std::function<bool(const Line&)>& holds);
    // Whether a message came within a second.
    bool waiting() { return peer_.line(std::chrono::seconds(1)).has_value(); }
    void stop() { peer_.stop(); }

private:
    Peer peer_;
};

double utcNow(); // [s]
