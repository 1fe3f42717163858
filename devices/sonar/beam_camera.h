// SPDX-License-Identifier: Apache-2.0
// Adds beam parameters to a sonar or laser scan whose file has none.
#pragma once

#include "devices/camera_decorator.h"

namespace fathom {

// The unchanged source with the beam of the scene.
class BeamCamera final : public CameraDecorator {
public:
    BeamCamera(std::unique_ptr<Camera> source, const BeamSigma& beam)
        : CameraDecorator(std::move(source))
        , info_(CameraDecorator::info()) {
        info_.beam = beam;
    }

    const CameraInfo& info() const override { return info_; }

private:
    CameraInfo info_;
};

} // namespace fathom
