// SPDX-License-Identifier: Apache-2.0
#include "engine/cycle/haptic_options.h"

#include "engine/cycle/step_record.h"
#include "engine/haptics/limits.h"
#include "engine/types/error.h"
#include "engine/types/number_text.h"

#include <algorithm>
#include <limits>
#include <optional>

namespace fathom {

namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

// The value, if there is one, but at most `limit`.
std::optional<double> smaller(std::optional<double> value, double limit) {
    return value ? std::optional(std::min(*value, limit)) : value;
}

// Automatic damping, as a share of the device's own. A light hand on a clean wall comes to rest three times
// faster than without it; the stiffness falls by the same share.
constexpr double kDampingShare = 0.2;

constexpr double kTurnPerLength = 5.0; // [rad/m] speed of turning over speed of moving, of guidance

// With automatic stiffness the springs need a share of the device's damping.
void checkDamping(const Scene& scene, const std::string& section, const Scene::Haptics& haptics,
                  double scale) {
    const DevicePreset& device = devicePreset(haptics.device);
    if (!haptics.damping || haptics.stiffness || !device.damping) {
        return;
    }
    const double most = *device.damping / scale;
    if (*haptics.damping >= most) {
        throw BadInput(scene.file.string(), section + ".damping", significant(*haptics.damping, 4),
                       "below " + significant(most, 4) + " N s/m, the damping of device '" + device.name +
                           "', unless stiffness is a number");
    }
}

void checkDamping(const Scene& scene) {
    for (const Scene::Pilot& pilot : scene.pilots) {
        checkDamping(scene, "pilots: " + pilot.name, pilot.haptics, pilot.scale);
    }
    checkDamping(scene, "haptics", scene.haptics, scene.hand.scale);
}

// `options`: with period, device, low-pass filter, guidance and slew. The result lacks the tool's radius.
CouplingOptions couplingOf(const Scene& scene, const HapticOptions& options) {
    const Scene::Haptics& haptics = scene.haptics;
    const DevicePreset& device = options.device;
    CouplingOptions coupling;
    coupling.period = options.period;
    coupling.damping =
        haptics.damping.value_or(kDampingShare * device.damping.value_or(0.0) / scene.hand.scale);
    coupling.margin = haptics.margin;
    coupling.delayTicks = haptics.delay + lowPassDelayTicks(options.lowPassGain);
    coupling.handScale = scene.hand.scale;
    // The hand feels s K_t and K_r / s (hand_map.h); a scene cannot exceed what the device renders.
    coupling.stiffness = smaller(haptics.stiffness, device.stiffness / scene.hand.scale);
    coupling.rotationalStiffness = smaller(haptics.rotationalStiffness,
                                           device.rotationalStiffness.value_or(kNoLimit) * scene.hand.scale);
    coupling.paperGuidance = options.paperGuidance;
    coupling.slewForce = options.slewForce;
    coupling.slewTorque = options.slewTorque;
    return coupling;
}

// The hand feels torque / s (hand_map.h), so with a fine map (s < 1) the hand's limit is the tighter one.
double torqueShareOf(const Scene& scene) {
    return std::min(1.0, scene.hand.scale);
}

} // namespace

HapticOptions handOptions(const Scene& scene) {
    checkDamping(scene);
    const Scene::Haptics& haptics = scene.haptics;
    HapticOptions options;
    options.period = 1.0 / haptics.rateHz;
    options.device = devicePreset(haptics.device);
    options.handScale = scene.hand.scale;
    options.baseRdevice = scene.hand.baseRdevice;
    options.clutchBit = scene.hand.clutchBit;
    options.lowPassGain = lowPassGain(haptics.lowpassHz, options.period);
    options.paperGuidance = haptics.guidance == Scene::Haptics::GuidanceMode::Paper && scene.hasGuidance();

    options.deviceDelayTicks = haptics.delay;
    options.slewForce = haptics.slewForce;
    options.slewTorque = haptics.slewTorque * torqueShareOf(scene);
    options.coupling = couplingOf(scene, options);
    return options;
}

HapticOptions makeHapticOptions(const Scene& scene, const Tool& tool) {
    const Scene::Haptics& haptics = scene.haptics;
    HapticOptions options = handOptions(scene);
    const double torqueShare = torqueShareOf(scene);
    options.coupling.toolRadius = tool.gyrationRadius();
    options.springs = makeSprings(options.device, options.coupling);

    options.proxy.stepCap = haptics.stepCap;
    options.proxy.solves = haptics.solves;
    options.proxy.period = options.period;
    options.proxy.friction = haptics.friction;
    options.proxy.rows.smooth = haptics.smooth;
    // A scene can lower what the device may render, never raise it.
    const DevicePreset& device = options.device;
    options.forceLimit = std::min(haptics.forceLimit.value_or(device.forceLimit), device.forceLimit);
    options.torqueLimit =
        std::min(haptics.torqueLimit.value_or(device.torqueLimit), device.torqueLimit) * torqueShare;
    options.guidance.force = haptics.pullForce;
    options.guidance.torque = haptics.pullTorque;
    options.guidance.speed = haptics.pullSpeed;
    options.guidance.turnSpeed = kTurnPerLength * haptics.pullSpeed;
    options.needsContacts = scene.hasForbiddenPoints();
    return options;
}

} // namespace fathom
