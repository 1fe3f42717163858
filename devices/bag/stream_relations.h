// SPDX-License-Identifier: Apache-2.0
// How a colour stream of a file of messages relates to a depth stream: registered, by a pose, or not at all.
#pragma once

#include "devices/bag/given_lenses.h"
#include "devices/bag/stream_poses.h"

#include <string>

namespace fathom {

// How colour relates to depth. rank 0: unknown, for the reason given in `fault`.
struct StreamRelation {
    static constexpr int kOneLens = 4; // rank of registered images
    static constexpr int kPosed = 2;   // rank of images whose poses are known

    int rank = 0; // the higher, the surer
    bool registered = false;
    Pose colourTdepth;
    std::string fault;
    std::string warning = {}; // of a pose that is used
    std::string source = {};  // what states the pose
};

// Relations between the streams of one file. One thread.
class StreamRelations {
public:
    StreamRelations(MessageFile& file, const SourceOptions& options);
    // By the frames, lenses and names of both, by the file of extrinsics that the options name, or by a pose
    // of the recording. Throws BadInput for a fault of a file that the options name.
    StreamRelation between(const ImageStream& depth, const ImageStream& colour);
    // For a pose that lenses of one rig do not have: beyond the bounds of any camera colour becomes unrelated
    // to depth (rank 0); a smaller one adds a warning if `warns`.
    static void doubtRig(StreamRelation& relation, bool warns);
    // Throws BadInput: why colour is unrelated to depth, and which options help.
    [[noreturn]] void refuse(const ImageStream& depth, const ImageStream& colour,
                             const StreamRelation& relation) const;

private:
    bool oneCamera(const ImageStream& depth, const ImageStream& colour);
    StreamRelation byGivenLens(const ImageStream& depth, const ImageStream& colour);
    StreamRelation byPose(const ImageStream& depth, const ImageStream& colour);

    const MessageFile& file_;
    const SourceOptions& options_;
    GivenLenses given_;
    StreamPoses poses_;
};

} // namespace fathom
