// SPDX-License-Identifier: Apache-2.0
// Poses between the frames of a recording: its topics /tf_static and /tf.
#pragma once

#include "devices/bag/message_file.h"
#include "devices/bag/ros_messages.h"

#include <map>
#include <optional>
#include <set>
#include <string>

namespace fathom {

class FrameTree {
public:
    explicit FrameTree(MessageFile& file)
        : file_(file) {}
    // to_T_from, through links that do not move; empty when there is no such path. The first call reads the
    // topics, at most 2000 messages of each. Damaged messages and invalid transforms are skipped and logged.
    std::optional<Pose> pose(const std::string& from, const std::string& to);
    // Why images in these two frames, whose pose tf has, may have other axes than the optical ones (x right,
    // y down, z forward): a turned child is called optical, or the frames are parallel and neither name says
    // so. Empty = no doubt.
    std::string axesWarning(const std::string& from, const std::string& to);

private:
    struct Link {
        std::string parent;
        Pose parentTchild;
        bool moves = false;
    };
    void readOnce();
    void read();
    bool hasOpticalChild(const std::string& frame) const;
    void add(const MessageTopic& topic, const ros::FrameLink& link);
    void tellSkipped(const MessageTopic& topic, const std::string& what);
    std::map<std::string, Pose> ancestors(const std::string& frame) const; // ancestor_T_frame

    MessageFile& file_;
    bool read_ = false;
    std::map<std::string, Link> links_; // by child
    std::set<std::string> warned_;
};

} // namespace fathom
