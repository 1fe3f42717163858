// SPDX-License-Identifier: Apache-2.0
// A service of a ROS 2 graph, as rmw_cyclonedds maps it to topics of DDS: requests on "rq/NAMERequest",
// replies on "rr/NAMEReply", and both begin with the client's number (8 bytes) and the request's (8 bytes).
// Source: ros2/rmw_cyclonedds, rmw_cyclonedds_cpp/src/rmw_node.cpp at 0033193. rmw_fastrtps has these numbers
// in parameters of RTPS instead, so its clients get no answer.
#pragma once

#include "devices/bag/message_cursor.h"
#include "devices/ros2/ros2_graph.h"

#include <deque>
#include <functional>
#include <string>

namespace fathom {

// std_srvs/srv/SetBool or Trigger. One thread.
class Ros2Service {
public:
    // name: "/fathom/freeze"; type: "std_srvs/srv/SetBool". Requests come through `inbox`, which must outlive
    // this. Throws Error.
    Ros2Service(std::shared_ptr<Ros2Graph> graph, Ros2Inbox& inbox, std::string name,
                const std::string& type);

    // Answers the requests since the last call. obey: reads the request's own values, obeys, and returns the
    // reply's text; it throws Error for an unusable request, which is skipped; the first one is logged.
    void serve(const std::function<std::string(MessageCursor& request)>& obey);

    static constexpr size_t kMaxWaiting = 64; // replies

private:
    struct Reply {
        std::vector<uint8_t> bytes;
        double queuedAt; // [s] CLOCK_MONOTONIC
    };
    void answer(const RawMessage& request, const std::function<std::string(MessageCursor&)>& obey);
    void sendReplies();

    std::string name_;
    Ros2Inbox& inbox_;
    size_t requests_;
    Ros2Writer replies_;
    std::deque<Reply> waiting_;
    uint64_t skipped_ = 0;
};

} // namespace fathom
