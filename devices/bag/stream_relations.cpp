// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/stream_relations.h"

#include "devices/recorded/lens_model.h"
#include "devices/recorded/recording_extrinsics.h"
#include "engine/scene/camera_limits.h"
#include "engine/types/error.h"

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

// Of the same rays at another resolution: an image registered to a resized one of the same camera.
bool resizedLens(const Intrinsics& a, const Intrinsics& b) {
    const double x = static_cast<double>(b.width) / a.width, y = static_cast<double>(b.height) / a.height;
    const auto close = [](double one, double other, double within) {
        return std::abs(one - other) <= within;
    };
    return a.pinhole() && b.pinhole() && close(x, y, 1e-3 * x) && close(a.fx * x, b.fx, 1e-3 * b.fx) &&
           close(a.fy * y, b.fy, 1e-3 * b.fy) && close(a.cx * x, b.cx, std::max(1.0, x)) &&
           close(a.cy * y, b.cy, std::max(1.0, y));
}

constexpr double kSameCentre = 1e-5; // [m]

// That of rectified images; in others, R may turn the camera.
dvec3 shiftOf(const ImageStream& stream) {
    return stream.rectified || !stream.turned ? stream.shift : dvec3(0.0);
}

// Whether images of one frame are of one camera though their lenses differ: rectified, resized, cropped,
// registered, or calibrated anew.
bool oneCentre(const ImageStream& depth, const ImageStream& colour) {
    const bool turned = depth.rectified != colour.rectified && (depth.turned || colour.turned);
    if (depth.rectified != colour.rectified && sameLens(depth.raw, colour.raw) && !turned) {
        return true;
    }
    const Intrinsics &a = *depth.lens, &b = *colour.lens;
    const bool second = namedRight(colour.name) && !namedRight(depth.name); // of a stereo pair
    const bool focal = std::abs(a.fx - b.fx) <= 1e-3 * b.fx && std::abs(a.fy - b.fy) <= 1e-3 * b.fy;
    return !depth.frame.empty() &&
           (resizedLens(a, b) || (!turned && !second && (focal || namedRegistered(depth.name))));
}

// Why colour has no lens, with the options that play the recording without it.
std::string unusableColour(const ImageStream& colour) {
    const bool listed = colour.noLens.find("(allowed: ") != std::string::npos && colour.noLens.ends_with(')');
    const bool file = colour.noLens.find("intrinsics=FILE") != std::string::npos;
    return colour.noLens.substr(0, colour.noLens.size() - (listed ? 1 : 0)) + "; or colour=none" +
           (file ? "" : " or intrinsics=FILE") + " after the file name" + (listed ? ")" : "");
}

bool isIdentity(const Pose& pose) {
    return glm::length(pose.position) < 1e-9 && std::abs(std::abs(pose.rotation.w) - 1.0) < 1e-12;
}

} // namespace

StreamRelations::StreamRelations(MessageFile& file, const SourceOptions& options)
    : file_(file)
    , options_(options)
    , given_(options)
    , poses_(file) {}

StreamRelation StreamRelations::between(const ImageStream& depth, const ImageStream& colour) {
    const bool sdk = isSdkTopic(depth.name) || isSdkTopic(colour.name);
    const bool sameFrame = sharesFrame(depth, colour);
    const bool alike = !colour.lens && depth.width == colour.width && depth.height == colour.height;
    if (!options_.intrinsics.empty() && !depth.lens) {
        return byGivenLens(depth, colour);
    }
    if (!depth.lens || (!colour.lens && !(alike && sameFrame && namedRegistered(depth.name)))) {
        return {0, false, {}, depth.lens ? unusableColour(colour) : depth.noLens};
    }
    if (!options_.extrinsics.empty()) {
        return {3, false, readExtrinsics(options_.extrinsics), ""};
    }
    const dvec3 apart = shiftOf(colour) - shiftOf(depth);
    const std::string shiftSource = "P of the camera_info of " + depth.name + " and " + colour.name;
    // Drivers write another P for depth that they align, but not for the second camera of a stereo pair.
    const bool second = namedRight(colour.name) && !namedRight(depth.name);
    if (sameFrame && colour.lens && (second || !namedRegistered(depth.name)) &&
        glm::length(apart) > kSameCentre) {
        return {3, false, {apart}, "", "", shiftSource}; // a stereo pair in the frame of its first camera
    }
    const bool same = !colour.lens || sameLens(*depth.lens, *colour.lens);
    if (same && sameFrame) {
        return {StreamRelation::kOneLens, true, {}, ""};
    }
    if (same && !sdk && namedRegistered(depth.name) && oneCamera(depth, colour)) {
        if (colour.lens && glm::length(apart) > kSameCentre) {
            return {3, false, {apart}, "", "", shiftSource};
        }
        const bool otherFrame = !depth.frame.empty() && !colour.frame.empty();
        const bool one = sharedParts(depth.name, colour.name) > 0 && !otherFrame;
        return {one ? StreamRelation::kOneLens : 3, true, {}, ""};
    }
    if (sameFrame && oneCentre(depth, colour)) {
        return {3, false, {}, ""};
    }
    return byPose(depth, colour);
}

// By the topics' names; tf may contradict. The depth and colour lenses of a camera are centimetres apart.
bool StreamRelations::oneCamera(const ImageStream& depth, const ImageStream& colour) {
    constexpr double kMaxApart = 0.1; // [m]
    if (!namedOneCamera(depth.name, colour.name)) {
        return false;
    }
    const auto apart = poses_.byFrames(depth, colour);
    const bool second = namedRight(colour.name) && !namedRight(depth.name); // of a stereo pair
    if (!apart) { // the second camera is of one pair with depth, but elsewhere: its P tells
        return !second || glm::length(shiftOf(colour) - shiftOf(depth)) > kSameCentre;
    }
    return glm::length(apart->position) <= (second ? kSameCentre : kMaxApart);
}

// Of depth without a recorded lens, whose lens a file gives.
StreamRelation StreamRelations::byGivenLens(const ImageStream& depth, const ImageStream& colour) {
    const StreamRelation registered{1, true, {}, ""};
    if (!given_.keepsRelation()) {
        return registered; // the file says the rest
    }
    if (!colour.lens) {
        const bool unnamed = depth.frame.empty() || colour.frame.empty();
        return sharesFrame(depth, colour) || unnamed || !options_.extrinsics.empty() ? registered
                                                                                     : StreamRelation{};
    }
    return between(given_.withLens(depth, colour), colour);
}

StreamRelation StreamRelations::byPose(const ImageStream& depth, const ImageStream& colour) {
    const FoundPose found = poses_.between(depth, colour);
    if (found.pose) {
        const bool registered = isIdentity(*found.pose) && sameLens(*depth.lens, *colour.lens);
        const Pose pose = registered ? Pose{} : *found.pose;
        return {StreamRelation::kPosed, registered, pose, "", found.warning, found.source};
    }
    const std::string topic = isRealSenseTopic(depth.name)
                                  ? parentTopic(baseTopic(colour.name), 2) + "/tf/0"
                                  : "tf_static between the frames, .../extrinsics/depth_to_color";
    return {0,
            false,
            {},
            "extrinsics: " + (found.warning.empty() ? "missing" : found.warning) +
                " (allowed: depth registered to colour (same frame and lens), or the topic " + topic +
                ", or extrinsics=FILE or colour=none after the file name)"};
}

void StreamRelations::doubtRig(StreamRelation& relation, bool warns) {
    const std::optional<RigFault> fault = rigFault(relation.colourTdepth);
    if (!fault) {
        return;
    }
    std::string words = relation.source + ": " + fault->value + " (allowed: " + fault->allowed;
    if (!(glm::length(relation.colourTdepth.position) <= kFarthestColour)) {
        words += "; or extrinsics=FILE or colour=none after the file name)";
        relation = {0, false, {}, "extrinsics: " + words};
        return;
    }
    if (!warns) {
        return;
    }
    words += "): regions by colour are lost if this is wrong; extrinsics=FILE or colour=none after the file "
             "name";
    relation.warning += (relation.warning.empty() ? "" : "; ") + words;
}

void StreamRelations::refuse(const ImageStream& depth, const ImageStream& colour,
                             const StreamRelation& relation) const {
    if (options_.intrinsics.empty()) {
        throw BadInput(file_.file().string() + ": " + relation.fault);
    }
    throw BadInput(options_.intrinsics.string(), "color", "missing",
                   "blocks depth and color, or registered_to_color: true, as the recording does not relate " +
                       depth.name + " and " + colour.name + "; or colour=none after its name");
}

} // namespace fathom
