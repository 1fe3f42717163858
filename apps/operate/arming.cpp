// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/arming.h"

#include "engine/cycle/haptic_notes.h"
#include "engine/types/printed.h"

#include <algorithm>
#include <cmath>

namespace fathom::operate {

namespace {

constexpr double kSilent = 5.0; // multiples of kStaleAfter: older than from any slow camera
constexpr double kApart = 0.01; // [m] most between hand and tool
constexpr double kRecent = 0.5; // [s] age of a contact that explains the distance
constexpr double kTwist = 0.35; // [rad] most turn between them, where the device renders torque

std::string thousandths(double value) {
    return printed("%.0f", value * 1e3);
}

// How the hand comes back to the tool. Without forces, the clutch brings it there.
std::string toTool(const ArmingInput& input) {
    return input.haptics.clutchBit != 0 ? "hold C to re-centre" : "move it back to the tool";
}

std::string handIsOff(const ArmingInput& input) {
    const StepRecord& record = input.run.step().record;
    const double apart = glm::distance(record.tool.position, record.device.position);
    if (apart > kApart) {
        const auto& blocks = input.run.blocks();
        const bool known = !blocks.empty() && record.t - blocks.front().last < kRecent &&
                           blocks.front().touch.fixture < input.scene.fixtures.size();
        return "hand is " + thousandths(apart) + " mm" +
               (known ? " inside '" + input.scene.fixtures[blocks.front().touch.fixture].name + "'"
                      : " from the tool") +
               ": " + toTool(input);
    }
    const double turn = glm::length(rotationBetween(record.tool.rotation, record.device.rotation));
    if (turn > kTwist && record.contactCount > 0) {
        return std::string("hand is turned against the tool: ") +
               (input.haptics.clutchBit != 0 ? "hold C to re-centre" : "turn it back");
    }
    return "";
}

} // namespace

double softStart(double forceLimit) {
    constexpr double kMin = 1.5;       // [s]
    constexpr double kSteepest = 20.0; // [N/s]
    return std::max(kMin, forceLimit / kSteepest);
}

bool cameraSilent(const StepRecord& record) {
    return std::abs(record.sceneAge) > kSilent * kStaleAfter;
}

std::string whyNotArmed(const ArmingInput& input) {
    const StepRecord& record = input.run.step().record;
    if (input.gpuGone) {
        return "the GPU is gone: wait until it is back";
    }
    if (input.handGone) {
        return "the haptic device is gone: connect it";
    }
    if (!input.run.anyTick() || record.frame < 0) {
        return "no camera frame has become a set of regions yet: wait for one";
    }
    if (cameraSilent(record)) {
        const bool ahead = record.sceneAge < 0.0;
        return "the newest regions are " + thousandths(std::abs(record.sceneAge)) +
               (ahead ? " ms ahead of the clock: check which clock the camera stamps with"
                      : " ms old: check the camera");
    }
    if (!(input.haptics.forceLimit > 0.0)) {
        return kNoForce;
    }
    if (input.run.step().driven && isFault(input.run.step().armStatus.state)) {
        return std::string("the arm is ") + armStateName(input.run.step().armStatus.state) +
               ": see the tab Alarms";
    }
    if (!input.scene.pilots.empty() && input.scene.pilot.empty()) {
        return "no pilot is chosen: choose one in the tab Fixtures";
    }
    return handIsOff(input);
}

} // namespace fathom::operate
