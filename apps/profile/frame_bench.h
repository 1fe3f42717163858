// SPDX-License-Identifier: Apache-2.0
// One frame cycle under measurement: images go through it, its buffers can be read back, its steps are
// timed apart.
#pragma once

#include "apps/profile/study.h"
#include "devices/frame_slots.h"
#include "devices/simulated/simulated_camera.h"
#include "engine/cycle/frame_cycle.h"
#include "engine/reference/frame_view.h"

#include <cstdint>
#include <functional>
#include <map>
#include <memory>

namespace fathom::profile {

// A image and, where the scene is analytic, the exact depth behind each pixel [m] (0 = no surface).
struct SampleFrame {
    std::vector<uint16_t> depth;
    std::vector<uint32_t> colour; // 0xAABBGGRR
    std::vector<uint32_t>
        yuyv; // of a camera that sends this (CameraInfo::yuyv); `colour` is what it unpacks to
    Pose baseTcamera;
    std::vector<double> truth;
};

// Some images of one camera.
struct FrameSequence {
    std::string name;
    CameraInfo camera;
    std::vector<SampleFrame> frames;
};

struct FrameCost {
    Cost frame;   // gpu = sum of the passes, submit = submission until landed, cpu = of the calling thread
    Spread total; // upload to published [ms]; of a image that is not new, until that is known
    Spread collected;       // upload until the host has what the device made: all of it but the grid [ms]
    Spread upload, publish; // on the host [ms]; publish: collect, then grid
    Spread collect, grid;   // what the device made; the grid over its spheres
    std::map<std::string, Spread> passes; // device time [ms]
};

// Samples of each step, gathered frame by frame [ms].
struct FrameSamples {
    std::vector<double> gpu, submit, cpu, total, collected, upload, publish, collect, grid;
    std::vector<std::vector<double>> passes;

    void add(const FrameReport& report, const Clocks& clocks);
};

// Owns what it needs of scene and camera; the device must outlive it. One thread.
class FrameBench {
public:
    using Change = std::function<void(Plan&)>;
    FrameBench(gpu::Device& device, Scene scene, const CameraInfo& camera, const Change& change = {},
               uint32_t toolLeaves = 1);

    // As from a camera: the shot lies in whole pages before its time begins.
    FrameReport run(const SampleFrame& image);
    // Every shot in turn, as often as the effort says.
    FrameCost measure(const std::vector<SampleFrame>& frames, const Repeats& repeats);
    // The same in parts, to take turns with another bench.
    void sample(const std::vector<SampleFrame>& frames, const Repeats& repeats, FrameSamples& samples);
    FrameCost costOf(const FrameSamples& samples) const;

    // The arm that images show from now on; nothing happens without Plan::selfFilter.
    void setArm(cloud::LinkSpheres arm);
    // From now on every image is the same one again, as of a camera that has nothing new.
    void holdStill() { still_ = true; }

    const Scene& scene() const { return scene_; }
    const Plan& plan() const { return plan_; }
    FrameCycle& cycle() const { return *cycle_; }
    const cloud::FixtureSet& set() const { return *lease_; } // of the last run()

    // Of the last frame, row-major: class bits, filtered depth along the optical axis [m] (0 = no point),
    // base points.
    std::vector<uint32_t> masks() const;
    reference::PointImage points() const;

    // Compares occlusion cells, class bits and points of the last frame with the float64 twins. Empty when
    // they agree (cells to 1 um, points to 20 um; what the twins call unsure is left out), else what differs.
    // Cells are all compared, class bits are compared of every pixel, points of `mostPatches` patches spread
    // over the image, its corners among them.
    std::string differsFromTwins(const SampleFrame& image, size_t mostPatches = SIZE_MAX) const;
    // Compares the host's spheres with the points that they came from: each stands about a forbidden point of
    // its own, no farther than rounding, with at least its class's radius. Empty when they agree.
    std::string spheresDiffer() const;
    // Compares count and position (to 20 um) of every guidance class with the twin's. Empty when they agree.
    std::string guidanceDiffers() const;

private:
    void place(size_t at, const SampleFrame& image);
    FrameReport process(size_t at);

    gpu::Device& device_;
    Scene scene_;
    CameraInfo camera_;
    Plan plan_;
    std::unique_ptr<FrameCycle> cycle_;
    std::vector<std::unique_ptr<FrameSlot>> memory_; // shots of the present measurement
    std::vector<Frame::Content> placed_;
    cloud::FixturePool::Lease lease_;
    cloud::LinkSpheres arm_;
    uint32_t frames_ = 0;
    bool still_ = false;
};

uint64_t bytesOf(const Plan& plan); // of all buffers that the plan has in
// Bytes of the program's heap in use. Beside the host's own memory a CPU device's buffers are in it. 0 where
// the allocator does not tell (a sanitized build).
uint64_t heapBytes();

} // namespace fathom::profile
