// SPDX-License-Identifier: Apache-2.0
// Topics and services of ROS 2 by which others ask for something: PREFIX/forces_off (std_msgs/msg/Empty,
// std_srvs/srv/Trigger), PREFIX/guidance and PREFIX/freeze (std_msgs/msg/Bool, std_srvs/srv/SetBool).
#pragma once

#include "apps/binding/remote_requests.h"
#include "devices/ros2/ros2_graph.h"
#include "devices/ros2/ros2_service.h"

#include <mutex>
#include <string>

namespace fathom {

// One thread, except take().
class Ros2Commands {
public:
    // Throws Error.
    Ros2Commands(std::shared_ptr<Ros2Graph> graph, const std::string& prefix);

    // Reads what has come, and answers calls. An unusable message is skipped; the first one is logged.
    void receive();
    // Any thread.
    RemoteRequests take();

private:
    std::optional<bool> newest(size_t topic, const char* name);
    void receiveTopics();
    void serve();

    Ros2Inbox inbox_;
    size_t forcesOff_, guidance_, freeze_; // topics
    Ros2Service forcesOffCall_, guidanceCall_, freezeCall_;
    bool logged_ = false;
    std::mutex mutex_; // guards the requests
    RemoteRequests requests_;
};

} // namespace fathom
