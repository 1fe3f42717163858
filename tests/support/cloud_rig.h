// SPDX-License-Identifier: Apache-2.0
// Set-up shared by the tests of the frame passes: a rig on the test device, and the frames, cameras and
// scenes that the tests are run on.
#pragma once

#include "apps/verify/pass_rig.h"
#include "devices/simulated/simulated_camera.h"
#include "tests/support/vulkan.h"

#include <functional>
#include <string>

namespace fathom::test {

using verify::Image;

// On the device of all tests.
struct CloudRig : verify::PassRig {
    CloudRig(Scene scene, const CameraInfo& camera, const Change& change = {}, uint32_t readers = 1)
        : PassRig(vulkan().device, std::move(scene), camera, change, readers) {}
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

// Steps, slopes, speckles, dropouts and a colour image of bright, dark, grey, black and white pixels.
Image stressImage(const CameraInfo& camera, uint64_t seed);
// Depth by a function of the pixel [m], 0 = none; colour one and the same.
Image drawnImage(const CameraInfo& camera, const std::function<double(int, int)>& depth,
                 uint32_t colour = 0xff2020c0);
// Depth of the plane n . p = d (camera frame) at a pixel [m].
double planeDepth(const CameraInfo& camera, int u, int v, const dvec3& normal, double d);

// A frame of a built-in scene and the camera that saw it.
struct Shot {
    CameraInfo camera;
    Image image;
    Pose baseTcamera;
};
Shot simulatedShot(const std::string& scene, SimulatedCameraOptions options, uint32_t frame = 0);

// Scenes, cameras and frames between them: all sizes, lenses, units and options that the passes must take.
struct CloudCase {
    std::string name;
    Scene scene;
    CameraInfo camera;
    Image image;
};
std::vector<CloudCase> cloudCases();

// The test recordings, ../shared/data/NAME; empty and said so when absent.
struct RecordedShots {
    CameraInfo camera;
    std::vector<Image> images;
};
RecordedShots recordedShots(const std::string& name, std::vector<uint32_t> frames);

} // namespace fathom::test
