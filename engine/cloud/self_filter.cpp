// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/self_filter.h"

#include "engine/types/error.h"

#include <algorithm>
#include <bit>

namespace fathom::cloud {

namespace {

// Rounded outward: a point inside the sphere in float64 must be inside in float32.
glm::vec4 entryOf(const dvec3& centre, double radius) {
    return {glm::vec3(centre), static_cast<float>(radius * (1.0 + 1e-6) + 1e-6)};
}

// Bounding sphere of a link, about the middle of its spheres.
glm::vec4 boundOf(const ArmSpheres& arm, uint32_t begin, uint32_t end, const dvec3& origin) {
    dvec3 middle(0.0);
    for (uint32_t i = begin; i < end; ++i) {
        middle += arm.spheres[i].centre / static_cast<double>(end - begin);
    }
    double radius = 0.0;
    for (uint32_t i = begin; i < end; ++i) {
        radius = std::max(radius, glm::distance(middle, arm.spheres[i].centre) + arm.spheres[i].radius);
    }
    return entryOf(middle - origin, radius + 1e-5);
}

} // namespace

void uploadArm(const UploadBuffers& slot, const ArmSpheres& arm, const dvec3& origin) {
    if (arm.spheres.size() > ArmSpheres::kMaxSpheres || arm.ends.size() > ArmSpheres::kMaxLinks) {
        throw Error("self-filter: " + std::to_string(arm.spheres.size()) + " spheres on " +
                    std::to_string(arm.ends.size()) + " links are too many");
    }
    const auto out = slot.arm.as<glm::vec4>();
    const auto bits = [](size_t value) { return std::bit_cast<float>(static_cast<uint32_t>(value)); };
    const size_t first = 1 + 2 * arm.ends.size();
    out[0] = {bits(arm.ends.size()), 0.0f, 0.0f, 0.0f};
    uint32_t begin = 0;
    for (size_t k = 0; k < arm.ends.size(); ++k) {
        out[1 + 2 * k] = boundOf(arm, begin, arm.ends[k], origin);
        out[2 + 2 * k] = {bits(first + begin), bits(first + arm.ends[k]), 0.0f, 0.0f};
        begin = arm.ends[k];
    }
    for (size_t i = 0; i < arm.spheres.size(); ++i) {
        out[first + i] = entryOf(arm.spheres[i].centre - origin, arm.spheres[i].radius);
    }
}

} // namespace fathom::cloud
