// SPDX-License-Identifier: Apache-2.0
#include "devices/ros2/ros2_service.h"

#include "devices/bag/byte_writer.h"
#include "engine/types/clock.h"
#include "engine/types/error.h"
#include "engine/types/log.h"

namespace fathom {

namespace {

// A client that has found the service may not have been found yet: its reply waits for that.
constexpr double kDiscovery = 0.1; // [s], as rmw_cyclonedds waits

} // namespace

Ros2Service::Ros2Service(std::shared_ptr<Ros2Graph> graph, Ros2Inbox& inbox, std::string name,
                         const std::string& type)
    : name_(std::move(name))
    , inbox_(inbox)
    , requests_(inbox.subscribe(name_, type + "_Request", Ros2Qos::Reliable, Ros2Part::Request))
    , replies_(std::move(graph), name_, type + "_Response", Ros2Qos::Reliable, Ros2Part::Reply) {}

void Ros2Service::answer(const RawMessage& request, const std::function<std::string(MessageCursor&)>& obey) {
    MessageCursor cursor(request.bytes(), true);
    const auto client = cursor.value<uint64_t>();
    const auto number = cursor.value<int64_t>();
    CdrWriter reply;
    reply.value(client);
    reply.value(number);
    reply.value(uint8_t{1}); // success
    reply.text(obey(cursor));
    waiting_.push_back({reply.bytes(), monotonicSeconds()});
}

void Ros2Service::serve(const std::function<std::string(MessageCursor& request)>& obey) {
    for (const Ros2Message& taken : inbox_.take(requests_)) {
        try {
            answer(*taken.message, obey);
        } catch (const Error& e) {
            if (skipped_++ == 0) {
                log::warn(
                    "ros2: service {}: request skipped: {} (logged once; clients of rmw_fastrtps are not "
                    "supported)",
                    name_, e.what());
            }
        }
    }
    sendReplies();
}

void Ros2Service::sendReplies() {
    const bool all = replies_.subscribers() >= inbox_.publishers(requests_);
    while (!waiting_.empty() && (all || waiting_.size() > kMaxWaiting ||
                                 monotonicSeconds() - waiting_.front().queuedAt > kDiscovery)) {
        replies_.write(waiting_.front().bytes);
        waiting_.pop_front();
    }
}

} // namespace fathom
