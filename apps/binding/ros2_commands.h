// SPDX-License-Identifier: Apache-2.0
// Topics of ROS 2 by which others ask for something: PREFIX/forces_off (std_msgs/msg/Empty), PREFIX/guidance
// and PREFIX/freeze (std_msgs/msg/Bool).
#pragma once

#include "apps/binding/remote_requests.h"
#include "devices/ros2/ros2_graph.h"

#include <mutex>
#include <string>

namespace fathom {

// One thread, except take().
class Ros2Commands {
public:
    // Throws Error.
    Ros2Commands(std::shared_ptr<Ros2Graph> graph, const std::string& prefix);

    // Reads what has come. An unusable message is skipped; the first one is logged.
    void receive();
    // Any thread.
    RemoteRequests take();

private:
    std::optional<bool> newest(size_t topic, const char* name);

    Ros2Inbox inbox_;
    size_t forcesOff_, guidance_, freeze_;
    bool logged_ = false;
    std::mutex mutex_; // guards the requests
    RemoteRequests requests_;
};

} // namespace fathom
