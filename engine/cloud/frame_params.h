// SPDX-License-Identifier: Apache-2.0
// The numbers that all passes of a frame read, from the scene, the camera and the frame's pose.
#pragma once

#include "engine/cloud/cloud_buffers.h"
#include "engine/scene/scene.h"
#include "shaders/shared/frame_params.h"

#include <utility>
#include <vector>

namespace fathom::cloud {

// Rows of Scene::fixtures that are classes of points, in file order: bit c of a pixel's mask is row
// classRows(scene)[c].
std::vector<uint32_t> classRows(const Scene& scene);

// Smallest and largest raw depth value whose metres lie in near..far, inclusive; 1e-9 of a unit absorbs the
// rounding of the quotient. Empty (first > second) when no value does.
std::pair<uint32_t, uint32_t> depthBand(const Scene& scene, double metresPerUnit);

// What does not change from frame to frame. origin: base frame [m], what float32 positions are relative to.
// cells: occlusion cells of the colour image (edge, across), 1 and 1 when the plan has none.
shared::FrameParams sceneParams(const Scene& scene, const CameraInfo& camera, const PatchLayout& layout,
                                const dvec3& origin, uint32_t cellEdge, uint32_t cellsAcross);

// Sets the pose and the times of one frame; the clock wraps at 2^32 us, ages stay right.
void setFrame(shared::FrameParams& params, const Pose& baseTcamera, const dvec3& origin, double captureTime,
              double previousTime);

} // namespace fathom::cloud
