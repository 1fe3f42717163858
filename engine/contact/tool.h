// SPDX-License-Identifier: Apache-2.0
// The tool that the pilot moves: a sphere tree in the tool frame.
#pragma once

#include "engine/types/sphere_tree.h"

#include <vector>

namespace fathom {

class Tool {
public:
    // Throws Error when the tree is invalid. Leaves are the used slots of the last level, in that
    // order; 1..4096.
    explicit Tool(SphereTree tree);

    const SphereTree& tree() const { return tree_; }
    size_t leafCount() const { return leaves_.size(); }
    const std::vector<Sphere>& leaves() const { return leaves_; } // tool frame [m]
    double boundingRadius() const { return boundingRadius_; }     // about the origin, leaf radii included [m]
    // k0 = max(gyration radius of the leaf centres about the origin, largest leaf radius) [m]; sizes the
    // springs.
    double gyrationRadius() const { return gyrationRadius_; }

private:
    SphereTree tree_;
    std::vector<Sphere> leaves_;
    double boundingRadius_ = 0.0;
    double gyrationRadius_ = 0.0;
};

// Leaf centres at a pose, about an origin, rounded to float32 once. The CPU and the GPU cull use the same
// values.
struct PosedLeaves {
    std::vector<float> x, y, z, radius; // [m]
    glm::vec3 centre(size_t leaf) const { return {x[leaf], y[leaf], z[leaf]}; }
};
void poseLeaves(const Tool& tool, const Pose& baseTtool, const dvec3& origin, PosedLeaves& out);

} // namespace fathom
