// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/given_lenses.h"

#include "devices/bag/stream_choice.h"
#include "devices/bag/stream_poses.h"
#include "devices/recorded/recording_extrinsics.h"
#include "devices/recorded/recording_intrinsics.h"
#include "engine/types/error.h"
#include "engine/types/number_text.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace fathom {

bool GivenLenses::keepsRelation() const {
    if (options_.intrinsics.empty()) {
        return true;
    }
    return !readIntrinsics(options_.intrinsics, ScaleRule::Unchecked).relatesColour;
}

ImageStream GivenLenses::withLens(const ImageStream& depth, const ImageStream& colour) const {
    ImageStream given = depth;
    given.lens = readIntrinsics(options_.intrinsics, ScaleRule::Unchecked).camera.depth;
    given.raw = *given.lens;
    // A calibration of one camera differs little from the lens that the recording states.
    constexpr double kMaxOther = 0.1;
    const double x = given.lens->fx / colour.lens->fx, y = given.lens->fy / colour.lens->fy;
    const bool alike = depth.width == colour.width && depth.height == colour.height &&
                       std::max(std::abs(x - 1.0), std::abs(y - 1.0)) <= kMaxOther;
    if (alike && (sharesFrame(depth, colour) || namedRegistered(depth.name))) {
        given.lens = colour.lens;
        given.raw = colour.raw;
        given.rectified = colour.rectified;
    }
    return given;
}

void GivenLenses::replaceIn(StreamChoice& choice) const {
    const auto rule = choice.depth.metres || options_.scale ? ScaleRule::Unchecked : ScaleRule::Optional;
    const RecordingIntrinsics given = readIntrinsics(options_.intrinsics, rule);
    const auto fits = [&](const ImageStream& stream, const Intrinsics& lens) {
        if (stream.width != lens.width || stream.height != lens.height) {
            throw BadInput(options_.intrinsics.string(), "width, height", sizeText(lens.width, lens.height),
                           sizeText(stream.width, stream.height) + ", the images of " + stream.name);
        }
    };
    fits(choice.depth, given.camera.depth);
    const CameraInfo recorded = choice.camera;
    choice.camera = given.camera;
    choice.statedUnit = given.scale;
    choice.unreadScale = given.unreadScale;
    choice.unitWarning = given.unitWarning;
    std::ranges::copy(given.warnings, std::back_inserter(choice.warnings));
    choice.rangeImages = given.rangeImages;
    choice.camera.poseless = true;
    choice.camera.hasColour = recorded.hasColour;
    if (recorded.hasColour && !recorded.registered && keepsRelation()) {
        choice.camera.registered = false;
        choice.camera.colour = recorded.colour;
        choice.camera.colourTdepth = recorded.colourTdepth;
    }
    if (recorded.hasColour) {
        fits(*choice.colour, choice.camera.colour);
    }
    if (!options_.extrinsics.empty()) {
        choice.camera.registered = false;
        choice.camera.colourTdepth = readExtrinsics(options_.extrinsics);
    }
}

} // namespace fathom
