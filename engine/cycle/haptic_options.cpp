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

constexpr double kUsualSpeed = 1.0; // [m/s] of a fast hand

void noteLimit(std::vector<std::string>& notes, const char* field, std::optional<double> asked, double device,
               const char* unit, const std::string& name) {
    if (asked && *asked > device) {
        notes.push_back(std::string("haptics.") + field + ": " + significant(*asked, 4) + " " + unit +
                        " asked, " + significant(device, 4) + " " + unit + " used: the limit of device " +
                        name);
    }
}

void noteSlew(std::vector<std::string>& notes, double slew) {
    const double usual = Scene::Haptics().slewForce;
    if (slew > usual) {
        notes.push_back("haptics.limits.slew_N_per_s: " + significant(slew, 4) +
                        " N/s, over the default of " + significant(usual, 4) +
                        ": steps of the force are felt as clicks");
    }
}

void noteDelay(std::vector<std::string>& notes, double delay) {
    if (delay >= kStaleAfter) {
        notes.push_back("contact.delay: contact answers are " + significant(delay, 4) +
                        " s late; forces fade when they are older than " + significant(kStaleAfter, 4) +
                        " s");
    }
}

void noteSpeed(std::vector<std::string>& notes, const std::string& fields, double speed) {
    if (speed < kUsualSpeed) {
        notes.push_back(fields + ": the tool follows a hand up to " + significant(speed, 4) +
                        " m/s; it lags behind a faster one, without a force");
    }
}

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

// The options that do not depend on the tool.
HapticOptions handOptions(const Scene& scene) {
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

void noteTurn(std::vector<std::string>& notes, const Scene& scene) {
    const HapticOptions options = handOptions(scene);
    const std::optional<double> asked = options.coupling.rotationalStiffness;
    if (!asked) {
        return;
    }
    const Springs springs = makeSprings(options.device, options.coupling);
    if (springs.rotationalStiffness != *asked) {
        notes.push_back("haptics.rotational_stiffness: " + significant(*asked, 4) + " N m/rad asked, " +
                        significant(springs.rotationalStiffness, 4) + " N m/rad used: with a stiffness of " +
                        significant(springs.stiffness, 4) + " N/m, from " +
                        significant(Springs::kMinRadius * Springs::kMinRadius, 4) + " to " +
                        significant(Springs::kMaxRadius * Springs::kMaxRadius, 4) +
                        " times that are possible");
    }
}

} // namespace

HapticOptions makeHapticOptions(const Scene& scene, const Tool& tool) {
    checkDamping(scene);
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

std::string stiffnessDoubt(const Scene& scene, double times) {
    const HapticOptions options = handOptions(scene);
    const CouplingOptions& coupling = options.coupling;
    const std::optional<double> bound = passiveLimit(options.device.stiffness, options.device.damping,
                                                     coupling.damping * scene.hand.scale, coupling);
    const double atHand = coupling.stiffness.value_or(0.0) * scene.hand.scale;
    if (!bound || atHand <= times * std::max(0.0, *bound)) {
        return "";
    }
    return "haptics.stiffness: " + significant(atHand, 4) + " N/m at the hand, over the passive bound of " +
           significant(std::max(0.0, *bound), 4) + " N/m with this device, rate_hz, damping and delay: a " +
           "light hand can bounce off a wall faster than it came (allowed: auto, or a value below the bound)";
}

std::vector<std::string> hapticNotes(const Scene& scene) {
    checkDamping(scene);
    const Scene::Haptics& haptics = scene.haptics;
    const DevicePreset& device = devicePreset(haptics.device);
    std::vector<std::string> notes;
    noteLimit(notes, "limits.force", haptics.forceLimit, device.forceLimit, "N", device.name);
    if (haptics.forceLimit == 0.0) {
        notes.emplace_back(kNoForce);
    }
    noteLimit(notes, "limits.torque", haptics.torqueLimit, device.torqueLimit, "N m", device.name);
    noteLimit(notes, "stiffness", haptics.stiffness, device.stiffness / scene.hand.scale, "N/m", device.name);
    noteLimit(notes, "rotational_stiffness", haptics.rotationalStiffness,
              device.rotationalStiffness.value_or(kNoLimit) * scene.hand.scale, "N m/rad", device.name);
    noteTurn(notes, scene);
    if (const std::string doubt = stiffnessDoubt(scene); !doubt.empty()) {
        notes.push_back(doubt);
    }
    noteSlew(notes, haptics.slewForce);
    const double scale = scene.hand.scale;
    const std::string byScale = scale > 1.0 ? " / hand.map.scale" : "";
    noteSpeed(notes, "haptics.step_cap x solves x rate_hz" + byScale,
              haptics.stepCap * haptics.solves * haptics.rateHz / scale);
    if (scene.hasForbiddenPoints()) {
        const double answers = haptics.rateHz / std::max(1.0, static_cast<double>(scene.contact.delay));
        noteSpeed(notes,
                  (scene.contact.delay > 1 ? "contact.reach x haptics.rate_hz / contact.delay"
                                           : "contact.reach x haptics.rate_hz") +
                      byScale,
                  scene.contact.reach * answers / scale);
        noteDelay(notes, scene.contact.delay / haptics.rateHz);
    }
    return notes;
}

} // namespace fathom
