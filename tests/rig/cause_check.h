// SPDX-License-Identifier: Apache-2.0
// The invariants of the forces of a run, row by row of haptics.csv.
#pragma once

#include "engine/cycle/wrench_stage.h"
#include "tests/rig/stage.h"

#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace fathom {

// The fault of a single row; empty = none.
inline std::string faultOf(const Tick& tick, const Terms& terms, double allowance) {
    const std::set<std::string> states{"off", "free", "contact", "escape", "trapped", "fading", "waiting"};
    if (!isFinite(tick.device) || !isFinite(tick.tool) || !isFinite(tick.force) || !isFinite(tick.torque)) {
        return "a pose or the wrench is not finite";
    }
    if (std::abs(glm::length(tick.device.rotation) - 1.0) > 1e-9 ||
        std::abs(glm::length(tick.tool.rotation) - 1.0) > 1e-9) {
        return "a quaternion is not of unit length";
    }
    if (glm::length(tick.force) > terms.forceLimit * (1.0 + 1e-12) ||
        glm::length(tick.torque) > terms.torqueLimit * (1.0 + 1e-12)) {
        return "the wrench is over its limits";
    }
    if (tick.stalled > 1 || !(tick.guidance >= 0.0) || !(tick.guidance <= 1.0) ||
        states.count(tick.state) == 0) {
        return "stalled, guidance or state is none";
    }
    if (tick.contacts > 0 && (tick.state == "free" || tick.state == "trapped" || tick.state == "waiting")) {
        return "contacts while " + tick.state;
    }
    if (tick.state == "off" && (glm::length(tick.force) > 0.0 || glm::length(tick.torque) > 0.0)) {
        return "a wrench while off";
    }
    if (tick.frame < 0 ? !std::isnan(tick.sceneAge) : !(tick.sceneAge >= -1e-9)) {
        return "a scene age without a frame, or none with one";
    }
    return tick.minGap < -allowance ? "min_gap_m is beyond the allowance" : "";
}

// No force without a cause: without a contact, a joint's limit or guidance there is only a tail that falls in
// every tick, and damping of at most 1 N for 0.1 s.
class CauseCheck {
public:
    // A device that is lost gets zero at once, whatever it felt.
    explicit CauseCheck(bool mayLose = false)
        : mayLose_(mayLose) {}

    // The fault of the row; empty = none.
    std::string add(const Tick& tick, const Terms& terms) {
        const double force = glm::length(tick.force), torque = glm::length(tick.torque);
        const bool lost = mayLose_ && force == 0.0 && torque == 0.0;
        const bool steep =
            !lost && (glm::length(tick.force - force_) > terms.slewForce / terms.rate * (1.0 + 1e-9) ||
                      glm::length(tick.torque - torque_) > terms.slewTorque / terms.rate * (1.0 + 1e-9));
        const bool caused = tick.contacts > 0 || tick.guidance > 0.0 || (tick.cause & cause::kJoint) != 0;
        since_ = caused ? tick.t : since_;
        const bool felt = force > 0.05 || torque > 0.005;
        const bool tail =
            force < glm::length(force_) && torque <= glm::length(torque_) + 1e-12 && tick.t - since_ <= 0.25;
        const bool damping = force <= 1.0 && tick.t - since_ <= 0.1;
        force_ = tick.force;
        torque_ = tick.torque;
        if (steep) {
            return "the wrench changes faster than the slew limit";
        }
        if (((tick.cause & cause::kRow) != 0) != (tick.contacts > 0)) {
            return "cause and contacts disagree";
        }
        if ((force > 1e-9 || torque > 1e-9) && tick.cause == 0) {
            return "a wrench without a cause";
        }
        return felt && !caused && !tail && !damping ? "a force in free space" : "";
    }

private:
    bool mayLose_;
    dvec3 force_{0.0}, torque_{0.0};
    double since_ = -1e9; // [s] the last tick with a cause
};

// Checks every row of a run, and names each kind of fault once, with its first time.
inline void checkForces(const std::vector<Tick>& ticks, const Terms& terms, double allowance, bool mayLose) {
    CauseCheck causes(mayLose);
    std::map<std::string, std::vector<double>> faults; // times [s] of each kind
    for (const Tick& tick : ticks) {
        for (const std::string& fault : {faultOf(tick, terms, allowance), causes.add(tick, terms)}) {
            if (!fault.empty()) {
                faults[fault].push_back(tick.t);
            }
        }
    }
    for (const auto& [fault, times] : faults) {
        FAIL_CHECK(times.size() << " ticks, the first at " << times.front() << " s: " << fault);
    }
}

} // namespace fathom
