// SPDX-License-Identifier: Apache-2.0
// A camera with one frame that counts when it is given back.
#pragma once

#include "devices/camera.h"

#include <vector>

namespace fathom::testing {

class OneFrame final : public Camera {
public:
    // colours: the bytes in the format that `info` names; empty without colour.
    OneFrame(const CameraInfo& info, std::vector<uint16_t> depth, std::vector<uint32_t> colours = {})
        : info_(info)
        , depth_(std::move(depth))
        , colours_(std::move(colours)) {}
    const CameraInfo& info() const override { return info_; }
    std::optional<Frame> next() override {
        if (done_) {
            return std::nullopt;
        }
        done_ = true;
        Frame::Content content;
        content.depth = depth_;
        content.raw = {info_.colourFormat, info_.colour.width, info_.colour.height, {}};
        content.setColourBytes(std::as_bytes(std::span(colours_)));
        return Frame(content, [this] { ++returned; });
    }
    uint32_t skipped() const override { return 0; }
    std::string description() const override { return "test"; }
    int returned = 0;

private:
    CameraInfo info_;
    std::vector<uint16_t> depth_;
    std::vector<uint32_t> colours_;
    bool done_ = false;
};

} // namespace fathom::testing
