// SPDX-License-Identifier: Apache-2.0
// Poses between the frames of a recording: its topics /tf_static and /tf.
#pragma once

#include "devices/bag/message_file.h"
#include "engine/types/pose.h"

#include <map>
#include <optional>
#include <string>

namespace fathom {

class FrameTree {
public:
    explicit FrameTree(MessageFile& file)
        : file_(file) {}
    // to_T_from, through links that do not move; empty when there is no such path. The first call reads the
    // topics, at most 2000 messages of each. Throws Error.
    std::optional<Pose> pose(const std::string& from, const std::string& to);

private:
    struct Link {
        std::string parent;
        Pose parentTchild;
        bool moves = false;
    };
    void read();
    std::map<std::string, Pose> ancestors(const std::string& frame) const; // ancestor_T_frame

    MessageFile& file_;
    bool read_ = false;
    std::map<std::string, Link> links_; // by child
};

} // namespace fathom
