// SPDX-License-Identifier: Apache-2.0
#include "apps/session/shuttle_camera.h"

#include "engine/types/error.h"

#include <algorithm>
#include <span>

namespace fathom {

ShuttleCamera::ShuttleCamera(std::unique_ptr<Camera> source, size_t count, const std::atomic<bool>& stop,
                             const std::function<void(size_t)>& progress)
    : info_(source->info())
    , description_(source->description()) {
    while (images_.size() < count && !(stop.load() && !images_.empty())) {
        const std::optional<Frame> frame = source->next();
        if (!frame) {
            break;
        }
        const Frame::Content& c = **frame;
        const std::span<const std::byte> colours = c.colourBytes();
        images_.push_back(
            {{c.depth.begin(), c.depth.end()}, {colours.begin(), colours.end()}, c.raw, c.baseTcamera});
        progress(images_.size());
    }
    warnings_ = source->warnings();
    if (images_.empty()) {
        throw Error(description_ + ": no frame");
    }
    slots_ = std::make_unique<FrameSlots>(info_.slotPixels(), info_.hasColour, kFramesInFlight + 2);
}

std::optional<Frame> ShuttleCamera::next() {
    FrameSlot* slot = &slots_->acquireFor(description());
    const size_t ticks = std::max<size_t>(1, 2 * (images_.size() - 1));
    const size_t place = shown_ % ticks;
    const Image& image = images_[place < images_.size() ? place : ticks - place];
    std::copy(image.depth.begin(), image.depth.end(), slot->depth().begin());
    const std::span<std::byte> colours =
        slot->colourBytes().first(std::min(image.colours.size(), slot->colourBytes().size()));
    std::copy_n(image.colours.begin(), colours.size(), colours.begin());
    Frame::Content content;
    content.index = shown_;
    content.sourceNumber = shown_++;
    content.depth = slot->depth().first(info_.depth.pixels());
    content.raw = image.raw;
    content.setColourBytes(colours);
    content.baseTcamera = image.baseTcamera;
    return slot->lend(content);
}

} // namespace fathom
