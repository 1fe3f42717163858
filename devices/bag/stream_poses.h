// SPDX-License-Identifier: Apache-2.0
// Poses that a file of messages states between its depth and colour streams.
#pragma once

#include "devices/bag/frame_tree.h"
#include "devices/bag/image_stream.h"

#include <optional>
#include <string>

namespace fathom {

// Whether both are of one frame by their headers. Headers without a name of the frame say nothing, unless the
// topics are of one camera; those of an SDK never say anything.
bool sharesFrame(const ImageStream& depth, const ImageStream& colour);

// A pose colour_T_depth, why there is none, or why it may be wrong.
struct FoundPose {
    std::optional<Pose> pose;
    std::string warning = {}, source = {}; // source: what states the pose
};

// Poses between the streams of one file. One thread.
class StreamPoses {
public:
    explicit StreamPoses(MessageFile& file)
        : file_(file)
        , frames_(file) {}
    // By the topics of an SDK, by the driver's topic .../extrinsics/depth_to_color, or by tf.
    FoundPose between(const ImageStream& depth, const ImageStream& colour);
    // colour_T_depth by tf alone; empty when there is no such path.
    std::optional<Pose> byFrames(const ImageStream& depth, const ImageStream& colour);

private:
    FoundPose sdkPose(const ImageStream& depth, const ImageStream& colour);
    FoundPose driverPose(const ImageStream& depth, const ImageStream& colour);
    const MessageTopic* poseTopic(const ImageStream& depth, const ImageStream& colour) const;
    std::optional<Pose> topicPose(const MessageTopic* topic, std::string& fault);

    MessageFile& file_;
    FrameTree frames_;
};

} // namespace fathom
