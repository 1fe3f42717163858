// SPDX-License-Identifier: Apache-2.0
#include "devices/decimated/decimated_camera.h"

#include "engine/types/decimation.h"

namespace fathom {

DecimatedCamera::DecimatedCamera(std::unique_ptr<Camera> source, uint32_t n)
    : CameraDecorator(std::move(source))
    , n_(n)
    , info_(decimated(CameraDecorator::info(), n))
    , slots_(info_.depth.pixels(), info_.hasColour && info_.registered, kFramesInFlight + 1) {}

std::optional<Frame> DecimatedCamera::next() {
    std::optional<Frame> frame = CameraDecorator::next();
    if (!frame) {
        return std::nullopt;
    }
    FrameSlot* slot = &slots_.acquireFor(description());
    const CameraInfo& full = CameraDecorator::info();
    Frame::Content content = **frame;
    decimate(content.depth, full.depth, n_, slot->depth());
    content.depth = slot->depth();
    if (info_.registered && info_.hasColour) {
        RawColour image = content.raw;
        if (!content.isRaw()) {
            image = {ColourFormat::Rgba, full.colour.width, full.colour.height, content.colourBytes()};
        }
        decimateColour(image, n_, slot->colour());
        content.raw = {};
        content.colour = slot->colour();
    }
    slot->name(content);
    if (info_.registered || !info_.hasColour) { // nothing of the source's frame is in use any more
        return Frame(content, [slot] { slot->release(); });
    }
    auto held = std::make_unique<Frame>(std::move(*frame)); // its colour lives as long as this frame
    return Frame(content, [slot, source = held.release()] {
        delete source;
        slot->release();
    });
}

} // namespace fathom
