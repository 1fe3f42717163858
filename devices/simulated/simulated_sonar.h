// SPDX-License-Identifier: Apache-2.0
// An imaging 3D sonar on an analytic scene: range and strength of the first echo of each beam, no colour.
#pragma once

#include "devices/camera.h"
#include "devices/frame_slots.h"
#include "devices/simulated/counter_noise.h"
#include "devices/simulated/ray_caster.h"

#include <vector>

namespace fathom {

// Parameters of the sonar; equal options give equal frames.
struct SimulatedSonarOptions {
    uint32_t width = 160, height = 120; // beams, 1..1024 each
    double step = 0.0054541539;         // [rad] from beam to beam: 50 degrees across
    BeamSigma beam{0.004, 0.0005, 0.0104719755};
    uint32_t frames = 240;
    double metresPerUnit = 0.001; // of the stored ranges
    bool noise = true;            // of the range, of the strength, beams without an echo
    double dropShare = 0.01;      // of the beams: those without an echo
    uint64_t seed = 1;
    Pose baseTscene; // the sonar does not move
};

// Beam (u, v) is a pixel of a fan. Of nine rays, the axis and eight round it at the beam's half width, the
// nearest gives the range, as the first echo does; the reading has the beam's range sigma and is on the
// axis. Strength: what comes back of the rays within 30 mm of the first, by reflectivity and incidence,
// spreading loss made up for; it is the grey value of the image. Depth images hold z, not range. Every
// reading is a function of (options, frame, beam).
class SimulatedSonar final : public Camera {
public:
    // Throws Error when an option is out of range.
    SimulatedSonar(AnalyticScene scene, const SimulatedSonarOptions& options);

    const CameraInfo& info() const override { return info_; }
    std::optional<Frame> next() override;
    uint32_t skipped() const override { return 0; }
    std::optional<double> framePeriod() const override { return 0.1; }
    std::string description() const override { return "simulated " + name_; }

    // True echo of a beam; range 0 = none.
    struct Echo {
        double range = 0.0; // [m]
        dvec3 point{0.0};   // base frame [m]
        float strength = 0.0f;
        int object = -1; // row of AnalyticScene::objects
    };
    const Echo& echo(uint32_t beam) const { return echoes_[beam]; }

private:
    Echo listen(const RayCaster& caster, const Intrinsics& view, uint32_t u, uint32_t v) const;

    SimulatedSonarOptions options_;
    std::string name_;
    CameraInfo info_;
    std::vector<Echo> echoes_;
    std::vector<double> axisShare_; // z of a unit step along each beam
    FrameSlots slots_;
    NormalTable normal_;
    uint32_t frame_ = 0;
};

} // namespace fathom
