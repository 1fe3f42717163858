// SPDX-License-Identifier: Apache-2.0
// Adds beam parameters to a sonar or laser scan whose file has none.
#pragma once

#include "devices/camera.h"

#include <memory>
#include <utility>

namespace fathom {

// The unchanged source with the beam of the scene.
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
    std::vector<std::string> warnings() const override { return source_->warnings(); }
    uint32_t images() const override { return source_->images(); }
    uint32_t firstImage() const override { return source_->firstImage(); }
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
