// SPDX-License-Identifier: Apache-2.0
// The arm's spheres where a frame shows them: what they hold is no point of any class. Done in
// classify.comp; here is what it reads.
#pragma once

#include "engine/cloud/cloud_buffers.h"
#include "engine/types/sphere_tree.h"

#include <vector>

namespace fathom::cloud {

// Base frame [m], padding included. The spheres of one link stand together.
struct LinkSpheres {
    std::vector<Sphere> spheres;
    std::vector<uint32_t> ends; // a link: end of its spheres

    static constexpr size_t kMostSpheres = 4096, kMostLinks = 256;
    static constexpr size_t kMostEntries = 1 + 2 * kMostLinks + kMostSpheres; // of the buffer
};

// Into the slot's buffer, about `origin`. The slot's last submission must have completed. Throws Error beyond
// the most spheres or links.
void uploadArm(const UploadBuffers& slot, const LinkSpheres& arm, const dvec3& origin);

} // namespace fathom::cloud
