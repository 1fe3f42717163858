// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/stream_chooser.h"

#include "devices/bag/stream_description.h"
#include "devices/recorded/range_images.h"
#include "engine/types/error.h"

#include <algorithm>
#include <tuple>

namespace fathom {

StreamChooser::StreamChooser(MessageFile& file, const SourceOptions& options)
    : file_(file)
    , options_(options)
    , given_(options)
    , candidates_(file, options)
    , relations_(file, options) {}

StreamChoice StreamChooser::choose() {
    Pair pair = bestPair();
    if (!pair.depth->lens && options_.intrinsics.empty()) {
        throw BadInput(file_.file().string() + ": " + pair.depth->noLens);
    }
    if (pair.colour != nullptr && given_.keepsRelation()) {
        judgeRelation(pair);
    }
    const auto& [depth, colour, relation] = pair;
    StreamChoice choice;
    choice.depth = *depth;
    choice.camera = cameraOf(pair);
    if (colour != nullptr) {
        choice.colour = *colour;
        if (given_.keepsRelation() && !relation.warning.empty()) {
            choice.warnings.push_back(relation.warning);
        }
    }
    if (!options_.intrinsics.empty()) {
        given_.replaceIn(choice);
    } else if (colour != nullptr && !relation.registered) {
        choice.warnings.push_back(StreamDescription::alignedWarning(*depth, *colour));
    }
    const StreamDescription description(file_, options_, candidates_.streams());
    description.addWarnings(choice);
    std::erase(choice.warnings, "");
    choice.camera.colourFormat = colour != nullptr ? colour->format : ColourFormat::Rgba;
    choice.unread = description.unread();
    choice.summary = description.summary(choice);
    return choice;
}

// Images of one frame and lens come first, whatever names other topics have.
StreamChooser::Pair StreamChooser::bestPair() {
    const std::vector<StreamCandidate> ofDepth = candidates_.depths(), ofColour = candidates_.colours();
    if (ofColour.empty()) {
        return {candidates_.bestDepth(), nullptr, {}};
    }
    using Score = std::tuple<bool, int, int, int, bool, size_t, size_t, double, bool, bool, bool>;
    Score best;
    Pair pair;
    for (const auto& [d, depthFit] : ofDepth) {
        for (const auto& [c, colourFit] : ofColour) {
            const StreamRelation found = relations_.between(*d, *c);
            const bool together =
                found.rank == StreamRelation::kOneLens && belongTogether({d, depthFit}, {c, colourFit});
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

// Whether images of one frame and lens are of one camera. A program's images have them too, of labels for
// example: so names must agree, and an image without a name gives way to the camera's own.
bool StreamChooser::belongTogether(const StreamCandidate& depth, const StreamCandidate& colour) {
    const bool named =
        depth.fit == StreamCandidates::kDepthName && colour.fit == StreamCandidates::kColourName;
    if (colour.fit <= 1 || !(named || namedOneCamera(depth.stream->name, colour.stream->name))) {
        return false;
    }
    const auto own = [&](const ImageStream& d, const ImageStream& c) {
        return namedOneCamera(d.name, c.name) && relations_.between(d, c).rank >= StreamRelation::kPosed;
    };
    const auto ownDepth = [&](const StreamCandidate& other) {
        return other.fit == StreamCandidates::kDepthName && own(*other.stream, *colour.stream);
    };
    const auto ownColour = [&](const StreamCandidate& other) {
        return other.fit == StreamCandidates::kColourName && own(*depth.stream, *other.stream);
    };
    return (depth.fit == StreamCandidates::kDepthName ||
            std::ranges::none_of(candidates_.depths(), ownDepth)) &&
           (colour.fit == StreamCandidates::kColourName ||
            std::ranges::none_of(candidates_.colours(), ownColour));
}

// Refuses colour that is unrelated to depth. Nothing asks for grey images, so a fault of theirs is not
// reported: they are left out.
void StreamChooser::judgeRelation(Pair& pair) const {
    auto& [depth, colour, relation] = pair;
    const bool wanted = colour->content != ros::Content::Grey || !options_.colour.empty();
    StreamRelations::doubtRig(relation, wanted);
    if (relation.rank == 0) {
        if (wanted) {
            relations_.refuse(*depth, *colour, relation);
        }
        colour = nullptr;
    }
}

CameraInfo StreamChooser::cameraOf(const Pair& pair) {
    const auto& [depth, colour, relation] = pair;
    CameraInfo camera;
    camera.poseless = true;
    camera.depth = camera.colour = depth->lens.value_or(Intrinsics{});
    camera.hasColour = colour != nullptr;
    if (colour != nullptr) {
        camera.registered = relation.registered;
        camera.colour = relation.registered || !colour->lens ? camera.depth : *colour->lens;
        camera.colourTdepth = relation.colourTdepth;
    }
    return camera;
}

} // namespace fathom
