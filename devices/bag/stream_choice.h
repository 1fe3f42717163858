// SPDX-License-Identifier: Apache-2.0
// Chooses the depth and colour streams of a file of messages, with their lenses and their poses.
#pragma once

#include "devices/bag/frame_tree.h"
#include "devices/bag/image_stream.h"
#include "devices/recorded/source_options.h"

#include <optional>
#include <string>
#include <vector>

namespace fathom {

struct StreamChoice {
    ImageStream depth;
    std::optional<ImageStream> colour;
    CameraInfo camera;                 // lenses, registration, extrinsics; not the depth unit
    std::string summary;               // what was chosen, and what else there is, in one line
    bool rangeImages = false;          // depth holds ranges along the rays
    std::vector<std::string> warnings; // why colour or depth may be wrong
    std::string unread;                // image topics that may be colour but whose encoding is not read
    std::optional<double> statedUnit;  // [m] by the file of the lens
    std::string unreadScale;           // RecordingIntrinsics::unreadScale
    std::string unitWarning;           // that of the file, if its unit counts
};

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
    // How colour relates to depth. rank 0: unknown, for the reason given in `fault`.
    struct Relation {
        int rank = 0;
        bool registered = false;
        Pose colourTdepth;
        std::string fault;
        std::string warning = {}; // of a pose that is used
        std::string source = {};  // what states the pose
    };
    struct Pair {
        const ImageStream *depth = nullptr, *colour = nullptr; // colour: null = none
        Relation relation;
    };
    Pair bestPair();
    static CameraInfo cameraOf(const ImageStream& depth, const ImageStream* colour, const Relation& relation);
    const ImageStream* bestDepth() const;
    // fit: how well the name fits; 0 only for grey.
    struct Candidate {
        const ImageStream* stream;
        int fit;
    };
    std::vector<Candidate> depths() const;
    std::vector<Candidate> colours() const;
    bool belongTogether(const Candidate& depth, const Candidate& colour);
    bool sharesFrame(const ImageStream& depth, const ImageStream& colour) const;
    bool oneCamera(const ImageStream& depth, const ImageStream& colour);
    Relation relate(const ImageStream& depth, const ImageStream& colour);
    Relation relateByPose(const ImageStream& depth, const ImageStream& colour);
    Relation relateGiven(const ImageStream& depth, const ImageStream& colour);
    // A pose, why there is none, or why it may be wrong.
    struct FoundPose {
        std::optional<Pose> pose;
        std::string warning = {}, source = {};
    };
    static void doubtRig(Relation& relation, bool warns);
    FoundPose driverPose(const ImageStream& depth, const ImageStream& colour);
    FoundPose sdkPose(const ImageStream& depth, const ImageStream& colour);
    const MessageTopic* poseTopic(const ImageStream& depth, const ImageStream& colour) const;
    std::optional<Pose> topicPose(const MessageTopic* topic, std::string& fault);
    bool keepsRelation() const;
    void replaceLenses(StreamChoice& choice) const;
    std::string alignedWarning(const ImageStream& depth, const ImageStream& colour) const;
    std::string unreadStreams() const;
    void warnOf(const ImageStream& stream, StreamChoice& choice) const;
    std::string otherTopics() const;
    std::string describe(const StreamChoice& choice) const;
    [[noreturn]] void refuseAll() const;
    [[noreturn]] void refuseRelation(const ImageStream& depth, const ImageStream& colour,
                                     const Relation& relation) const;
    [[noreturn]] void refuse(const std::string& field, const std::string& value,
                             const std::string& allowed) const;

    MessageFile& file_;
    const SourceOptions& options_;
    std::vector<ImageStream> streams_;
    FrameTree frames_;
};

} // namespace fathom
