// SPDX-License-Identifier: Apache-2.0
// A source whose pictures are a sonar's or a laser scanner's, and whose file does not say how sharp its beams
// are.
#pragma once

#include "devices/camera.h"

#include <memory>
#include <utility>

namespace fathom {

// The source as it is, with the beam that the scene tells of.
class BeamCamera final : public Camera {
public:
    BeamCamera(std::unique_ptr<Camera> source, const BeamSigma& beam)
        : source_(std::move(source))
        , info_(source_->info()) {
        info_.beam = beam;
    }

    const CameraInfo& info() const override { return info_; }
    std::optional<Frame> next() override { return source_->next(); }
    uint32_t skipped() const override { return source_->skipped(); }
    uint32_t images() const override { return source_->images(); }
    bool seek(uint32_t index) override { return source_->seek(index); }
    bool live() const override { return source_->live(); }
    uint64_t lost() const override { return source_->lost(); }
    std::optional<double> framePeriod() const override { return source_->framePeriod(); }
    std::string description() const override { return source_->description(); }

private:
    std::unique_ptr<Camera> source_;
    CameraInfo info_;
};

} // namespace fathom
