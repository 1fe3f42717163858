// SPDX-License-Identifier: Apache-2.0
// Reads and writes topics of a ROS 2 graph through Eclipse Cyclone DDS. DDS names topics and types as the rmw
// implementations do: "/camera/image" is "rt/camera/image", and a service "/freeze" has "rq/freezeRequest"
// and "rr/freezeReply".
#pragma once

#include "devices/ros2/raw_message.h"
#include "devices/ros2/ros2_place.h"

#include <memory>
#include <span>
#include <string>
#include <vector>

struct ddsi_sertype;

namespace fathom {

// This process as a participant of one domain. Any thread.
class Ros2Graph {
public:
    // The participant of this process, which all callers share. Throws BadInput: the network cannot be used,
    // or this process takes part through another network.
    static std::shared_ptr<Ros2Graph> join(const Ros2Place& place);
    ~Ros2Graph();
    Ros2Graph(const Ros2Graph&) = delete;
    Ros2Graph& operator=(const Ros2Graph&) = delete;

    // Names and types of the topics that others publish now, sorted: "/camera/image (sensor_msgs/msg/Image),
    // ..."; "none" if there are none.
    std::string publications() const;
    const Ros2Place& place() const { return place_; }
    int32_t participant() const { return participant_; }

private:
    explicit Ros2Graph(const Ros2Place& place);

    Ros2Place place_;
    int32_t domain_ = 0, participant_ = 0;
};

// How a topic is read or written.
enum class Ros2Qos {
    Sensor,   // best effort, the newest few
    Stream,   // best effort, the newest 500: many small messages
    Reliable, // reliable, the newest ten
    Latched,  // reliable, kept for readers that come later
};

// A topic, or one of the two of a service.
enum class Ros2Part { Topic, Request, Reply };

// A message, and the publisher that it is from.
struct Ros2Message {
    RawMessagePtr message;
    uint64_t publisher = 0;
};

// Subscriptions that one thread waits for.
class Ros2Inbox {
public:
    explicit Ros2Inbox(std::shared_ptr<Ros2Graph> graph);
    ~Ros2Inbox();
    Ros2Inbox(const Ros2Inbox&) = delete;
    Ros2Inbox& operator=(const Ros2Inbox&) = delete;

    // type: "sensor_msgs/msg/Image". Returns the topic's number, from 0. Throws Error.
    size_t subscribe(const std::string& topic, const std::string& type, Ros2Qos qos,
                     Ros2Part part = Ros2Part::Topic);
    // Waits until there is a message, at most that long [s]. False: there is none.
    bool wait(double seconds);
    // The oldest messages of a topic that have not been taken, at most a few dozen.
    std::vector<Ros2Message> take(size_t topic);
    // Messages lost on the way, as far as the topic's publishers number them.
    uint64_t lost(size_t topic) const;
    uint32_t publishers(size_t topic) const; // that are there now

private:
    std::shared_ptr<Ros2Graph> graph_;
    int32_t waiting_ = 0;
    std::vector<int32_t> readers_;
};

// One publication. One thread.
class Ros2Writer {
public:
    // Throws Error.
    Ros2Writer(std::shared_ptr<Ros2Graph> graph, const std::string& topic, const std::string& type,
               Ros2Qos qos, Ros2Part part = Ros2Part::Topic);
    ~Ros2Writer();
    Ros2Writer(const Ros2Writer&) = delete;
    Ros2Writer& operator=(const Ros2Writer&) = delete;

    // CDR with its header. False: not sent, because a subscriber's acknowledgement is overdue.
    bool write(std::span<const uint8_t> message) noexcept;
    uint32_t subscribers() const noexcept; // that are there now
    bool watched() const noexcept { return subscribers() > 0; }

private:
    std::shared_ptr<Ros2Graph> graph_;
    int32_t writer_ = 0;
    const ddsi_sertype* type_ = nullptr;
};

} // namespace fathom
