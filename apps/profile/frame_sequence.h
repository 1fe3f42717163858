// SPDX-License-Identifier: Apache-2.0
// Sources of frames for the studies: analytic scenes with sensor noise, recordings, and synthetic frames with
// set properties.
#pragma once

#include "apps/profile/frame_bench.h"
#include "engine/contact/tool.h"

namespace fathom::profile {

// Appends the next `frames` valid frames of a camera, or all until it ends. `still`: the pose of frames that
// have none.
void takeFrames(Camera& camera, uint32_t frames, FrameSequence& source, const Pose& still = {});

// `frames` frames of a built-in scene with sensor noise, and their exact depth. Throws Error for an unknown
// name.
FrameSequence analyticFrames(const std::string& scene, uint32_t width, uint32_t height, uint32_t frames);

// One frame of the same scene without noise and water, its depth rounded to 0.1 mm.
FrameSequence exactFrame(const std::string& scene, uint32_t width, uint32_t height);

// Frames with colour from a second camera with the same lens, offset by 25 mm and rotated by 2 degrees.
// Some points appear at other pixels, some are hidden.
FrameSequence twoCameraFrames(const std::string& scene, uint32_t width, uint32_t height, uint32_t frames);

// The first `frames` valid frames of a recording. Throws BadInput.
FrameSequence recordedFrames(const std::filesystem::path& folder, uint32_t frames);

// A gently wavy wall 0.8 m away. In the image, `share` (0..1, whole rows from the top) is red, the next 2 %
// yellow, the rest grey. Every pixel has depth. Sensor adds the depth noise of the simulated camera (0.6 mm),
// with which thinning keeps three times as many points at 640x480.
enum class WallNoise { None, Sensor };
FrameSequence wallFrame(uint32_t width, uint32_t height, double share, WallNoise noise = WallNoise::None);

// The same frames from a camera that sends this format; the colours are packed and unpacked once.
FrameSequence sentAs(ColourFormat format, FrameSequence source);
// As YUYV, the format of most USB cameras.
FrameSequence inYuyv(FrameSequence source);

// A scene in which every point is forbidden, with R = 20 mm and without thinning, filter or hold. It gives as
// many spheres as points, in sets that support both CPU and GPU queries.
Scene everyPointScene();

// A wall of width x height points as a fixture set with as many spheres. The device must outlive it.
struct WallRig {
    FrameSequence source;
    FrameBench bench;

    WallRig(gpu::Device& device, uint32_t width, uint32_t height)
        : source(wallFrame(width, height, 1.0))
        , bench(device, everyPointScene(), source.camera) {
        bench.run(source.frames.front());
    }
    const HostFixtures& host() const { return bench.set().host; }
};

// "60 k spheres", as the source of a row.
std::string sizeName(const RegionSpheres& spheres);

// Sources of a study: the recording if the command line gives one, otherwise these analytic scenes.
std::vector<FrameSequence> studySources(const Settings& settings, const std::vector<std::string>& analytic,
                                        uint32_t frames);

// The scene file if the command line gives one. Otherwise default settings with one forbidden class (red, or
// every point of a recording) and one guidance class (yellow).
Scene studyScene(const Settings& settings);

// Throws BadInput, that names the scene or else the source, when the regions have no sphere: then there is
// nothing to measure.
void refuseEmpty(const Settings& settings, const FrameSequence& source, const RegionSpheres& spheres);

// The classes of the analytic scenes: one forbidden, what is red, and one guidance class, what is yellow.
std::vector<FixtureClass> redAndYellow();

// A tool of `leaves` equal spheres that fill a ball of 6 cm radius.
Tool ballTool(uint32_t leaves);

// base_T_tool with the tool 1 mm deep in the middle of the set's spheres, on the camera's side.
Pose touchingPose(const Tool& tool, const HostFixtures& fixtures, const Pose& baseTcamera);

} // namespace fathom::profile
