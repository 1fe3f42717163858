// SPDX-License-Identifier: Apache-2.0
// Computes the parameters of the passes from the scene, the camera and the frame's pose.
#pragma once

#include "engine/cloud/cloud_buffers.h"
#include "engine/scene/scene.h"
#include "shaders/shared/frame_params.h"

#include <utility>
#include <vector>

namespace fathom::cloud {

// Indices into Scene::fixtures of the point classes, in file order: bit c of a pixel's mask is fixture
// classFixtures(scene)[c].
std::vector<uint32_t> classFixtures(const Scene& scene);

// Smallest and largest raw depth value within near..far, inclusive. A tolerance of 1e-9 units absorbs the
// rounding of the quotient. Empty (first > second) when no value is in range.
std::pair<uint32_t, uint32_t> depthBand(const Scene& scene, double metresPerUnit);

// Parameters that stay the same from frame to frame. origin [m]: point of the base frame to which float32
// positions are relative. cells: edge and number across of the occlusion cells; 1 and 1 when the plan has
// none.
shared::FrameParams sceneParams(const Scene& scene, const CameraInfo& camera, const PatchLayout& layout,
                                const dvec3& origin, uint32_t cellEdge, uint32_t cellsAcross);

// Sets the rows of [R | t] of a pose.
void setRows(glm::vec4 (&rows)[3], const Pose& pose);

// Sets the pose and the times of one frame. Times wrap at 2^32 us, which keeps ages correct.
void setFrame(shared::FrameParams& params, const Pose& baseTcamera, const dvec3& origin, double captureTime,
              double previousTime);

} // namespace fathom::cloud
