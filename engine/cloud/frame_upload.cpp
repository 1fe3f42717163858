// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/frame_upload.h"

#include "engine/types/error.h"

#include <cstring>

namespace fathom::cloud {

namespace {

template <class T>
void put(const gpu::Buffer& buffer, std::span<const T> from, uint64_t bytes, const char* what) {
    if (from.size_bytes() < bytes) {
        throw Error(std::string("frame: ") + what + " image of " + std::to_string(from.size_bytes()) +
                    " bytes, needs " + std::to_string(bytes));
    }
    if (!buffer.imported()) {
        std::memcpy(buffer.as<std::byte>().data(), from.data(), bytes);
    }
}

} // namespace

void uploadFrame(const UploadBuffers& slot, const Frame& frame, const shared::FrameParams& params) {
    const uint64_t pixels = static_cast<uint64_t>(params.size.x) * params.size.y;
    put(slot.depth, frame->depth, pixels * 2, "depth");
    if (slot.colour) {
        const uint64_t words = uint64_t{params.colourSize.x} * params.colourSize.y / (slot.yuyv ? 2 : 1);
        put(slot.colour, frame->colours(slot.yuyv), 4 * words, slot.yuyv ? "YUYV" : "colour");
    }
    *slot.params.as<shared::FrameParams>().data() = params;
}

} // namespace fathom::cloud
