// SPDX-License-Identifier: Apache-2.0
// Warns when a source lacks depth or colour that the scene needs.
#pragma once

#include "devices/camera_decorator.h"
#include "engine/scene/first_depth.h"

#include <string>
#include <vector>

namespace fathom {

// Passes frames on. Warns once per cause: a class that asks for colour where the source has none that is
// read; and in the first second, or the whole source: no depth between the scene's near and far, or colour
// images that are black while a class asks for colour.
class SourceCheck final : public CameraDecorator {
public:
    SourceCheck(std::unique_ptr<Camera> source, const Scene& scene);

    std::optional<Frame> next() override;
    std::vector<std::string> warnings() const override;

private:
    void warn(std::string text);
    void look(const Frame& frame);
    void end(); // of the first second, or of the source

    std::vector<std::string> warned_;
    FirstDepth depth_;
    bool colourSeen_ = false, done_ = false;
    std::optional<double> begin_; // [s] first capture time
};

} // namespace fathom
