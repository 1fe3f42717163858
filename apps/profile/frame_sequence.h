// SPDX-License-Identifier: Apache-2.0
// Where the images of a study come from: analytic scenes with sensor noise, recordings, images made to
// measure.
#pragma once

#include "apps/profile/frame_bench.h"
#include "engine/contact/tool.h"

namespace fathom::profile {

// `frames` images of a built-in scene with sensor noise and their truth. Throws Error for an unknown name.
FrameSequence analyticFrames(const std::string& scene, uint32_t width, uint32_t height, uint32_t frames);

// The same with the colour of a second camera, 25 mm beside the first and turned by 2 degrees: it sees some
// points in other places and others not at all. Both lenses are the same.
FrameSequence twoCameraFrames(const std::string& scene, uint32_t width, uint32_t height, uint32_t frames);

// The first `frames` good images of a recording. Throws BadInput.
FrameSequence recordedFrames(const std::filesystem::path& folder, uint32_t frames);

// A gently waved wall 0.8 m away. Of the image, `share` (0..1, whole rows from the top) shows red, the next
// 2 % yellow, the rest grey. Sensor: with the depth noise of the simulated camera (0.6 mm there), which
// thinning leaves three times as many points of at 640x480; no pixel is without a reading.
enum class WallNoise { None, Sensor };
FrameSequence wallFrame(uint32_t width, uint32_t height, double share, WallNoise noise = WallNoise::None);

// The same images of a camera that sends YUYV, their colours packed and unpacked once. Of an even width.
FrameSequence inYuyv(FrameSequence source);

// Every point of a image forbidden, R = 20 mm, and nothing left out or moved: as many spheres as points, in
// sets that the CPU's query and the GPU's can both be asked about.
Scene everyPointScene();

// What a study runs on: the recording when one was given, else these analytic scenes.
std::vector<FrameSequence> studySources(const Settings& settings, const std::vector<std::string>& analytic,
                                        uint32_t frames);

// The scene file when one was given; else the default settings with one forbidden class (red, or every point
// of a recording) and one of guidance (yellow).
Scene studyScene(const Settings& settings);

// A tool of `leaves` equal spheres that fill a ball of 6 cm.
Tool ballTool(uint32_t leaves);

// base_T_tool just in touch (1 mm deep) with the middle of the set's spheres, seen from the camera.
Pose touchingPose(const Tool& tool, const Fixtures& fixtures, const Pose& baseTcamera);

} // namespace fathom::profile
