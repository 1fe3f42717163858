// SPDX-License-Identifier: Apache-2.0
// Group rotation, devices: quaternions of any length, devices without torque or with an inactive axis.
#include "apps/stability/case_text.h"
#include "apps/stability/step_timer.h"
#include "engine/reference/rng.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace fathom::stability {

namespace {

// The same motion with quaternions a thousand times too short or too long.
Outcome anyLength(RunLength runLength) {
    double worst = 0.0;
    Rng rng(3);
    const int ticks = runLength == RunLength::Full ? 4000 : 800;
    for (const char* device : {"ideal", "w5d"}) {
        for (const double length : {1e-6, 1e-3, 0.5, 1.001, 1e3, 1e6}) {
            const Shape wall = wallShape({0.0, 0.0, 1.0}, 0.0);
            const Pose start{{0.0, 0.0, 0.03}, dquat(1.0, 0.0, 0.0, 0.0)};
            StepTimer unit(device, true, {&wall, 1}, start), scaled(device, true, {&wall, 1}, start);
            for (int i = 0; i < ticks; ++i) {
                const double s = static_cast<double>(i) / ticks;
                Pose pose{{0.0, 0.0, 0.03 - 0.03 * s},
                          rotationExp({1.2 * std::sin(9.0 * s), 0.8 * s, 3.0 * s})};
                const StepRecord a = unit.step(pose);
                pose.rotation = pose.rotation * (length * rng.uniform(0.9, 1.1));
                const StepRecord b = scaled.step(pose);
                worst = std::max({worst, glm::distance(a.deviceWrench.force, b.deviceWrench.force),
                                  glm::distance(a.deviceWrench.torque, b.deviceWrench.torque),
                                  glm::distance(a.tool.position, b.tool.position)});
            }
        }
    }
    return outcomeOf(worst, 1e-9, "N",
                     "Orientations as quaternions of length 1e-6 to 1e6, a new length at every tick: largest "
                     "difference of wrench [N, N m] and tool [m] to the same motion with unit quaternions; a "
                     "device with all axes and one without roll.");
}

struct Leak {
    double wrong = 0.0, broken = 0.0,
           felt = 0.0; // on missing axes; sum of the parts against the total; largest torque
};

Leak leakOf(const char* device, const std::function<dvec3(const Wrench&, const Pose&)>& absent, int ticks) {
    Leak leak;
    Rng rng(17);
    const Shape wall = wallShape({0.0, 0.0, 1.0}, 0.0);
    StepTimer stepTimer(device, true, {&wall, 1}, {{0.0, 0.0, 0.02}, dquat(1.0, 0.0, 0.0, 0.0)});
    const dvec3 a = rng.direction(), b = rng.direction();
    for (int i = 0; i < ticks; ++i) {
        const double s = 6.0 * i / 1000.0;
        const Pose raw{{0.01 * std::sin(s), 0.0, 0.01 * std::cos(0.7 * s)},
                       rotationExp(1.5 * std::sin(s) * a) * rotationExp(s * b)};
        const StepRecord& record = stepTimer.step(raw);
        leak.wrong = std::max(leak.wrong, glm::length(absent(record.deviceWrench, raw)));
        leak.broken = std::max(
            {leak.broken,
             glm::distance(record.deviceWrench.force + record.residual.force, record.wrench.force),
             glm::distance(record.deviceWrench.torque + record.residual.torque, record.wrench.torque)});
        leak.felt = std::max(leak.felt, glm::length(record.wrench.torque));
    }
    return leak;
}

Outcome leakOutcome(const Leak& leak, const std::string& what) {
    Outcome out = outcomeOf(std::max(leak.wrong, leak.broken), 1e-12, "N m",
                            what +
                                " Largest torque on an axis that is not actuated, and largest difference "
                                "between the sum of both parts and the whole wrench; the whole reached " +
                                num(leak.felt) + " N m.");
    require(out, leak.felt > 0.05, "some torque was expected");
    return out;
}

Outcome noTorque(RunLength runLength) {
    return leakOutcome(leakOf(
                           "touch", [](const Wrench& w, const Pose&) { return w.torque; },
                           runLength == RunLength::Full ? 20000 : 3000),
                       "A device without torque, turned over and over on a wall with a cross of nine balls.");
}

Outcome deadAxis(RunLength runLength) {
    const auto roll = [](const Wrench& w, const Pose& raw) {
        const dvec3 axis = raw.rotation * dvec3(0.0, 0.0, 1.0);
        return glm::dot(w.torque, axis) * axis;
    };
    return leakOutcome(leakOf("w5d", roll, runLength == RunLength::Full ? 20000 : 3000),
                       "A device whose roll is not actuated, turned over and over.");
}

} // namespace

std::vector<Case> rotationDeviceCases() {
    return {{"quaternions-of-any-length", Group::Rotation, anyLength},
            {"device-without-torque", Group::Rotation, noTorque},
            {"device-with-a-dead-axis", Group::Rotation, deadAxis}};
}

} // namespace fathom::stability
