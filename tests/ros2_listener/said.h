// SPDX-License-Identifier: Apache-2.0
// One message of ROS 2 as a line of words: "SECONDS FRAME NUMBER...". The listeners of two DDS
// implementations write the same lines.
#pragma once

#include <cstdint>
#include <cstdio>
#include <poll.h>
#include <string>
#include <unistd.h>

// Whether the test has closed this program's input.
inline bool inputEnded() {
    pollfd in{STDIN_FILENO, POLLIN, 0};
    char byte = 0;
    return ::poll(&in, 1, 0) > 0 && ::read(STDIN_FILENO, &byte, 1) <= 0;
}

// Builds and prints a line.
class Said {
public:
    Said& number(double value) {
        char text[32];
        std::snprintf(text, sizeof text, "%.9g", value);
        return word(text);
    }
    Said& word(const std::string& text) {
        line_ += (line_.empty() ? "" : " ") + (text.empty() ? std::string("-") : text);
        return *this;
    }
    Said& stamp(int32_t seconds, uint32_t nanoseconds) {
        char text[32];
        std::snprintf(text, sizeof text, "%d.%09u", seconds, nanoseconds);
        return word(text);
    }
    void print() const {
        std::printf("%s\n", line_.c_str());
        std::fflush(stdout);
    }

private:
    std::string line_;
};
