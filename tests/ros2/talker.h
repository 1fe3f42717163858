// SPDX-License-Identifier: Apache-2.0
// Starts and drives tests/ros2_talker, a camera driver in a process of its own.
#pragma once

#include "devices/ros2/ros2_request.h"
#include "tests/ros2/peer.h"

#include <string>

// In the domain of testDomain().
class Talker {
public:
    Talker();

    // Changes one of its settings; returns when it obeys.
    void set(const std::string& key, double value);

private:
    void awaitOk();

    Peer peer_;
};

// A request for the talker's camera; `more` begins with a comma.
fathom::Ros2Request requestCamera(const std::string& more = "");
