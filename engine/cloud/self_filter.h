// SPDX-License-Identifier: Apache-2.0
// Self-filter: points inside the arm's spheres belong to no class. classify.comp applies it; this file writes
// its input.
#pragma once

#include "engine/cloud/cloud_buffers.h"
#include "engine/types/sphere_tree.h"

#include <vector>

namespace fathom::cloud {

// Base frame [m], padding included. Spheres of one link are contiguous.
struct ArmSpheres {
    std::vector<Sphere> spheres;
    std::vector<uint32_t> ends; // per link: end of its spheres

    static constexpr size_t kMaxSpheres = kMaxLeaves, kMaxLinks = 256;
    static constexpr size_t kMaxEntries = 1 + 2 * kMaxLinks + kMaxSpheres; // vec4 entries in the buffer
};

// Writes the arm to the slot's buffer, relative to `origin`. The slot's last submission must have completed.
// Throws Error when there are too many spheres or links.
void uploadArm(const UploadBuffers& slot, const ArmSpheres& arm, const dvec3& origin);

} // namespace fathom::cloud
