// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/frame_upload.h"

#include "engine/types/error.h"

#include <cstring>

namespace fathom::cloud {

namespace {

void put(const gpu::Buffer& buffer, std::span<const std::byte> from, uint64_t bytes, const char* what) {
    if (from.size() < bytes) {
        throw Error(std::string("frame: ") + what + " image of " + std::to_string(from.size()) +
                    " bytes, needs " + std::to_string(bytes));
    }
    if (!buffer.imported()) {
        std::memcpy(buffer.as<std::byte>().data(), from.data(), bytes);
    }
}

} // namespace

std::span<const std::byte> colourOf(const Frame& frame, ColourFormat format, uint32_t width,
                                    uint32_t height) {
    const RawColour& raw = frame->raw;
    const bool same =
        raw.format == format && (!frame->isRaw() || (raw.width == width && raw.height == height));
    return same ? frame->colourBytes() : std::span<const std::byte>();
}

void uploadFrame(const UploadBuffers& slot, const Frame& frame, const shared::FrameParams& params) {
    const uint64_t pixels = static_cast<uint64_t>(params.size.x) * params.size.y;
    put(slot.depth, std::as_bytes(frame->depth), pixels * 2, "depth");
    shared::FrameParams& out = *slot.params.as<shared::FrameParams>().data();
    out = params;
    if (slot.colour) {
        RawColour image{slot.format, params.colourSize.x, params.colourSize.y, {}, frame->raw.planes};
        image.bytes = colourOf(frame, slot.format, image.width, image.height);
        put(slot.colour, image.bytes, image.needed(),
            slot.format == ColourFormat::Rgba ? "colour" : nameOf(slot.format));
        const ColourPlanes& p = image.planes;
        out.planes = {p.lumaStep, p.blue, p.red, p.chromaStep};
        out.chroma = {p.across, p.down, p.apart, isDark(image) ? params.chroma.w : 0};
    }
}

} // namespace fathom::cloud
