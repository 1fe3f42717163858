// SPDX-License-Identifier: Apache-2.0
// The leaves of a tool on the device, in the tool's frame.
#pragma once

#include "engine/contact/tool.h"
#include "engine/gpu/buffer.h"
#include "engine/gpu/commands.h"

#include <glm/vec4.hpp>

namespace fathom::cloud {

// One thread.
class ToolLeaves {
public:
    explicit ToolLeaves(const gpu::Device& device)
        : device_(device) {}

    // True when buffer() is another one than before. No submission may use it.
    bool fill(const Tool& tool);
    void drop() { count_ = 0; }
    // Copies the last fill() to the device, once. False when there is nothing to copy.
    bool upload(gpu::Commands& commands);

    const gpu::Buffer& buffer() const { return leaves_; } // vec4 per leaf: centre and radius
    uint32_t count() const { return count_; }
    const glm::vec4& bound() const { return bound_; } // encloses all leaves
    double radius() const { return radius_; }         // [m] Tool::boundingRadius()

private:
    const gpu::Device& device_;
    gpu::Buffer leaves_, written_; // the host writes the second one
    bool changed_ = false;
    uint32_t count_ = 0;
    glm::vec4 bound_{0.0f};
    double radius_ = 0.0;
};

} // namespace fathom::cloud
