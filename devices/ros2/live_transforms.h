// SPDX-License-Identifier: Apache-2.0
// Poses between the frames of a ROS 2 graph over time, from /tf and /tf_static. Untrusted input.
#pragma once

#include "devices/bag/ros_messages.h"
#include "devices/ros2/first_publisher.h"

#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace fathom {

// Keeps what came within kHistory. An unusable message is skipped and counted, and each cause is logged once.
// A frame that moves belongs to its first publisher. One thread.
class LiveTransforms {
public:
    // reader: for log lines.
    explicit LiveTransforms(std::string reader)
        : reader_(std::move(reader)) {}

    // isStatic: of /tf_static, which holds at all times.
    void take(const Ros2Message& message, bool isStatic);
    // Drops all moving transforms: the clock of the images was set back.
    void forgetMoving();

    // The pose at a time, or why there is none.
    struct Answer {
        std::optional<Pose> pose; // to_T_from
        bool early = false;       // a transform that is still to come may complete it
        std::string why = {};     // one clause without numbers; empty with a pose
    };
    // stamp [s]: as transforms are stamped. Transforms before and after it are interpolated.
    Answer pose(const std::string& from, const std::string& to, double stamp) const;
    // The same at any time: empty when there are transforms between the frames, else why not.
    std::string whyApart(const std::string& from, const std::string& to) const;
    uint64_t skipped() const { return skipped_; } // messages

    static constexpr double kLongestGap = 0.5; // [s] between transforms that are interpolated
    static constexpr double kHistory = 2.0;    // [s] before the newest
    static constexpr size_t kMaxFrames = 1000;
    static constexpr size_t kMaxKept = 1024;    // of one frame
    static constexpr size_t kLongestName = 256; // [bytes]
    static constexpr uint32_t kMaxBackward = 5; // old transforms in a row: its clock was set back

private:
    struct Stamped {
        double time; // [s]
        Pose parentTchild;
    };
    struct Link {
        std::string parent;
        bool fixed = false;
        std::deque<Stamped> poses = {}; // by time; one if fixed
        std::optional<FirstPublisher> publisher = {};
        uint32_t back = 0;
    };
    void add(const ros::FrameLink& link, const Ros2Message& message, bool isStatic);
    void insert(Link& to, const Stamped& pose);
    std::vector<std::string> ancestors(const std::string& frame) const;
    std::optional<std::string> common(const std::string& a, const std::string& b) const;
    Answer along(const std::string& from, const std::string& ancestor, double stamp) const;
    static Answer at(const std::string& child, const Link& link, double stamp);

    std::string reader_;
    std::map<std::string, Link> links_; // by child
    std::set<std::string> faults_;
    uint64_t skipped_ = 0;
};

} // namespace fathom
