// SPDX-License-Identifier: Apache-2.0
// Poses between the frames of a recording: its topics /tf_static and /tf.
#pragma once

#include "devices/bag/message_file.h"
#include "devices/bag/ros_messages.h"

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

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
    // so. Empty = none.
    std::string axesWarning(const std::string& from, const std::string& to);
    // Which link of tf has several poses, so that there is no pose between these frames; empty = none has.
    std::string whyMoving(const std::string& from, const std::string& to);
    // Which link between these frames was published with two poses that nearly agree; empty = none.
    std::string twicePublished(const std::string& from, const std::string& to);

private:
    struct Link {
        std::string parent;
        Pose parentTchild;
        std::string otherParent = {}; // of another transform of the same child
        Pose otherTchild = {};        // the last one that differs
        bool moves = false;           // the two do not nearly agree
        bool isTwice = false;         // they do, but not to the last digits
    };
    void readOnce();
    void read();
    bool hasOpticalChild(const std::string& frame) const;
    void add(const MessageTopic& topic, const ros::FrameLink& link);
    void logSkipped(const MessageTopic& topic, const std::string& what);
    std::map<std::string, Pose> ancestors(const std::string& frame) const; // ancestor_T_frame
    std::vector<std::string> frameAndAncestors(const std::string& frame) const;
    std::vector<std::string> linksBetween(const std::string& from, const std::string& to);

    MessageFile& file_;
    bool read_ = false;
    std::map<std::string, Link> links_; // by child
    std::set<std::string> warned_;
};

} // namespace fathom
