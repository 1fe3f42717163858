// SPDX-License-Identifier: Apache-2.0
// Ray-cast RGB-D camera on an analytic scene, with the errors of a real one and exact ground truth.
#pragma once

#include "devices/camera.h"
#include "devices/frame_slots.h"
#include "devices/simulated/counter_noise.h"
#include "devices/simulated/ray_caster.h"

#include <array>
#include <vector>

namespace fathom {

// Properties of the camera; equal options give equal frames.
struct SimulatedCameraOptions {
    uint32_t width = 640, height = 480; // [pixels] 1..3840 x 1..2160
    double focal = 0.0;                 // [pixels]; 0 = 570/640 of the width
    uint32_t frames = 240;              // frames 0 .. frames - 1, then the camera ends
    uint32_t firstFrame = 0;            // where it starts
    double metresPerUnit = 0.001;       // 0.001 or 0.0001
    bool noise = true;                  // depth noise, dropouts, flying pixels, colour noise
    bool water = true;                  // attenuation, backscatter, snow; only in scenes that are underwater
    bool motion = true;                 // the slow sway
    bool yuyv = false;                  // colour as a USB camera sends it; an even width
    double dropShare = 0.01;            // of the pixels without a reading, with noise
    uint64_t seed = 1;
    uint32_t threads = 2; // 1..16 render threads
    Pose baseTscene;      // base_T_camera of the first frame
};

// Every pixel of a frame is a pure function of (scene, options, frame number): the thread count is none of
// its inputs. Frame j shows the scene at j / 30 s from a known pose. Sway: 20, 12, 15 mm and 1.2, 1.5, 0.8
// degrees about x, y, z, periods 7..13 s, identity at t = 0. Depth noise: normal, sigma = 0.3 depthSigma(z)
// (a good camera), rounded to units; at a jump of over 2 % half the pixels fly between the two surfaces.
class SimulatedCamera final : public Camera {
public:
    static constexpr double kFrameRate = 30.0;      // [Hz]
    static constexpr double kDepthSigmaShare = 0.3; // of depthSigma()
    static constexpr double kFlyingJump = 0.02;     // relative
    static constexpr double kFlyingShare = 0.5;     // of the pixels next to a jump

    // Throws Error when an option is out of range.
    SimulatedCamera(AnalyticScene scene, SimulatedCameraOptions options);

    const CameraInfo& info() const override { return info_; }
    // Renders on the calling thread and threads - 1 more. Throws Error when more than kFramesInFlight + 2
    // leases live.
    std::optional<Frame> next() override;
    uint32_t skipped() const override { return 0; }
    void showArm(std::span<const Sphere> spheres) override;
    std::string description() const override { return "simulated " + caster_.scene().name; }

    const AnalyticScene& scene() const { return caster_.scene(); }
    Pose poseAt(uint32_t frame) const; // base_T_camera
    Pose sceneTcamera(uint32_t frame) const;

    // Truth without noise, water or rounding. Any thread; costs about as much as a frame.
    struct ExactView {
        std::vector<double> depth;  // [m] along the optical axis, 0 = no surface; row-major
        std::vector<int16_t> solid; // index into scene().solids, -1 = none
    };
    ExactView exactView(uint32_t frame) const;

private:
    void traceRow(uint32_t row);
    void writeRow(uint32_t row, uint32_t frame, FrameSlot& slot) const;
    uint16_t sensedDepth(uint32_t pixel, uint32_t frame) const;
    double acrossJump(uint32_t pixel) const; // depth of the neighbour across the largest jump, 0 = none
    glm::vec3 smoothColour(uint32_t pixel) const;
    uint32_t sensedColour(uint32_t pixel, uint32_t frame) const;
    void drawSnow(uint32_t frame, FrameSlot& slot) const;
    uint16_t toUnits(double depth) const;

    SimulatedCameraOptions options_;
    CameraInfo info_;
    RayCaster caster_;
    FrameSlots slots_;
    NormalTable normal_;
    std::array<uint8_t, 4096> srgb_; // of linear light i / 4095
    uint32_t nextFrame_;

    // The frame at work, exact.
    std::vector<double> depth_;
    std::vector<int16_t> solid_;
    std::vector<glm::vec3> colour_; // linear
};

} // namespace fathom
