// SPDX-License-Identifier: Apache-2.0
// Base of cameras that change what another camera delivers.
#pragma once

#include "devices/camera.h"

#include <memory>
#include <utility>

namespace fathom {

// Passes everything on. Derived classes override what they change.
class CameraDecorator : public Camera {
public:
    explicit CameraDecorator(std::unique_ptr<Camera> source)
        : source_(std::move(source)) {}

    const CameraInfo& info() const override { return source_->info(); }
    std::optional<Frame> next() override { return source_->next(); }
    uint32_t skipped() const override { return source_->skipped(); }
    std::vector<std::string> warnings() const override { return source_->warnings(); }
    bool live() const override { return source_->live(); }
    uint64_t lost() const override { return source_->lost(); }
    void showArm(std::span<const Sphere> spheres) override { source_->showArm(spheres); }
    uint32_t frameCount() const override { return source_->frameCount(); }
    uint32_t firstFrame() const override { return source_->firstFrame(); }
    bool seek(uint32_t index) override { return source_->seek(index); }
    std::optional<double> framePeriod() const override { return source_->framePeriod(); }
    std::string streams() const override { return source_->streams(); }
    std::string streamOptions() const override { return source_->streamOptions(); }
    std::string whyNoColour() const override { return source_->whyNoColour(); }
    std::shared_ptr<CameraControls> controls() const override { return source_->controls(); }
    std::vector<CameraStream> delivered() const override { return source_->delivered(); }
    bool stampsExposure() const override { return source_->stampsExposure(); }
    std::string description() const override { return source_->description(); }

protected:
    // The next calls go to `next`. Returns the source that was there.
    std::unique_ptr<Camera> replaceSource(std::unique_ptr<Camera> next) {
        return std::exchange(source_, std::move(next));
    }

private:
    std::unique_ptr<Camera> source_;
};

} // namespace fathom
