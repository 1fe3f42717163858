// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/stream_choice.h"

#include "devices/recorded/lens_model.h"
#include "devices/recorded/range_images.h"
#include "devices/recorded/recording_extrinsics.h"
#include "devices/recorded/recording_intrinsics.h"
#include "engine/types/error.h"

#include <algorithm>
#include <cmath>
#include <tuple>

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

constexpr int kOneLens = 4;                    // rank of registered images
constexpr int kPosed = 2;                      // rank of images whose poses are known
constexpr int kDepthName = 2, kColourName = 3; // fits of names that say what the images hold
constexpr double kSameCentre = 1e-5;           // [m]

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

// How well a name fits a use: 2 names it, 1 says nothing, 0 names another.
int fits(NamedRole role, NamedRole use) {
    return role == use ? 2 : (role == NamedRole::None ? 1 : 0);
}

} // namespace

StreamChooser::StreamChooser(MessageFile& file, const SourceOptions& options)
    : file_(file)
    , options_(options)
    , streams_(imageStreams(file, options.info))
    , frames_(file) {}

void StreamChooser::refuse(const std::string& field, const std::string& value,
                           const std::string& allowed) const {
    throw BadInput(file_.file().string(), field, value, allowed);
}

std::vector<StreamChooser::Candidate> StreamChooser::depths() const {
    std::vector<Candidate> all;
    for (const ImageStream& stream : streams_) {
        const bool named = stream.name == options_.depth;
        const bool fit = options_.depth.empty() ? mayBeDepth(stream) : named;
        const int how = named ? 2 : fits(stream.role, NamedRole::Depth);
        if (stream.content == ros::Content::Depth && fit && how > 0) {
            all.push_back({&stream, how});
        }
    }
    if (!all.empty()) {
        return all;
    }
    refuseAll();
}

std::vector<StreamChooser::Candidate> StreamChooser::colours() const {
    std::vector<Candidate> all;
    if (options_.colour == "none") {
        return all;
    }
    for (const ImageStream& stream : streams_) {
        const bool usable = stream.content == ros::Content::Colour || stream.content == ros::Content::Grey;
        const bool named = stream.name == options_.colour;
        if (!usable || (!options_.colour.empty() && !named) || (!named && stream.painted)) {
            continue;
        }
        // Grey comes last: it is no colour, but shows something.
        const bool grey = stream.content == ros::Content::Grey;
        all.push_back({&stream, grey ? 0 : 1 + fits(stream.role, NamedRole::Colour)});
    }
    if (all.empty() && !options_.colour.empty()) {
        refuse("colour", options_.colour, std::string("a topic with encoding ") + ros::kColourEncodings);
    }
    return all;
}

// Headers without a name of the frame say nothing, unless the topics are of one camera.
bool StreamChooser::sharesFrame(const ImageStream& depth, const ImageStream& colour) const {
    const bool sdk = isSdkTopic(depth.name) || isSdkTopic(colour.name); // its frames are all "0"
    return !sdk && depth.frame == colour.frame &&
           (!depth.frame.empty() || namedOneCamera(depth.name, colour.name));
}

// By the topics' names; tf may contradict. The depth and colour lenses of a camera are centimetres apart.
bool StreamChooser::oneCamera(const ImageStream& depth, const ImageStream& colour) {
    constexpr double kMaxApart = 0.1; // [m]
    if (!namedOneCamera(depth.name, colour.name)) {
        return false;
    }
    const auto apart = frames_.pose(depth.frame, colour.frame);
    const bool second = namedRight(colour.name) && !namedRight(depth.name); // of a stereo pair
    if (!apart) { // the second camera is of one pair with depth, but elsewhere: its P tells
        return !second || glm::length(shiftOf(colour) - shiftOf(depth)) > kSameCentre;
    }
    return glm::length(apart->position) <= (second ? kSameCentre : kMaxApart);
}

StreamChooser::Relation StreamChooser::relate(const ImageStream& depth, const ImageStream& colour) {
    const bool sdk = isSdkTopic(depth.name) || isSdkTopic(colour.name);
    const bool sameFrame = sharesFrame(depth, colour);
    const bool alike = !colour.lens && depth.width == colour.width && depth.height == colour.height;
    if (!options_.intrinsics.empty() && !depth.lens) {
        return relateGiven(depth, colour);
    }
    if (!depth.lens || (!colour.lens && !(alike && sameFrame && namedRegistered(depth.name)))) {
        return {0, false, {}, depth.lens ? colour.noLens : depth.noLens};
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
        return {kOneLens, true, {}, ""};
    }
    if (same && !sdk && namedRegistered(depth.name) && oneCamera(depth, colour)) {
        if (colour.lens && glm::length(apart) > kSameCentre) {
            return {3, false, {apart}, "", "", shiftSource};
        }
        const bool otherFrame = !depth.frame.empty() && !colour.frame.empty();
        return {sharedParts(depth.name, colour.name) > 0 && !otherFrame ? kOneLens : 3, true, {}, ""};
    }
    if (sameFrame && oneCentre(depth, colour)) {
        return {3, false, {}, ""};
    }
    return relateByPose(depth, colour);
}

// Of a file without colour.
const ImageStream* StreamChooser::bestDepth() const {
    using Score = std::tuple<int, bool, bool, bool, bool>;
    Score best;
    const ImageStream* depth = nullptr;
    for (const auto& [d, how] : depths()) {
        const Score score{how, d->lens.has_value(), rangeName(d->name) != RangeName::Surely,
                          namedPlainly(d->name), !d->compressed};
        if (depth == nullptr || score > best) {
            best = score;
            depth = d;
        }
    }
    return depth;
}

// Whether images of one frame and lens are of one camera. A program's images have them too, of labels for
// example: so names must agree, and an image without a name gives way to the camera's own.
bool StreamChooser::belongTogether(const Candidate& depth, const Candidate& colour) {
    const bool named = depth.fit == kDepthName && colour.fit == kColourName;
    if (colour.fit <= 1 || !(named || namedOneCamera(depth.stream->name, colour.stream->name))) {
        return false;
    }
    const auto own = [&](const ImageStream& d, const ImageStream& c) {
        return namedOneCamera(d.name, c.name) && relate(d, c).rank >= kPosed;
    };
    const auto ownDepth = [&](const Candidate& other) {
        return other.fit == kDepthName && own(*other.stream, *colour.stream);
    };
    const auto ownColour = [&](const Candidate& other) {
        return other.fit == kColourName && own(*depth.stream, *other.stream);
    };
    return (depth.fit == kDepthName || std::ranges::none_of(depths(), ownDepth)) &&
           (colour.fit == kColourName || std::ranges::none_of(colours(), ownColour));
}

// Images of one frame and lens come first, whatever names other topics have.
StreamChooser::Pair StreamChooser::bestPair() {
    const std::vector<Candidate> ofDepth = depths(), ofColour = colours();
    if (ofColour.empty()) {
        return {bestDepth(), nullptr, {}};
    }
    using Score = std::tuple<bool, int, int, int, bool, size_t, size_t, double, bool, bool, bool>;
    Score best;
    Pair pair;
    for (const auto& [d, depthFit] : ofDepth) {
        for (const auto& [c, colourFit] : ofColour) {
            const Relation found = relate(*d, *c);
            const bool together = found.rank == kOneLens && belongTogether({d, depthFit}, {c, colourFit});
            const Score score{together,
                              depthFit,
                              colourFit,
                              found.rank,
                              rangeName(d->name) != RangeName::Surely, // simulators publish both kinds
                              sharedParts(d->name, c->name),
                              sharedWords(d->name, c->name),
                              -glm::length(found.colourTdepth.position), // else the nearer camera
                              namedPlainly(d->name),                     // before what is computed from it
                              !d->compressed,
                              !c->compressed};
            if (pair.depth == nullptr || score > best) {
                best = score;
                pair = {d, c, found};
            }
        }
    }
    return pair;
}

CameraInfo StreamChooser::cameraOf(const ImageStream& depth, const ImageStream* colour,
                                   const Relation& relation) {
    CameraInfo camera;
    camera.poseless = true;
    camera.depth = camera.colour = depth.lens.value_or(Intrinsics{});
    camera.hasColour = colour != nullptr;
    if (colour != nullptr) {
        camera.registered = relation.registered;
        camera.colour = relation.registered || !colour->lens ? camera.depth : *colour->lens;
        camera.colourTdepth = relation.colourTdepth;
    }
    return camera;
}

StreamChoice StreamChooser::choose() {
    auto [depth, colour, relation] = bestPair();
    StreamChoice choice;
    choice.depth = *depth;
    if (!depth->lens && options_.intrinsics.empty()) {
        throw BadInput(file_.file().string() + ": " + depth->noLens);
    }
    // Nothing asks for grey images, so a fault of theirs is not reported.
    const bool wanted =
        colour != nullptr && (colour->content != ros::Content::Grey || !options_.colour.empty());
    if (colour != nullptr && keepsRelation()) {
        doubtRig(relation, wanted);
    }
    if (colour != nullptr && relation.rank == 0 && keepsRelation()) {
        if (wanted) {
            refuseRelation(*depth, *colour, relation);
        }
        colour = nullptr;
    }
    choice.camera = cameraOf(*depth, colour, relation);
    if (colour != nullptr) {
        choice.colour = *colour;
        if (keepsRelation() && !relation.warning.empty()) {
            choice.warnings.push_back(relation.warning);
        }
    }
    if (!options_.intrinsics.empty()) {
        replaceLenses(choice);
    } else if (colour != nullptr && !relation.registered) {
        choice.warnings.push_back(alignedWarning(*depth, *colour));
    }
    warnOf(*depth, choice);
    if (choice.colour) {
        warnOf(*choice.colour, choice);
    }
    const std::string axis = axisWarning(depth->name, "a file of the lens (intrinsics=FILE)");
    if (!axis.empty() && !choice.rangeImages) {
        choice.warnings.push_back(axis);
    }
    choice.camera.colourFormat = colour != nullptr ? colour->format : ColourFormat::Rgba;
    choice.unread = unreadStreams();
    choice.summary = describe(choice);
    return choice;
}

} // namespace fathom
