// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/tool_leaves.h"

#include <algorithm>

namespace fathom::cloud {

namespace {

constexpr double kBoundOutward = 1.000001; // for the rounding of the bound to float32

} // namespace

bool ToolLeaves::fill(const Tool& tool) {
    const std::vector<Sphere>& leaves = tool.leaves();
    const bool larger = leaves.size() > leaves_.bytes() / 16;
    if (larger) {
        leaves_ = gpu::Buffer(device_, leaves.size() * 16, gpu::MemoryKind::Device, "tool leaves");
        written_ = gpu::Buffer(device_, leaves.size() * 16, gpu::MemoryKind::Upload, "tool leaves");
    }
    const auto out = written_.as<glm::vec4>();
    const dvec3 centre(glm::vec3(tool.tree().nodes[0].centre));
    double radius = 0.0;
    for (size_t i = 0; i < leaves.size(); ++i) {
        out[i] = glm::vec4(glm::vec3(leaves[i].centre), static_cast<float>(leaves[i].radius));
        radius = std::max(radius, glm::distance(dvec3(out[i]), centre) + double{out[i].w});
    }
    bound_ = glm::vec4(glm::vec3(centre), static_cast<float>(radius * kBoundOutward));
    radius_ = tool.boundingRadius();
    count_ = static_cast<uint32_t>(leaves.size());
    changed_ = true;
    return larger;
}

bool ToolLeaves::upload(gpu::Commands& commands) {
    if (!changed_) {
        return false;
    }
    commands.copy(written_, leaves_, 16ull * count_);
    changed_ = false;
    return true;
}

} // namespace fathom::cloud
