// SPDX-License-Identifier: Apache-2.0
#include "apps/profile/budget_sets.h"

#include "apps/profile/frame_sequence.h"
#include "apps/profile/study.h"
#include "apps/profile/wavy_wall.h"
#include "engine/contact/cull_cpu.h"
#include "engine/contact/narrow_phase.h"
#include "engine/haptics/proxy_rows.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace fathom::profile {

namespace {

constexpr double kSpacing = 0.2 / 122.5; // [m] gives 245 x 245 spheres on 40 x 40 cm
constexpr double kProblemReach = 0.01;   // [m]
constexpr double kProblemMetric = 0.05;  // [m] that one radian counts as
constexpr double kSureGap = 1e-6;        // [m] well above the float32 rounding error here

double uniform(std::mt19937_64& random, double half) { // same values on every machine
    return half * (2.0 * static_cast<double>(random() >> 11) * 0x1p-53 - 1.0);
}

dquat anyRotation(std::mt19937_64& random) {
    for (;;) { // rejection sampling: uniform over all rotations
        const double w = uniform(random, 1.0), x = uniform(random, 1.0), y = uniform(random, 1.0),
                     z = uniform(random, 1.0), square = w * w + x * x + y * y + z * z;
        if (square > 0.01 && square <= 1.0) {
            return glm::normalize(dquat(w, x, y, z));
        }
    }
}

dvec3 leafOf(const Tool& tool, size_t leaf, const Pose& pose, const dvec3& origin) {
    return (pose.position - origin) + pose.rotation * tool.leaves()[leaf].centre;
}

double gapBetween(const RegionSpheres& s, size_t sphere, const dvec3& centre, double radius) {
    const dvec3 at(double{s.x[sphere]}, double{s.y[sphere]}, double{s.z[sphere]});
    return glm::length(centre - at) - radius - double{s.radius[sphere]};
}

} // namespace

TouchRig::TouchRig(int half, uint32_t leaves, size_t count, double depth)
    : wall(wavyWall(half, kSpacing))
    , tool(ballTool(leaves)) {
    grid.build(wall.spheres);
    std::mt19937_64 random(5);
    const double middle = half * kSpacing - 0.1; // [m] keeps the tool over the wall
    for (size_t i = 0; i < count; ++i) {
        const double x = uniform(random, middle), y = uniform(random, middle);
        Pose pose{dvec3(x, y, 0.0), anyRotation(random)};
        double low = 0.0, high = 0.2;
        for (int k = 0; k < 28; ++k) {
            pose.position.z = 0.5 * (low + high);
            (smallestGap(pose, 0.001) < -depth ? low : high) = pose.position.z;
        }
        pose.position.z = high;
        poses.push_back(pose);
    }
}

double TouchRig::smallestGap(const Pose& pose, double within) const {
    double least = within;
    for (size_t i = 0; i < tool.leafCount(); ++i) {
        const dvec3 centre = leafOf(tool, i, pose, wall.origin);
        const double radius = tool.leaves()[i].radius;
        grid.forEachNear(centre, radius + grid.maxRadius() + within, [&](uint32_t sphere) {
            least = std::min(least, gapBetween(wall.spheres, sphere, centre, radius));
        });
    }
    return least;
}

std::string nearestDiffers(const TouchRig& rig, const Pose& pose, double limit,
                           const std::vector<NearestSphere>& found) {
    const RegionSpheres& s = rig.wall.spheres;
    for (size_t i = 0; i < rig.tool.leafCount(); ++i) {
        const dvec3 centre = leafOf(rig.tool, i, pose, rig.wall.origin);
        double least = HUGE_VAL;
        for (size_t k = 0; k < s.size(); ++k) {
            least = std::min(least, gapBetween(s, k, centre, rig.tool.leaves()[i].radius));
        }
        const bool any = found[i].sphere != NearestSphere::kNone;
        if (std::abs(least - limit) > kSureGap && any != (least <= limit)) {
            return "leaf " + std::to_string(i) + (any ? " has" : " misses") + " a sphere within the limit";
        }
        if (any && std::abs(gapBetween(s, found[i].sphere, centre, rig.tool.leaves()[i].radius) - least) >
                       kSureGap) {
            return "leaf " + std::to_string(i) + " has a nearer sphere";
        }
    }
    return "";
}

std::vector<ContactProblem> contactProblems(const TouchRig& rig) {
    std::vector<ContactProblem> problems;
    CullCpu cull;
    ContactSet set;
    NarrowPhase narrow(rig.tool, ContactProblem::kRows);
    LeafCentres leaves(rig.tool.leafCount());
    std::mt19937_64 random(6);
    for (const Pose& pose : rig.poses) {
        cull.query(rig.tool, pose, kProblemReach, rig.wall, rig.grid, set);
        for (size_t i = 0; i < leaves.size(); ++i) {
            leaves.set(i, leafOf(rig.tool, i, pose, set.origin));
        }
        narrow.gather(set, leaves, pose.position - set.origin, set.reach, 0.002, true);
        if (narrow.rows().size() < ContactProblem::kRows) {
            continue;
        }
        ContactProblem& p = problems.emplace_back();
        for (size_t i = 0; i < 6; ++i) {
            p.metric[i * 7] = i < 3 ? 1.0 : kProblemMetric * kProblemMetric;
            p.target[i] = uniform(random, i < 3 ? 0.001 : 0.02);
        }
        p.target[2] = -0.002;
        for (const ContactRow& row : narrow.rows()) {
            const dvec3 turning = glm::cross(row.arm, row.normal);
            p.normals.insert(p.normals.end(),
                             {row.normal.x, row.normal.y, row.normal.z, turning.x, turning.y, turning.z});
            p.offsets.push_back(proxy::kSkin - row.gap);
            p.keys.push_back(row.key);
        }
    }
    return problems;
}

} // namespace fathom::profile
