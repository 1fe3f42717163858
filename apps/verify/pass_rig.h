// SPDX-License-Identifier: Apache-2.0
// Frames through the passes on a Vulkan device, with every buffer read back as row-major frames, so that
// each pass can be compared with its float64 twin fed by what that pass was fed.
#pragma once

#include "apps/verify/pack_colour.h"
#include "engine/cycle/frame_cycle.h"
#include "engine/reference/classify.h"
#include "engine/reference/thin.h"
#include "engine/reference/tree.h"

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace fathom::verify {

// Row-major, as a Frame holds them.
struct Image {
    std::vector<uint16_t> depth;
    std::vector<uint32_t> colour; // 0xAABBGGRR
};

// Results of the passes for the last frame: class bits per pixel, and points in the base frame, none in
// patches that are not listed. set: the fixture set of that frame.
std::vector<uint32_t> masksOf(gpu::Device& device, const FrameCycle& cycle, const CameraInfo& camera);
reference::PointImage pointsOf(gpu::Device& device, const FrameCycle& cycle, const cloud::FixtureSet& set,
                               const CameraInfo& camera);
// Depths of the occlusion cells [m]; needs Plan::occlusion.
reference::CellImage cellsOf(gpu::Device& device, const FrameCycle& cycle);

// One frame cycle. The functions below run() return results of the last frame; positions are in the base
// frame. The device must outlive it. One thread.
class PassRig {
public:
    using Change = std::function<void(Plan&)>;
    // change: alters the plan before anything is built. readers 0: nothing may be leased while
    // a frame runs.
    PassRig(gpu::Device& device, Scene scene, const CameraInfo& camera, const Change& change = {},
            uint32_t readers = 1);

    // captureTime < 0: 1/30 s after the previous frame. No pose: the scene's. The colours are packed to the
    // camera's format; view() then has the unpacked colours.
    FrameReport run(Image image, double captureTime = -1.0, const std::optional<Pose>& pose = {});

    const Scene& scene() const { return scene_; }
    const CameraInfo& camera() const { return camera_; }
    const Plan& plan() const { return plan_; }
    const PatchLayout& layout() const { return cycle_->layout(); }
    FrameCycle& cycle() const { return *cycle_; }
    int width() const { return static_cast<int>(camera_.depth.width); }
    int height() const { return static_cast<int>(camera_.depth.height); }

    reference::FrameView view() const;
    const cloud::FixtureSet& set() const { return *lease_; }
    const HostFixtures& host() const { return lease_->host; }
    const dvec3& origin() const { return lease_->host.origin; }

    std::vector<uint32_t> listed() const; // per patch
    std::vector<uint32_t> masks() const;
    reference::PointImage points() const; // none in patches that are not listed
    std::vector<int> forbidden() const;   // class of the forbidden point, -1 = none
    std::vector<reference::CellThinning> thinning() const;
    // Per pixel, as published: spheres of points seen now, or of points held from earlier frames.
    std::vector<reference::RegionSphere> spheres(bool held = false) const;
    // The same from the device's slots: whole spheres with Plan::tree, else radii and points; none with
    // Plan::pack alone. Classes are -1 with pack.
    std::vector<reference::RegionSphere> slotSpheres(bool held = false) const;
    std::vector<std::vector<reference::Bound>> tree() const; // needs Plan::tree
    shared::FrameCounters counters() const;
    reference::CellImage cells() const; // of occlusion

private:
    std::vector<glm::vec4> slots(bool held) const;
    uint32_t slot(int u, int v) const {
        return slotOfPixel(static_cast<uint32_t>(u), static_cast<uint32_t>(v), layout().across);
    }

    gpu::Device& device_;
    Scene scene_;
    CameraInfo camera_;
    Plan plan_;
    std::unique_ptr<FrameCycle> cycle_;
    cloud::FixturePool::Lease lease_;
    Image image_;
    PackedColour packed_;
    Pose pose_;
    uint32_t frames_ = 0;
};

} // namespace fathom::verify
