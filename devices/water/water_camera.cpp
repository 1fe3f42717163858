// SPDX-License-Identifier: Apache-2.0
#include "devices/water/water_camera.h"

#include <utility>

namespace fathom {

WaterCamera::WaterCamera(std::unique_ptr<Camera> source, const FlatPort& port, double nearZ, double farZ)
    : CameraDecorator(std::move(source))
    , info_(CameraDecorator::info())
    , correction_(port, info_, nearZ, farZ, CameraDecorator::description())
    , slots_(info_.depth.pixels(), false, kFramesInFlight + 1) {}

std::optional<Frame> WaterCamera::next() {
    std::optional<Frame> frame = CameraDecorator::next();
    if (!frame) {
        return std::nullopt;
    }
    FrameSlot* slot = &slots_.acquireFor(description());
    const std::span<uint16_t> out = slot->depth();
    correction_.apply((*frame)->depth, out);
    Frame::Content content = **frame;
    content.depth = out.first(info_.depth.pixels());
    slot->name(content); // depth; colour is in the source's memory
    // The source's frame lives as long as this one: its colour is still in use.
    auto held = std::make_unique<Frame>(std::move(*frame));
    return Frame(content, [slot, source = held.release()] {
        delete source;
        slot->release();
    });
}

} // namespace fathom
