// SPDX-License-Identifier: Apache-2.0
// Chooses the depth and colour streams of a file of messages, with their lenses and their poses.
#pragma once

#include "devices/bag/given_lenses.h"
#include "devices/bag/stream_candidates.h"
#include "devices/bag/stream_choice.h"
#include "devices/bag/stream_relations.h"

namespace fathom {

// Chooses the streams of a bag. One thread.
class StreamChooser {
public:
    StreamChooser(MessageFile& file, const SourceOptions& options);
    // Chooses depth and colour of one camera. Order of preference: one frame and lens, names, extrinsics,
    // common topic path, shorter distance, plain names of depth, uncompressed images, order in the file.
    // Infrared is never depth. Grey images are colour only if there is no other. Throws BadInput that names
    // file and topic.
    StreamChoice choose();

private:
    struct Pair {
        const ImageStream *depth = nullptr, *colour = nullptr; // colour: null = none
        StreamRelation relation;
    };
    Pair bestPair();
    bool belongTogether(const StreamCandidate& depth, const StreamCandidate& colour);
    void judgeRelation(Pair& pair) const;
    static CameraInfo cameraOf(const Pair& pair);

    const MessageFile& file_;
    const SourceOptions& options_;
    GivenLenses given_;
    StreamCandidates candidates_;
    StreamRelations relations_;
};

} // namespace fathom
