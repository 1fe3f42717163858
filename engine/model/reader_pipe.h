// SPDX-License-Identifier: Apache-2.0
// The bytes between this process and the program fathom-reader, which share a machine and a version.
#pragma once

#include "engine/types/clock.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace fathom {

// First bytes of every answer; change the number with the layout of any answer.
inline constexpr std::string_view kReaderMark = "fathom 1";

// Writes everything, in as many calls as needed; false when the other end is closed.
bool writeAll(int pipe, const void* data, size_t size);
// A length-prefixed text, cut after 4 KiB.
bool writeText(int pipe, const std::string& text);

// The reading end. Every call returns false once the pipe has ended, broken a bound or outlived its time.
class ReaderPipe {
public:
    using Time = Clock::time_point;

    ReaderPipe(int pipe, Time until)
        : pipe_(pipe)
        , until_(until) {}
    bool read(void* data, size_t size);
    bool readText(std::string& text); // as writeText() writes it
    bool ended() const { return ended_; }
    bool late() const { return late_; }

private:
    bool await();

    int pipe_;
    Time until_;
    bool ended_ = false, late_ = false;
};

} // namespace fathom
