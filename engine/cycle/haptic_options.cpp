// SPDX-License-Identifier: Apache-2.0
#include "engine/cycle/haptic_options.h"

#include "engine/haptics/limits.h"

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

} // namespace

HapticOptions makeHapticOptions(const Scene& scene, const Tool& tool) {
    const Scene::Haptics& haptics = scene.haptics;
    HapticOptions options;
    options.period = 1.0 / haptics.rateHz;
    options.device = devicePreset(haptics.device);
    options.handScale = scene.hand.scale;
    options.baseRdevice = scene.hand.baseRdevice;
    options.clutchBit = scene.hand.clutchBit;
    options.lowPassGain = lowPassGain(haptics.lowpassHz, options.period);
    options.paperGuidance = haptics.guidance == Scene::Haptics::GuidanceMode::Paper && scene.hasGuidance();

    options.coupling.period = options.period;
    options.deviceDelayTicks = haptics.delay;
    options.coupling.delayTicks = haptics.delay + lowPassDelayTicks(options.lowPassGain);
    options.coupling.handScale = scene.hand.scale;
    options.coupling.toolRadius = tool.gyrationRadius();
    // The hand feels s K_t and K_r / s (hand_map.h); a scene cannot exceed what the device renders.
    options.coupling.stiffness = smaller(haptics.stiffness, options.device.stiffness / scene.hand.scale);
    options.coupling.rotationalStiffness =
        smaller(haptics.rotationalStiffness,
                options.device.rotationalStiffness.value_or(kNoLimit) * scene.hand.scale);
    options.coupling.paperGuidance = options.paperGuidance;
    // The hand feels torque / s (hand_map.h), so with a fine map (s < 1) the hand's limit is the tighter one.
    const double torqueShare = std::min(1.0, scene.hand.scale);
    options.slewForce = options.coupling.slewForce = haptics.slewForce;
    options.slewTorque = options.coupling.slewTorque = haptics.slewTorque * torqueShare;
    options.springs = makeSprings(options.device, options.coupling);

    options.proxy.stepCap = haptics.stepCap;
    options.proxy.solves = haptics.solves;
    // A scene can lower what the device may render, never raise it.
    const DevicePreset& device = options.device;
    options.forceLimit = std::min(haptics.forceLimit.value_or(device.forceLimit), device.forceLimit);
    options.torqueLimit =
        std::min(haptics.torqueLimit.value_or(device.torqueLimit), device.torqueLimit) * torqueShare;
    options.guidance.force = haptics.pullForce;
    options.guidance.torque = haptics.pullTorque;
    options.needsContacts = scene.hasForbiddenPoints();
    return options;
}

} // namespace fathom
