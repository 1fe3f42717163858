// SPDX-License-Identifier: Apache-2.0
// The joints of one robot, from the messages of a topic of sensor_msgs/msg/JointState. Untrusted input.
#pragma once

#include "devices/ros2/first_publisher.h"
#include "devices/ros2/live_stamps.h"

#include <cstdint>
#include <limits>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace fathom {

// A joint that is looked for by its name.
struct RobotJoint {
    std::string name;
    double lower = -std::numeric_limits<double>::infinity(); // [rad], [m]
    double upper = std::numeric_limits<double>::infinity();
};

// A message may hold some of the joints, and others. An unusable one changes nothing: it is counted, and each
// cause is logged once. Messages without any of the joints are ignored; of the others only those of the first
// publisher count. A stamp that is not later than the one before does not make the joints newer. One thread.
class JointReadings {
public:
    // reader, topic: for log lines. others: joints that are known and not needed.
    JointReadings(std::string reader, std::string topic, std::vector<RobotJoint> joints,
                  std::set<std::string> others = {});

    void take(const Ros2Message& message);

    // [rad], [m] in the order of the joints; NaN until the first reading.
    std::span<const double> positions() const { return positions_; }
    // [s] of the oldest joint at that time (CLOCK_MONOTONIC); infinite until all have one.
    double age(double now) const;
    // What is missing, for messages: no message, these joints, or the last fault.
    std::string whyIncomplete() const;
    uint64_t skipped() const { return skipped_; } // messages

    static constexpr double kOutside = 0.02; // [rad], [m] beyond a limit, by calibration; it is clamped
    static constexpr double kMissing = 1.0;  // [s] without a joint until it is named

private:
    void read(const Ros2Message& message);
    double captureTime(const Ros2Message& message);
    void nameUnknown(const std::string& joint);
    void nameMissing(double now);
    void skip(const std::string& fault);
    void once(const std::string& what);

    std::string reader_, topic_;
    std::vector<RobotJoint> joints_;
    std::set<std::string> others_, named_; // named_: lines that were logged
    FirstPublisher publisher_;
    LiveStamps stamps_;
    double lastStamp_ = 0.0;                                   // [s]
    std::vector<double> positions_, times_;                    // times_ [s] CLOCK_MONOTONIC; NaN = never
    double newest_ = -std::numeric_limits<double>::infinity(); // [s] CLOCK_MONOTONIC of the newest joint
    double first_ = 0.0;                                       // [s] arrival of the first message; 0 = none
    uint64_t skipped_ = 0;
    std::string lastFault_;
};

} // namespace fathom
