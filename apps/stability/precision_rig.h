// SPDX-License-Identifier: Apache-2.0
// Frames through the passes on a Vulkan device, with every buffer read back as row-major pictures, so that
// each pass can be compared with its float64 twin fed by what that pass was fed.
#pragma once

#include "engine/cycle/frame_cycle.h"
#include "engine/gpu/commands.h"
#include "engine/reference/classify.h"
#include "engine/reference/thin.h"
#include "engine/reference/tree.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace fathom::stability {

struct Picture {
    std::vector<uint16_t> depth;
    std::vector<uint32_t> colour;
};

class PrecisionRig {
public:
    PrecisionRig(gpu::Device& device, Scene scene, const CameraInfo& camera);

    void run(Picture picture, double captureTime = 0.0);

    const Scene& scene() const { return scene_; }
    const CameraInfo& camera() const { return camera_; }
    const Plan& plan() const { return plan_; }
    const PatchLayout& layout() const { return cycle_->layout(); }
    int width() const { return static_cast<int>(camera_.depth.width); }
    int height() const { return static_cast<int>(camera_.depth.height); }
    const Fixtures& host() const { return lease_->host; }
    dvec3 origin() const { return lease_->host.origin; }

    // Of the last frame; positions in the base frame.
    reference::FrameView view() const;
    std::vector<uint32_t> masks() const;
    reference::PointPicture points() const;
    std::vector<int> forbidden() const;
    std::vector<reference::CellThinning> thinning() const;
    std::vector<reference::RegionSphere> spheres(bool held = false) const;
    std::vector<std::vector<reference::Bound>> tree() const;
    reference::CellPicture cells() const;

private:
    template <class T>
    std::vector<T> read(const gpu::Buffer& buffer) const;
    uint32_t slot(int u, int v) const {
        return slotOfPixel(static_cast<uint32_t>(u), static_cast<uint32_t>(v), layout().across);
    }

    gpu::Device& device_;
    Scene scene_;
    CameraInfo camera_;
    Plan plan_;
    std::unique_ptr<FrameCycle> cycle_;
    cloud::FixturePool::Lease lease_;
    Picture picture_;
    uint32_t frames_ = 0;
};

// Pinhole without distortion; depth unit so that `range` is 20 000 units.
CameraInfo cameraFor(double range, uint32_t width = 96, uint32_t height = 72);

// Near and far bounds, radii and boxes that suit a range; one forbidden class of red, one guidance class of
// everything in the left two thirds.
Scene sceneFor(double range);

// A slope with a step and waves in it, scaled to the range; noise: 0 or the relative standard deviation of a
// depth. Some pixels have none.
Picture pictureFor(const CameraInfo& camera, double range, double noise, uint64_t seed);

} // namespace fathom::stability
