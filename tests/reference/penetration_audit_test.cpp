// SPDX-License-Identifier: Apache-2.0
#include "engine/reference/penetration_audit.h"

#include "engine/types/error.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <random>
#include <utility>
#include <vector>

using namespace fathom;

namespace {

constexpr double kExact = 1e-12; // [m]

Tool toolOf(const std::vector<Sphere>& leaves) {
    return Tool(buildSphereTree(leaves));
}

struct Scene {
    HostFixtures set;
    RegionGrid grid;
};

Scene sceneOf(const std::vector<Sphere>& spheres, uint64_t generation, const dvec3& origin = dvec3(0.0)) {
    Scene scene;
    scene.set.frame = static_cast<int64_t>(generation);
    scene.set.generation = generation;
    scene.set.origin = origin;
    for (const Sphere& sphere : spheres) {
        scene.set.spheres.add(sphere.centre, sphere.radius);
    }
    scene.grid.build(scene.set.spheres);
    return scene;
}

Pose at(double x, double y = 0.0, double z = 0.0) {
    return {{x, y, z}, {1, 0, 0, 0}};
}

// The literal definition: every leaf against every sphere in every tick.
class BruteForce {
public:
    explicit BruteForce(const Tool& tool)
        : leaves_(tool.leaves()) {}

    void tick(const HostFixtures& set, const Pose& start, const Pose& end,
              const std::vector<uint32_t>& behind) {
        const auto depth = [&](size_t leaf, size_t i, const Pose& pose) {
            const dvec3 centre = (pose.position - set.origin) + pose.rotation * leaves_[leaf].centre;
            const RegionSpheres& s = set.spheres;
            const dvec3 region(double{s.x[i]}, double{s.y[i]}, double{s.z[i]});
            return leaves_[leaf].radius + double{s.radius[i]} - glm::distance(centre, region);
        };
        if (set.generation != generation_) {
            generation_ = set.generation;
            allowed_.clear();
            for (size_t leaf = 0; leaf < leaves_.size(); ++leaf) {
                for (size_t i = 0; i < set.spheres.size(); ++i) {
                    allowed_[{leaf, set.spheres.source[i]}] = std::max(0.0, depth(leaf, i, start));
                }
            }
        }
        bool escaping = false, exemptTouch = false, beyond = false;
        for (size_t leaf = 0; leaf < leaves_.size(); ++leaf) {
            const bool exempt = std::find(behind.begin(), behind.end(), leaf) != behind.end();
            for (size_t i = 0; i < set.spheres.size(); ++i) {
                double& allowance = allowed_[{leaf, set.spheres.source[i]}];
                const double now = std::max(0.0, depth(leaf, i, end));
                if (exempt) {
                    maxBehind = std::max(maxBehind, now);
                    exemptTouch = exemptTouch || now > 0.0;
                } else {
                    maxBeyond = std::max(maxBeyond, now - allowance);
                    beyond = beyond || now > allowance;
                    maxInside = std::max(maxInside, std::min(now, allowance));
                    escaping = escaping || std::min(now, allowance) > 0.0;
                }
                allowance = std::min(allowance, now);
            }
        }
        escapeTicks += escaping;
        behindTicks += exemptTouch;
        penetrationTicks += beyond;
    }

    double maxBeyond = 0.0, maxInside = 0.0, maxBehind = 0.0;
    uint64_t escapeTicks = 0, behindTicks = 0, penetrationTicks = 0;

private:
    std::vector<Sphere> leaves_;
    std::map<std::pair<size_t, uint32_t>, double> allowed_;
    uint64_t generation_ = 0;
};

std::vector<Sphere> randomSpheres(std::mt19937_64& random, size_t count, double half, double least,
                                  double most) {
    std::uniform_real_distribution<double> place(-half, half), radius(least, most);
    std::vector<Sphere> spheres;
    for (size_t i = 0; i < count; ++i) {
        const double x = place(random), y = place(random), z = place(random);
        spheres.push_back({{x, y, z}, radius(random)});
    }
    return spheres;
}

} // namespace

TEST_CASE(
    "The audit agrees with the literal definition on random scenes, walks, new sets and exempt leaves") {
    std::mt19937_64 random(7);
    uint64_t escapes = 0;
    for (const size_t count : {size_t{0}, size_t{1}, size_t{37}, size_t{401}}) {
        for (const dvec3& origin : {dvec3(0.0), dvec3(2345.5, -871.25, 12.0)}) {
            const Tool tool = toolOf(randomSpheres(random, 23, 0.05, 0.004, 0.02));
            PenetrationAudit audit(tool);
            BruteForce brute(tool);
            Pose pose{origin, {1, 0, 0, 0}};
            std::normal_distribution<double> step(0.0, 0.0006);
            for (uint64_t generation = 1; generation <= 6; ++generation) {
                const Scene scene =
                    sceneOf(randomSpheres(random, count, 0.15, 0.005, 0.04), generation, origin);
                for (int i = 0; i < 60; ++i) {
                    const Pose start = pose;
                    // Mostly small steps, so that skipped searches in free space are tested, too.
                    const double scale = i % 9 == 8 ? 30.0 : 1.0;
                    const double x = step(random), y = step(random), z = step(random);
                    pose.position += scale * dvec3(x, y, z);
                    pose.rotation = rotationExp({step(random), step(random), 0.0}) * pose.rotation;
                    const std::vector<uint32_t> behind =
                        i % 3 == 2 ? std::vector<uint32_t>{2, 19} : std::vector<uint32_t>{};
                    audit.tick(scene.set, scene.grid, start, pose, behind);
                    brute.tick(scene.set, start, pose, behind);
                }
                pose.position = 0.5 * (pose.position + origin); // stay near the cloud
            }
            CHECK(std::abs(audit.maxPenetration() - brute.maxBeyond) < kExact);
            CHECK(std::abs(audit.maxEscapeDepth() - brute.maxInside) < kExact);
            CHECK(std::abs(audit.maxBehindDepth() - brute.maxBehind) < kExact);
            CHECK(audit.escapeTicks() == brute.escapeTicks);
            CHECK(audit.behindTicks() == brute.behindTicks);
            CHECK(audit.penetrationTicks() == brute.penetrationTicks);
            CHECK(audit.ticks() == 360);
            escapes += audit.escapeTicks();
        }
    }
    CHECK(escapes > 100); // the scenes do exercise escapes
}

TEST_CASE("A tool that backs out of a region that caught it uses its allowance and never penetrates") {
    const Tool tool = toolOf({{{0, 0, 0}, 0.01}});
    const Scene scene = sceneOf({{{0, 0, 0}, 0.04}}, 1);
    PenetrationAudit audit(tool);
    for (int i = 0; i < 20; ++i) { // from 10 mm deep outwards, 1 mm per tick
        audit.tick(scene.set, scene.grid, at(0.040 + 0.001 * i), at(0.041 + 0.001 * i));
    }
    CHECK(audit.maxPenetration() == 0.0);
    CHECK(audit.maxEscapeDepth() == doctest::Approx(0.009).epsilon(1e-6));
    // Nine ticks end inside; the tenth ends on the surface, within the rounding of the float radius.
    CHECK(audit.escapeTicks() >= 9);
    CHECK(audit.escapeTicks() <= 10);
}

TEST_CASE(
    "An allowance shrinks and never grows: going back in by 1 mm after leaving is 1 mm of penetration") {
    const Tool tool = toolOf({{{0, 0, 0}, 0.01}});
    const Scene scene = sceneOf({{{0, 0, 0}, 0.04}}, 1);
    PenetrationAudit audit(tool);
    audit.tick(scene.set, scene.grid, at(0.045), at(0.047)); // 5 mm allowed, 3 mm used
    audit.tick(scene.set, scene.grid, at(0.047), at(0.046)); // 4 mm: 1 mm beyond
    CHECK(audit.maxPenetration() == doctest::Approx(0.001).epsilon(1e-6));
    audit.tick(scene.set, scene.grid, at(0.046), at(0.060)); // outside: no allowance is left
    audit.tick(scene.set, scene.grid, at(0.060), at(0.048)); // 2 mm, all of it beyond
    CHECK(audit.maxPenetration() == doctest::Approx(0.002).epsilon(1e-6));
    CHECK(audit.penetrationTicks() == 2);
}

TEST_CASE(
    "The allowance of a new set is the depth at the pose its first tick starts from, not where it ends") {
    const Tool tool = toolOf({{{0, 0, 0}, 0.01}});
    const Scene first = sceneOf({{{0, 0, 0}, 0.04}}, 1);
    const Scene second = sceneOf({{{0.005, 0, 0}, 0.04}}, 2); // the region is 5 mm nearer
    PenetrationAudit audit(tool);
    audit.tick(first.set, first.grid, at(0.051), at(0.0505));
    CHECK(audit.maxEscapeDepth() == 0.0);
    audit.tick(second.set, second.grid, at(0.0505),
               at(0.0495)); // 4.5 mm deep at the start, 5.5 mm at the end
    CHECK(audit.maxPenetration() == doctest::Approx(0.001).epsilon(1e-6));
    CHECK(audit.maxEscapeDepth() == doctest::Approx(0.0045).epsilon(1e-6));
}

TEST_CASE("A slow approach is detected in the tick that touches, wherever the last search was") {
    const Tool tool = toolOf({{{0, 0, 0}, 0.01}});
    const Scene scene = sceneOf({{{0, 0, 0}, 0.04}}, 1);
    for (const double away : {0.0005, 0.0019, 0.0021, 0.0035, 0.0121, 0.0501}) {
        PenetrationAudit audit(tool);
        double x = 0.05 + away;
        while (x > 0.05) {
            CHECK(audit.penetrationTicks() == 0);
            audit.tick(scene.set, scene.grid, at(x), at(x - 2e-4));
            x -= 2e-4;
        }
        CHECK(audit.penetrationTicks() == 1);
    }
}

TEST_CASE("A leaf flagged behind is counted separately and not as penetration") {
    const Tool tool = toolOf({{{0, 0, 0}, 0.01}});
    const Scene scene = sceneOf({{{0, 0, 0}, 0.04}}, 1);
    PenetrationAudit audit(tool);
    const std::vector<uint32_t> behind{0};
    audit.tick(scene.set, scene.grid, at(0.06), at(0.03), behind);
    CHECK(audit.maxPenetration() == 0.0);
    CHECK(audit.escapeTicks() == 0);
    CHECK(audit.maxBehindDepth() == doctest::Approx(0.02).epsilon(1e-6));
    CHECK(audit.behindTicks() == 1);
    audit.tick(scene.set, scene.grid, at(0.03), at(0.03));
    CHECK(audit.maxPenetration() == doctest::Approx(0.02).epsilon(1e-6));
}

TEST_CASE("The audit ignores ticks before the first set and rejects a grid of another set and a NaN pose") {
    const Tool tool = toolOf({{{0, 0, 0}, 0.01}});
    const Scene scene = sceneOf({{{0, 0, 0}, 0.04}}, 1);
    const Scene other = sceneOf({{{0, 0, 0}, 0.04}, {{1, 0, 0}, 0.04}}, 2);
    PenetrationAudit audit(tool);
    audit.tick(HostFixtures{}, RegionGrid{}, at(0), at(0));
    CHECK(audit.ticks() == 0);
    CHECK_THROWS_AS(audit.tick(scene.set, other.grid, at(1), at(1)), Error);
    CHECK_THROWS_AS(audit.tick(scene.set, scene.grid, at(1), at(std::nan(""))), Error);
}

TEST_CASE("A set with a sphere that is not finite is audited without it") {
    const Tool tool = toolOf({{{0, 0, 0}, 0.01}});
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const Scene scene = sceneOf({{{nan, 0, 0}, 0.04}, {{0, 0, 0}, 0.04}}, 1);
    PenetrationAudit audit(tool);
    audit.tick(scene.set, scene.grid, at(0.06), at(0.045));
    CHECK(audit.maxPenetration() == doctest::Approx(0.005).epsilon(1e-6));
}

TEST_CASE("The audit finds no penetration of 256 leaves that move close to 60 thousand spheres") {
    std::vector<Sphere> leaves, wall;
    for (int i = 0; i < 256; ++i) {
        const int row = i / 16;
        leaves.push_back({{0.006 * (i % 16) - 0.045, 0.006 * row - 0.045, 0.0}, 0.004});
    }
    for (int v = 0; v < 200; ++v) {
        for (int u = 0; u < 300; ++u) {
            wall.push_back({{0.0015 * u - 0.225, 0.0015 * v - 0.15, 0.0}, 0.04});
        }
    }
    const Tool tool = toolOf(leaves);
    const Scene scene = sceneOf(wall, 1);
    for (const double height :
         {0.12, 0.0442}) { // far above the wall, and just above it: the regions end at 44 mm
        PenetrationAudit audit(tool);
        for (int i = 0; i < 200; ++i) {
            audit.tick(scene.set, scene.grid, at(1e-5 * i, 0, height), at(1e-5 * (i + 1), 0, height));
        }
        CHECK(audit.maxPenetration() == 0.0);
    }
}
