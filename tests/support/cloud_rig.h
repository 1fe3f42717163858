// SPDX-License-Identifier: Apache-2.0
// Set-up for the tests of the frame passes: a rig on the test device, and frames, cameras and scenes.
#pragma once

#include "apps/verify/pass_rig.h"
#include "devices/simulated/simulated_camera.h"
#include "engine/contact/tool.h"
#include "tests/support/vulkan.h"

#include <functional>
#include <string>

namespace fathom::testing {

using verify::Image;

// Runs on the shared test device.
struct CloudRig : verify::PassRig {
    CloudRig(Scene scene, const CameraInfo& camera, const Change& change = {}, uint32_t readers = 1)
        : PassRig(vulkan().device, std::move(scene), camera, change, readers) {}
};

// The contact query on the GPU. pack: the form of `spheres` for GPUs, else the one for CPU devices.
CloudRig::Change queriedByGpu(bool pack);
// A tool of leaves of 2 to 10 mm at random in a cube of 2 `size`.
Tool leafyTool(size_t leaves, double size);

// Cameras: one without distortion and the principal point off the middle; one with the lens of TUM freiburg1
// scaled to the width.
CameraInfo pinholeCamera(uint32_t width, uint32_t height, double metresPerUnit = 0.001);
CameraInfo freiburgCamera(uint32_t width, uint32_t height, double metresPerUnit = 0.0002);

// A scene without filter, edge test, thinning and hold: one forbidden class that accepts every point. Tests
// extend it.
Scene plainScene();
// A scene with `count` (1..8) overlapping classes, forbidden and guidance: with wrapping hue bands, gates,
// boxes, or no gates.
Scene classesScene(uint32_t count);
FixtureClass forbiddenClass(const std::string& name, double radius);
FixtureClass guidanceClass(const std::string& name);

// Steps, slopes, speckles, dropouts and a colour image of bright, dark, grey, black and white pixels.
Image stressImage(const CameraInfo& camera, uint64_t seed);
// An image of one colour, with depth [m] as a function of the pixel, 0 = none.
Image drawnImage(const CameraInfo& camera, const std::function<double(int, int)>& depth,
                 uint32_t colour = 0xff2020c0);
// Depth of the plane n . p = d (camera frame) at a pixel [m].
double planeDepth(const CameraInfo& camera, int u, int v, const dvec3& normal, double d);

// A frame of a built-in scene, with its camera.
struct Shot {
    CameraInfo camera;
    Image image;
    Pose baseTcamera;
};
Shot simulatedShot(const std::string& scene, SimulatedCameraOptions options, uint32_t frame = 0);

// Cases that together cover all sizes, lenses, units and options that the passes must support.
struct CloudCase {
    std::string name;
    Scene scene;
    CameraInfo camera;
    Image image;
};
std::vector<CloudCase> cloudCases();

// The test recordings in ../shared/data/NAME; empty with a message when absent.
struct RecordedShots {
    CameraInfo camera;
    std::vector<Image> images;
};
RecordedShots recordedShots(const std::string& name, std::vector<uint32_t> frames);

} // namespace fathom::testing
