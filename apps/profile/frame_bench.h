// SPDX-License-Identifier: Apache-2.0
// Measures a frame cycle: runs frames through it, reads its buffers back and times each step.
#pragma once

#include "apps/profile/study.h"
#include "apps/verify/pack_colour.h"
#include "devices/frame_slots.h"
#include "devices/simulated/simulated_camera.h"
#include "engine/cloud/device_query.h"
#include "engine/cycle/frame_cycle.h"
#include "engine/reference/frame_view.h"

#include <cstdint>
#include <functional>
#include <map>
#include <memory>

namespace fathom::profile {

// A frame and, for an analytic scene, the exact depth of each pixel [m] (0 = no surface).
struct SampleFrame {
    std::vector<uint16_t> depth;
    std::vector<uint32_t> colour; // 0xAABBGGRR
    verify::PackedColour packed;  // if the camera sends another format; `colour` is unpacked from it
    Pose baseTcamera;
    std::vector<double> truth;
};

// Frames of one camera.
struct FrameSequence {
    std::string name;
    CameraInfo camera;
    std::vector<SampleFrame> frames;
};

struct FrameCost {
    Cost frame;             // gpu = sum of the passes, submit = submission to result, cpu = calling thread
    Spread total;           // upload to published [ms]; for an unchanged image, until that is known
    Spread collected;       // upload until the host has the device's results, before the grid [ms]
    Spread answerable;      // upload until contact queries can be answered [ms]
    Spread upload, publish; // on the host [ms]; publish = collect, then grid
    Spread collect, grid;   // copying the device's results; building the grid over the spheres
    std::map<std::string, Spread> passes; // device time [ms]
};

// Samples of each step [ms], one per frame.
struct FrameSamples {
    std::vector<double> gpu, submit, cpu, total, collected, answerable, upload, publish, collect, grid;
    std::vector<std::vector<double>> passes;

    void add(const FrameReport& report, const Clocks& clocks);
};

// Copies the scene and the camera's data; the device must outlive it. For one thread.
class FrameBench {
public:
    using Change = std::function<void(Plan&)>;
    FrameBench(gpu::Device& device, Scene scene, const CameraInfo& camera, const Change& change = {},
               uint32_t toolLeaves = 1);

    // Runs one frame. As with a camera, the frame is in whole memory pages before timing starts.
    FrameReport run(const SampleFrame& image);
    // Runs all frames cyclically, as often as `repeats` says.
    FrameCost measure(const std::vector<SampleFrame>& frames, const Repeats& repeats);
    // The same in parts, to interleave with another bench.
    void sample(const std::vector<SampleFrame>& frames, const Repeats& repeats, FrameSamples& samples);
    FrameCost costOf(const FrameSamples& samples) const;

    // Sets the arm's spheres for later frames; no effect without Plan::selfFilter.
    void setArm(cloud::ArmSpheres arm);
    // From now on every run repeats the same frame, as from a camera without a new one.
    void holdStill() { still_ = true; }

    const Scene& scene() const { return scene_; }
    const Plan& plan() const { return plan_; }
    double colourBytesPerPixel() const; // uploaded; 0 = no class uses colour
    FrameCycle& cycle() const { return *cycle_; }
    cloud::QueryContext queryContext() const { return {&device_, plan_, cycle_->layout(), cycle_->sets()}; }
    const cloud::FixtureSet& set() const { return *lease_; } // result of the last run()

    // Data of the last frame, row-major: class bits; filtered depth along the optical axis [m] (0 = no point)
    // and points in the base frame.
    std::vector<uint32_t> masks() const;
    reference::PointImage points() const;

    // Compares the last frame with the float64 twins: all occlusion cells (to 1 um), all class bits, and the
    // points (to 20 um) of about `mostPatches` patches spread over the image, including its corners. Skips
    // values that the twins mark as unsure. Empty when they agree, otherwise names the difference.
    std::string differsFromTwins(const SampleFrame& image, size_t mostPatches = SIZE_MAX) const;
    // Compares the host's spheres with their source points: each has its own forbidden point as centre
    // (within rounding) and at least its class's radius. Empty when they agree.
    std::string spheresDiffer() const;
    // Compares count and position (to 20 um) of every guidance class with the twin. Empty when they agree.
    std::string guidanceDiffers() const;

private:
    void place(size_t at, const SampleFrame& image);
    FrameReport process(size_t at);

    gpu::Device& device_;
    Scene scene_;
    CameraInfo camera_;
    Plan plan_;
    std::unique_ptr<FrameCycle> cycle_;
    std::vector<std::unique_ptr<FrameSlot>> memory_; // frames of the current measurement
    std::vector<Frame::Content> placed_;
    cloud::FixturePool::Lease lease_;
    cloud::ArmSpheres arm_;
    uint32_t frames_ = 0;
    bool still_ = false;
};

// Regions around every measured pixel of one image: no filter, no check for flying pixels, no thinning.
HostFixtures regionsOf(gpu::Device& device, Scene scene, const CameraInfo& camera, const SampleFrame& image);

uint64_t bytesOf(const Plan& plan); // all buffers of the plan
// Bytes in use on the program's heap, which includes the buffers of a CPU device. 0 when the allocator does
// not report it (sanitizer builds).
uint64_t heapBytes();

} // namespace fathom::profile
