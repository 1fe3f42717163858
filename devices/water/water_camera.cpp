// SPDX-License-Identifier: Apache-2.0
#include "devices/water/water_camera.h"

#include "engine/types/error.h"

#include <algorithm>
#include <cmath>

namespace fathom {

WaterCamera::WaterCamera(std::unique_ptr<Camera> source, const FlatPort& port, double nearZ, double farZ)
    : source_(std::move(source))
    , info_(source_->info())
    , slots_(info_.depth.pixels(), false, kFramesInFlight + 1) {
    if (!info_.depth.pinhole() || (info_.hasColour && !info_.colour.pinhole())) {
        throw BadInput(source_->description(), "camera.port", "a lens with distortion",
                       "images without lens distortion, or intrinsics calibrated in water and no port");
    }
    try {
        WaterLens depth = inWater(info_.depth, port, nearZ, farZ);
        double worst = depth.worst;
        if (info_.hasColour && !info_.registered) {
            const WaterLens colour = inWater(info_.colour, port, nearZ, farZ);
            info_.colour = colour.lens;
        } else {
            info_.colour = depth.lens;
        }
        info_.depth = depth.lens;
        info_.sigma = std::hypot(info_.sigma, worst / 3.0);
        info_.inWater = true;
        factor_ = std::move(depth.factor);
    } catch (const BadInput&) {
        throw;
    } catch (const Error& e) {
        throw BadInput(source_->description(), "camera.port", e.what(), "at most 120 degrees in air");
    }
    distance_ = static_cast<float>(port.distance / info_.metresPerUnit);
}

std::optional<Frame> WaterCamera::next() {
    std::optional<Frame> frame = source_->next();
    if (!frame) {
        return std::nullopt;
    }
    FrameSlot* slot = slots_.acquire();
    if (slot == nullptr) {
        throw Error(description() + ": all frame buffers are leased");
    }
    const std::span<const uint16_t> in = (*frame)->depth;
    const std::span<uint16_t> out = slot->depth();
    for (size_t i = 0; i < factor_.size(); ++i) {
        const float z = distance_ + factor_[i] * (static_cast<float>(in[i]) - distance_);
        out[i] = in[i] == 0 ? uint16_t{0} : static_cast<uint16_t>(std::clamp(z + 0.5f, 1.0f, 65535.0f));
    }
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
