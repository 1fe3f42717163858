// SPDX-License-Identifier: Apache-2.0
// Group stiff, part four: closed paths of the hand around static contacts extract no energy, because the
// solver's metric matches the springs.
#include "apps/stability/case_text.h"
#include "apps/stability/loop_rig.h"
#include "apps/stability/stiff_cases.h"
#include "apps/stability/worlds.h"
#include "engine/reference/rng.h"
#include "engine/types/angle.h"

#include <algorithm>
#include <cmath>

namespace fathom::stability {

namespace {

// A closed path of the hand in all six degrees of freedom.
struct ClosedPath {
    dvec3 focus{0.0};
    std::array<dvec3, 2> way{}, tick{}; // [m], [rad]

    Pose at(double phase) const {
        const double a = kTurn * phase;
        const dvec3 moved = way[0] * std::sin(a) + way[1] * (std::cos(a) - 1.0);
        return {focus + moved, rotationExp(tick[0] * std::sin(2.0 * a) + tick[1] * (1.0 - std::cos(a)))};
    }
};

struct Drawn {
    double most = -1e9;  // [J] in one loop
    double least = 1e9;  // [J] negative: a loop took energy from the hand
    double stored = 0.0; // [J] largest energy of the springs
    size_t loops = 0;
};

// A scripted hand on the cycle alone: poses in, wrench out.
class LoopWalk {
public:
    LoopWalk(const Tool& tool, std::span<const Shape> shapes, const HapticOptions& options,
             const ClosedPath& path)
        : options_(options)
        , path_(path)
        , cycle_(tool, shapes, options, path.at(0.0)) {}

    // Work [J] of the wrench on the hand over one loop of `ticks` ticks. The trapezium rule excludes the
    // energy that sampling alone adds.
    double once(int ticks) {
        double drawn = 0.0;
        for (int i = 0; i <= ticks; ++i) {
            drawn += step(path_.at(static_cast<double>(i) / ticks), i > 0);
        }
        return drawn;
    }
    // Steps until the force ramp has ended.
    void warmUp() {
        for (double t = 0.0; t < 1.1 * HapticCycle::kRampTime; t += options_.period) {
            step(path_.at(0.0), false);
        }
    }
    double stored() const { return stored_; }

private:
    double step(const Pose& device, bool count) {
        const Wrench now = cycle_.step(stepInput({device}, time_)).wrench;
        time_ += options_.period;
        const dvec3 moved = device.position - was_.position;
        const dvec3 turned = rotationBetween(was_.rotation, device.rotation);
        const double work = 0.5 * (glm::dot(now.force + before_.force, moved) +
                                   glm::dot(now.torque + before_.torque, turned));
        stored_ = std::max(stored_,
                           0.5 * glm::dot(now.force, now.force) / options_.springs.stiffness +
                               0.5 * glm::dot(now.torque, now.torque) / options_.springs.rotationalStiffness);
        before_ = now;
        was_ = device;
        return count ? work : 0.0;
    }

    HapticOptions options_;
    ClosedPath path_;
    HapticCycle cycle_;
    Wrench before_;
    Pose was_;
    double time_ = 0.0, stored_ = 0.0;
};

struct Scenery {
    std::vector<Shape> shapes;
    dvec3 focus; // approximate position of the tool's centre at contact
};

Shape solid(ShapeKind kind, const dvec3& size, const Pose& pose) {
    Shape shape;
    shape.kind = kind;
    shape.size = size;
    shape.baseTshape = pose;
    return shape;
}

std::vector<Scenery> sceneries() {
    std::vector<Scenery> all;
    all.push_back({{wallShape({0.0, 0.0, 1.0}, 0.0)}, {0.0, 0.0, 0.008}});
    all.push_back({{wallShape({0.0, 0.0, 1.0}, 0.0), wallShape({1.0, 0.0, 0.0}, -0.038),
                    wallShape({0.0, 1.0, 0.0}, -0.008)},
                   {0.0, 0.0, 0.008}});
    all.push_back({{wallShape({0.6, 0.0, 0.8}, 0.0), wallShape({-0.6, 0.0, 0.8}, 0.0)}, {0.0, 0.0, 0.01}});
    all.push_back(
        {{solid(ShapeKind::Sphere, {0.05, 0.0, 0.0}, {{0.0, 0.0, -0.05}, kUpright})}, {0.0, 0.0, 0.008}});
    all.push_back(
        {{solid(ShapeKind::Box, {0.1, 0.1, 0.1}, {{0.0, 0.0, -0.05}, rotationExp({0.5, 0.3, 0.0})})},
         {0.01, 0.0, 0.012}});
    all.push_back(
        {{solid(ShapeKind::Cylinder, {0.03, 0.3, 0.0}, {{0.0, 0.0, -0.03}, rotationExp({1.5, 0.0, 0.0})})},
         {0.0, 0.0, 0.008}});
    return all;
}

HapticOptions quietOptions(const Tool& tool, double metricError) {
    LoopSpec spec;
    spec.limited = spec.controller = false;
    spec.stiffness = 1000.0;
    spec.rotationalStiffness = 1000.0 * tool.gyrationRadius() * tool.gyrationRadius();
    HapticOptions options = loopOptions(spec, tool);
    options.springs.metricRadius *= metricError;
    return options;
}

Drawn walkLoops(RunLength runLength, double metricError) {
    Drawn all;
    Rng rng(20);
    const Tool tool = toolOf(crossLeaves(0.008));
    const int rounds = runLength == RunLength::Full ? 6 : 1,
              ticks = runLength == RunLength::Full ? 20000 : 8000;
    for (const Scenery& scenery : sceneries()) {
        for (int round = 0; round < rounds; ++round) {
            ClosedPath path;
            path.focus = scenery.focus;
            for (size_t i = 0; i < 2; ++i) {
                path.way[i] = 0.012 * rng.direction();
                path.tick[i] = 0.3 * rng.direction();
            }
            LoopWalk walk(tool, scenery.shapes, quietOptions(tool, metricError), path);
            walk.warmUp();
            walk.once(ticks); // the first loop may still settle
            const double drawn = walk.once(ticks);
            all.most = std::max(all.most, drawn);
            all.least = std::min(all.least, drawn);
            all.stored = std::max(all.stored, walk.stored());
            ++all.loops;
        }
    }
    return all;
}

Outcome closedLoops(RunLength runLength) {
    const Drawn tied = walkLoops(runLength, 1.0), off = walkLoops(runLength, 1.6);
    Outcome out =
        outcomeOf(tied.most / tied.stored, 1e-4, "1",
                  "Closed 6-axis paths of the hand around a wall, a corner, a groove, a ball, a box and a "
                  "bar with a cross of nine balls: most energy drawn in one loop of " +
                      num(uint64_t{tied.loops}) + " divided by the largest energy of the springs, " +
                      num(tied.stored * 1e3) + " mJ: " + num(tied.most * 1e3) + " mJ drawn (one loop took " +
                      num(-tied.least * 1e3) +
                      " mJ; both halve with the length of a tick). With a metric 1.6 times off the "
                      "springs' own up to " +
                      num(off.most * 1e3) + " mJ are drawn.");
    require(out, off.most > 1e-3, "a wrong metric should be detected");
    return out;
}

} // namespace

std::vector<Case> pathCases() {
    return {{"closed-hand-paths-draw-no-energy", Group::Stiff, closedLoops}};
}

} // namespace fathom::stability
