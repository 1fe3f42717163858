// SPDX-License-Identifier: Apache-2.0
// Starts and drives tests/ros2_talker, a camera driver in a process of its own.
#pragma once

#include "devices/ros2/ros2_request.h"

#include <cstdint>
#include <string>
#include <sys/types.h>

// In the domain of testDomain().
class Talker {
public:
    Talker();
    ~Talker(); // kills it
    Talker(const Talker&) = delete;
    Talker& operator=(const Talker&) = delete;

    // Changes one of its settings; returns when it obeys.
    void set(const std::string& key, double value);

private:
    void send(const std::string& line) const;
    void awaitOk();

    pid_t process_ = 0;
    int in_ = -1, out_ = -1;
};

// A domain that this process holds until it ends, so that test programs that run at once do not meet.
uint32_t testDomain();

// A request for the talker's camera; `more` begins with a comma.
fathom::Ros2Request requestCamera(const std::string& more = "");
