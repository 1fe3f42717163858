// SPDX-License-Identifier: Apache-2.0
// Set-up shared by the tests of the frame passes: a frame cycle on the test device whose buffers are read
// back as row-major pictures, and the pictures, cameras and scenes that the tests are run on.
#pragma once

#include "devices/simulated/simulated_camera.h"
#include "engine/cycle/frame_cycle.h"
#include "engine/reference/classify.h"
#include "engine/reference/thin.h"
#include "engine/reference/tree.h"
#include "tests/support/vulkan.h"

#include <functional>
#include <memory>
#include <string>

namespace fathom::test {

// Row-major, as a Frame holds them.
struct Picture {
    std::vector<uint16_t> depth;
    std::vector<uint32_t> colour;
};

// One frame cycle. Everything below run() speaks of the last frame; positions are in the base frame.
class CloudRig {
public:
    using Change = std::function<void(Plan&)>;
    // change: what a test alters of the plan before anything is built. readers 0: nothing may be leased while
    // a frame runs.
    CloudRig(Scene scene, CameraInfo camera, const Change& change = {}, uint32_t readers = 1);

    // captureTime < 0: 1/30 s after the one before. No pose: the scene's.
    FrameReport run(const Picture& picture, double captureTime = -1.0, const std::optional<Pose>& pose = {});

    const Scene& scene() const { return scene_; }
    const CameraInfo& camera() const { return camera_; }
    const Plan& plan() const { return plan_; }
    FrameCycle& cycle() const { return *cycle_; }
    int width() const { return static_cast<int>(camera_.depth.width); }
    int height() const { return static_cast<int>(camera_.depth.height); }

    reference::FrameView view() const;
    const cloud::FixtureSet& set() const { return *lease_; }
    const Fixtures& host() const { return lease_->host; }
    const dvec3& origin() const { return lease_->host.origin; }

    std::vector<uint32_t> listed() const; // a patch
    std::vector<uint32_t> masks() const;
    reference::PointPicture points() const; // none in patches that are not listed
    std::vector<int> forbidden() const;     // class of the forbidden point, -1 = none
    std::vector<reference::CellThinning> thinning() const;
    std::vector<reference::RegionSphere> spheres(bool held = false) const;
    std::vector<std::vector<reference::Bound>> tree() const;
    shared::FrameCounters counters() const;
    // Depths of the occlusion cells [m].
    reference::CellPicture cells() const;

private:
    template <class T>
    std::vector<T> read(const gpu::Buffer& buffer) const {
        return readBack<T>(vulkan().device, buffer);
    }
    uint32_t slot(int u, int v) const;

    Scene scene_;
    CameraInfo camera_;
    Plan plan_;
    std::unique_ptr<FrameCycle> cycle_;
    cloud::FixturePool::Lease lease_;
    Picture picture_;
    Pose pose_;
    double time_ = 0.0;
    uint32_t frames_ = 0;
};

// Cameras. Without distortion, principal point off the middle; with the lens of TUM freiburg1 scaled to the
// width.
CameraInfo pinholeCamera(uint32_t width, uint32_t height, double metresPerUnit = 0.001);
CameraInfo freiburgCamera(uint32_t width, uint32_t height, double metresPerUnit = 0.0002);

// A scene without filter, edge test, thinning and hold: one forbidden class that takes every point. Tests add
// to it.
Scene plainScene();
// count classes (1..8) that overlap, forbidden and guidance, with hue bands that wrap, gates, boxes and none.
Scene classesScene(uint32_t count);
FixtureClass forbiddenClass(const std::string& name, double radius);
FixtureClass guidanceClass(const std::string& name);

// Steps, slopes, speckles, dropouts and a colour picture of bright, dark, grey, black and white pixels.
Picture stressPicture(const CameraInfo& camera, uint64_t seed);
// Depth by a function of the pixel [m], 0 = none; colour one and the same.
Picture drawnPicture(const CameraInfo& camera, const std::function<double(int, int)>& depth,
                     uint32_t colour = 0xff2020c0);
// Depth of the plane n . p = d (camera frame) at a pixel [m].
double planeDepth(const CameraInfo& camera, int u, int v, const dvec3& normal, double d);

// A frame of a built-in scene and the camera that saw it.
struct Shot {
    CameraInfo camera;
    Picture picture;
    Pose baseTcamera;
};
Shot simulatedShot(const std::string& scene, SimulatedCameraOptions options, uint32_t frame = 0);

// Scenes, cameras and pictures between them: all sizes, lenses, units and options that the passes must take.
struct CloudCase {
    std::string name;
    Scene scene;
    CameraInfo camera;
    Picture picture;
};
std::vector<CloudCase> cloudCases();

// The test recordings, ../shared/data/NAME; empty and said so when absent.
struct RecordedShots {
    CameraInfo camera;
    std::vector<Picture> pictures;
};
RecordedShots recordedShots(const std::string& name, std::vector<uint32_t> frames);

} // namespace fathom::test
