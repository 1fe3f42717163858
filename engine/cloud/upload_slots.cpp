// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/upload_slots.h"

#include "engine/cloud/frame_upload.h"
#include "engine/types/error.h"
#include "engine/types/log.h"

#include <algorithm>

namespace fathom::cloud {

UploadSlots::UploadSlots(const gpu::Device& device, const Plan& plan, const CameraInfo& camera)
    : device_(device)
    , plan_(plan)
    , camera_(camera)
    , images_(1) {
    slots_.push_back(std::make_unique<UploadBuffers>(device, plan, camera));
}

UploadSlots::Choice UploadSlots::choose(const Frame& frame) {
    const Images images = inPlace(frame);
    if (!images.depth && !images.colour) {
        return {kCopied, false};
    }
    if (const std::optional<uint32_t> known = find(images)) {
        return {*known, false};
    }
    const std::optional<uint32_t> slot = room();
    return slot && import(*slot, images) ? Choice{*slot, true} : Choice{kCopied, false};
}

// A block counts only when it begins at the image's address: the image may have been replaced by another.
UploadSlots::Images UploadSlots::inPlace(const Frame& frame) const {
    Images images;
    if (!plan_.inPlace || refused_) {
        return images;
    }
    if (!depthRefused_ && frame->depthMemory.get() == frame->depth.data() &&
        frame->depth.size() >= camera_.depth.pixels()) {
        images.depth = frame->depthMemory;
    }
    const Intrinsics& size = camera_.colour;
    const auto colours = colourOf(frame, camera_.colourFormat, size.width, size.height);
    const RawColour image{camera_.colourFormat, size.width, size.height, {}, frame->raw.planes};
    if (plan_.colour && frame->colourMemory.get() == colours.data() && colours.size() >= image.needed()) {
        images.colour = frame->colourMemory;
    }
    return images;
}

std::optional<uint32_t> UploadSlots::find(const Images& images) const {
    for (uint32_t i = kCopied + 1; i < images_.size(); ++i) {
        if (images_[i].depth == images.depth && images_[i].colour == images.colour) {
            return i;
        }
    }
    return std::nullopt;
}

std::optional<uint32_t> UploadSlots::room() const {
    // A slot and its buffer each hold the memory once. A higher count means that the camera or a frame still
    // uses it. If one memory of a pair is gone, the pair never returns.
    const auto gone = [this](const std::shared_ptr<const void>& memory) {
        const auto slots = std::ranges::count_if(
            images_, [&](const Images& p) { return p.depth == memory || p.colour == memory; });
        return memory && memory.use_count() <= 2 * slots;
    };
    for (uint32_t i = kCopied + 1; i < images_.size(); ++i) {
        if (gone(images_[i].depth) || gone(images_[i].colour)) {
            return i;
        }
    }
    return slots_.size() < kMax ? std::optional(static_cast<uint32_t>(slots_.size())) : std::nullopt;
}

bool UploadSlots::import(uint32_t slot, const Images& images) {
    try {
        auto buffers = std::make_unique<UploadBuffers>(device_, plan_, camera_, images.depth, images.colour);
        if (slot == slots_.size()) {
            slots_.emplace_back();
            images_.emplace_back();
        }
        slots_[slot] = std::move(buffers);
        images_[slot] = images;
        return true;
    } catch (const Error& e) {
        refused_ = depthRefused_ || !images.depth || !images.colour;
        depthRefused_ = true;
        log::debug("{} copied: {}", refused_ ? "frames are" : "depth is", e.what());
        return false;
    }
}

} // namespace fathom::cloud
