// SPDX-License-Identifier: Apache-2.0
#include "engine/haptics/coupling.h"

#include "engine/types/error.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace fathom {
namespace {

void demandPositive(double value, const char* name) {
    if (!(value > 0.0) || !std::isfinite(value)) {
        throw Error(std::string("coupling: ") + name + " is " + std::to_string(value) +
                    " (allowed: a finite number above 0)");
    }
}

// Smaller of the preset's figure and the passive bound, as far as known, at the hand. Empty when neither is
// known.
std::optional<double> handLimit(std::optional<double> figure, std::optional<double> deviceDamping,
                                double damping, const CouplingOptions& options) {
    std::optional<double> limit = passiveLimit(figure, deviceDamping, damping, options);
    if (limit && deviceDamping) {
        *limit *= options.margin;
    }
    return limit && figure ? std::min(*limit, *figure) : limit;
}

} // namespace

void Springs::setRotational(double wanted) noexcept {
    rotationalStiffness =
        std::clamp(wanted, kMinRadius * kMinRadius * stiffness, kMaxRadius * kMaxRadius * stiffness);
    metricRadius = std::clamp(std::sqrt(rotationalStiffness / stiffness), kMinRadius, kMaxRadius);
}

double passiveStiffness(double deviceDamping, double damping, double period, double delayTicks) noexcept {
    return 2.0 * (deviceDamping - std::abs(damping)) / (period * (1.0 + 2.0 * delayTicks));
}

std::optional<double> passiveLimit(std::optional<double> figure, std::optional<double> deviceDamping,
                                   double damping, const CouplingOptions& options) noexcept {
    if (deviceDamping) {
        return passiveStiffness(*deviceDamping, damping, options.period, options.delayTicks);
    }
    return figure
               ? std::optional(*figure * kPresetPeriod / (options.period * (1.0 + 2.0 * options.delayTicks)))
               : std::nullopt;
}

Springs makeSprings(const DevicePreset& preset, const CouplingOptions& options) {
    demandPositive(options.period, "period");
    demandPositive(options.handScale, "hand map scale");
    demandPositive(options.toolRadius, "tool radius");
    if (!(options.delayTicks >= 0.0) || !std::isfinite(options.damping) ||
        !std::isfinite(options.rotationalDamping)) {
        throw Error("coupling: delay is negative or damping not finite");
    }
    Springs springs;
    springs.damping = options.damping;
    springs.rotationalDamping = options.rotationalDamping;
    const double share = options.paperGuidance ? kGuidanceShare : 0.0;
    const double handDamping = options.damping * options.handScale;
    const double followed = options.slewForce / kContactSpeed;
    const double whole =
        std::min(*handLimit(preset.stiffness, preset.damping, handDamping, options), followed) /
        options.handScale;
    springs.stiffness = options.stiffness.value_or(whole / (1.0 + share));
    demandPositive(springs.stiffness, "stiffness (damping B takes all of the device's?)");
    springs.guidanceStiffness = std::max(0.0, std::min(share * springs.stiffness, whole - springs.stiffness));
    if (options.rotationalStiffness) {
        springs.rotationalStiffness = *options.rotationalStiffness;
    } else {
        springs.rotationalStiffness = std::min(options.toolRadius * options.toolRadius * springs.stiffness,
                                               options.slewTorque / kContactTurn);
        const double turnDamping = options.rotationalDamping / options.handScale;
        const auto limit =
            handLimit(preset.rotationalStiffness, preset.rotationalDamping, turnDamping, options);
        if (limit) {
            springs.rotationalStiffness = std::min(springs.rotationalStiffness, *limit * options.handScale);
        }
    }
    demandPositive(springs.rotationalStiffness,
                   "rotational stiffness (damping B_r takes all of the device's?)");
    springs.setRotational(springs.rotationalStiffness);
    return springs;
}

StabilityMargins stabilityMargins(const DevicePreset& preset, const Springs& springs,
                                  const CouplingOptions& options) {
    if (!preset.damping) {
        return {};
    }
    const double k = (springs.stiffness + springs.guidanceStiffness) * options.handScale;
    const double b = springs.damping * options.handScale;
    const double needed = k * options.period * (1.0 + 2.0 * options.delayTicks) / 2.0;
    return {*preset.damping - (needed + std::abs(b)), *preset.damping + b - needed};
}

Wrench couple(const Springs& springs, const Pose& tool, const Pose& device) noexcept {
    const dvec3 turn = rotationBetween(device.rotation, tool.rotation);
    return {springs.stiffness * (tool.position - device.position), springs.rotationalStiffness * turn};
}

} // namespace fathom
