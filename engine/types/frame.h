// SPDX-License-Identifier: Apache-2.0
// One depth image with one colour image, as a move-only lease on the camera's own memory.
#pragma once

#include "engine/types/colour_format.h"
#include "engine/types/pose.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>

namespace fathom {

// [s] between frames of a run in lockstep, whatever their stamps say. Recordings are written for it.
inline constexpr double kLockstepFramePeriod = 1.0 / 30.0;

// The memory belongs to the camera. Destroying the lease returns it. Depth: width x height
// uint16 rows without gaps, 0 = no measurement. Colour: `colour` if CameraInfo::colourFormat is Rgba, else
// `raw`; the other one is empty. Both are empty when the camera has no colour.
class Frame {
public:
    // The data of a frame.
    struct Content {
        uint32_t index = 0;        // line of associations.txt from 0, or a live counter
        uint64_t sourceNumber = 0; // the source's own frame number; unchanged = the same frame again
        double captureTime = 0.0;  // [s] on the source's clock
        std::span<const uint16_t> depth;
        std::span<const uint32_t> colour; // 0xAABBGGRR
        RawColour raw;                    // as the camera sends it
        std::optional<Pose> baseTcamera;  // when the source knows it (poses.txt, simulated); else the scene's
        // Blocks of whole pages that begin at the depth and colour data, with room for
        // CameraInfo::colourBytes(), which a device may read in place.
        // Holding one prevents reuse of its address. Null, or at another address: the image is copied.
        std::shared_ptr<const void> depthMemory, colourMemory;

        bool isRaw() const { return raw.format != ColourFormat::Rgba; }
        std::span<const std::byte> colourBytes() const { return isRaw() ? raw.bytes : std::as_bytes(colour); }
        // Takes the colour from other memory with the same content, 4-byte aligned unless raw.
        void setColourBytes(std::span<const std::byte> bytes) {
            if (isRaw()) {
                raw.bytes = bytes;
            } else {
                colour = {reinterpret_cast<const uint32_t*>(bytes.data()), bytes.size() / sizeof(uint32_t)};
            }
        }
    };

    Frame() = default;
    Frame(const Content& content, std::function<void()> giveBack)
        : content_(content)
        , giveBack_(std::move(giveBack)) {}
    Frame(Frame&& other) noexcept
        : content_(other.content_)
        , giveBack_(std::exchange(other.giveBack_, nullptr)) {}
    Frame& operator=(Frame&& other) noexcept {
        std::swap(content_, other.content_);
        std::swap(giveBack_, other.giveBack_);
        return *this;
    }
    ~Frame() {
        if (giveBack_) {
            giveBack_();
        }
    }

    // Sets another capture time [s]: lockstep uses its own clock.
    void retime(double captureTime) { content_.captureTime = captureTime; }

    const Content* operator->() const { return &content_; }
    const Content& operator*() const { return content_; }

private:
    Content content_;
    std::function<void()> giveBack_;
};

} // namespace fathom
