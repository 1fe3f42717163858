// SPDX-License-Identifier: Apache-2.0
// A list of spheres on the device, in blocks with bounds, for the contact query.
#pragma once

#include "engine/cloud/fixture_set.h"
#include "engine/gpu/buffer.h"
#include "engine/gpu/commands.h"

#include <glm/vec4.hpp>
#include <span>

namespace fathom::cloud {

// One thread. Spheres are centre and radius; consecutive ones should be near each other.
class SphereBlocks {
public:
    explicit SphereBlocks(const gpu::Device& device)
        : device_(device) {}

    // True when buffer() is another one than before. No submission may use it.
    bool fill(std::span<const glm::vec4> spheres);
    // The same for the spheres of a set's frozen classes, if they changed.
    bool fillFrozen(const FixtureSet& set);
    // Copies the last fill() to the device, once. False when there is nothing to copy.
    bool upload(gpu::Commands& commands);

    const gpu::Buffer& buffer() const { return blocks_; } // vec4: the slots of all blocks, then their bounds
    uint32_t count() const { return count_; }
    uint32_t firstBound() const;

private:
    void fillBlock(std::span<const glm::vec4> spheres, glm::vec4* slots, glm::vec4& bound) const;

    const gpu::Device& device_;
    gpu::Buffer blocks_, written_; // the host writes the second one
    uint32_t count_ = 0;
    uint64_t frozenVersion_ = 0; // of the last fillFrozen()
    bool changed_ = false;
};

} // namespace fathom::cloud
