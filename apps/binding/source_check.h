// SPDX-License-Identifier: Apache-2.0
// Warns when a source lacks depth or colour that the scene needs.
#pragma once

#include "devices/camera.h"
#include "engine/scene/scene.h"

#include <memory>
#include <string>
#include <vector>

namespace fathom {

// Passes frames on. Warns once per cause: a class that asks for colour where the source has none that is
// read; and in the first second, or the whole source: no depth between the scene's near and far, or colour
// images that are black while a class asks for colour.
class SourceCheck final : public Camera {
public:
    SourceCheck(std::unique_ptr<Camera> source, const Scene& scene);

    const CameraInfo& info() const override { return source_->info(); }
    std::optional<Frame> next() override;
    uint32_t skipped() const override { return source_->skipped(); }
    bool live() const override { return source_->live(); }
    uint64_t lost() const override { return source_->lost(); }
    void showArm(std::span<const Sphere> spheres) override { source_->showArm(spheres); }
    uint32_t images() const override { return source_->images(); }
    uint32_t firstImage() const override { return source_->firstImage(); }
    bool seek(uint32_t index) override { return source_->seek(index); }
    std::optional<double> framePeriod() const override { return source_->framePeriod(); }
    std::string streams() const override { return source_->streams(); }
    std::string whyNoColour() const override { return source_->whyNoColour(); }
    std::string description() const override { return source_->description(); }
    std::vector<std::string> warnings() const override;

private:
    void warn(std::string text);
    void look(const Frame& frame);
    void end(); // of the first second, or of the source
    bool inRange(std::span<const uint16_t> depth);

    std::unique_ptr<Camera> source_;
    std::vector<std::string> warned_;
    double nearZ_, farZ_; // [m]
    bool depthSeen_ = false, colourSeen_ = false, done_ = false;
    std::optional<double> begin_;          // [s] first capture time
    uint16_t least_ = 65535, largest_ = 0; // measured so far [raw]
};

} // namespace fathom
