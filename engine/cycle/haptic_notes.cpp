// SPDX-License-Identifier: Apache-2.0
#include "engine/cycle/haptic_notes.h"

#include "engine/cycle/haptic_options.h"
#include "engine/cycle/step_record.h"
#include "engine/haptics/passivity.h"
#include "engine/types/number_text.h"

#include <algorithm>
#include <limits>
#include <optional>

namespace fathom {

namespace {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();
constexpr double kUsualSpeed = 1.0; // [m/s] of a fast hand

// A hand does not feel less.
constexpr double kMinForce = 0.05, kMinTorque = 0.001; // [N], [N m]
constexpr double kMinSlew = 1.0, kMinTurnSlew = 0.01;  // [N/s], [N m/s]
constexpr double kShallow = 0.01;                      // [m] inside a region
constexpr double kUnstableTimes = 2.0; // the passive bound; less is usually stable in a hand that holds
constexpr double kNearTarget = 0.1, kMinPullShare = 0.25; // [m]; of guidance_pull.force

void noteLimit(std::vector<std::string>& notes, const char* field, std::optional<double> requested,
               double device, const char* unit, const std::string& name) {
    if (requested && *requested > device) {
        notes.push_back(std::string("haptics.") + field + ": " + significant(*requested, 4) + " " + unit +
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

void noteTurn(std::vector<std::string>& notes, const Scene& scene) {
    const HapticOptions options = handOptions(scene);
    const std::optional<double> requested = options.coupling.rotationalStiffness;
    if (!requested) {
        return;
    }
    const Springs springs = makeSprings(options.device, options.coupling);
    if (springs.rotationalStiffness != *requested) {
        notes.push_back("haptics.rotational_stiffness: " + significant(*requested, 4) + " N m/rad asked, " +
                        significant(springs.rotationalStiffness, 4) + " N m/rad used: with a stiffness of " +
                        significant(springs.stiffness, 4) + " N/m, from " +
                        significant(Springs::kMinRadius * Springs::kMinRadius, 4) + " to " +
                        significant(Springs::kMaxRadius * Springs::kMaxRadius, 4) +
                        " times that are possible");
    }
}

// What the tool can follow.
void noteSpeeds(std::vector<std::string>& notes, const Scene& scene) {
    const Scene::Haptics& haptics = scene.haptics;
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
}

// The pull of guidance `paper` has what the stiffness leaves of the stable one.
void warnPull(std::vector<std::string>& warnings, const HapticOptions& options, const Springs& springs,
              double pull) {
    CouplingOptions usual = options.coupling;
    usual.stiffness.reset();
    const Springs automatic = makeSprings(options.device, usual);
    if (options.paperGuidance && options.coupling.stiffness &&
        springs.guidanceStiffness < automatic.guidanceStiffness &&
        springs.guidanceStiffness * kNearTarget < kMinPullShare * pull) {
        warnings.push_back("haptics.guidance: paper pulls with a spring of " +
                           significant(springs.guidanceStiffness, 4) + " N/m: haptics.stiffness, " +
                           significant(springs.stiffness, 4) + " N/m, leaves no more; auto takes " +
                           significant(automatic.stiffness, 4) + " N/m and leaves " +
                           significant(automatic.guidanceStiffness, 4) + " N/m");
    }
}

// Adds one note if the stiffness at the hand is above `times` and at most `most` times the passive bound
// (coupling.h).
void noteBound(std::vector<std::string>& notes, const Scene& scene, double times, double most) {
    const HapticOptions options = handOptions(scene);
    const CouplingOptions& coupling = options.coupling;
    const std::optional<double> bound = passiveLimit(options.device.stiffness, options.device.damping,
                                                     coupling.damping * scene.hand.scale, coupling);
    const double atHand = coupling.stiffness.value_or(0.0) * scene.hand.scale;
    const double passive = std::max(0.0, bound.value_or(kUnlimited));
    if (atHand > times * passive && !(atHand > most * passive)) {
        notes.push_back("haptics.stiffness: " + significant(atHand, 4) +
                        " N/m at the hand, over the passive bound of " + significant(passive, 4) +
                        " N/m with this device, rate_hz, damping and delay: a light hand can bounce off a "
                        "wall faster than it came (allowed: auto, or a value below the bound)");
    }
}

// Where the device's own damping is known, the passive bound contains the rendered one. Elsewhere only what
// the ticks can follow on a light device is known.
void warnDamping(std::vector<std::string>& warnings, const HapticOptions& options) {
    const CouplingOptions& coupling = options.coupling;
    const double atHand = coupling.damping * coupling.handScale;
    const double most =
        PassivityController::kMaxImpulse / (coupling.period * (1.0 + 2.0 * options.deviceDelayTicks));
    if (!options.device.damping && atHand > most) {
        warnings.push_back(
            "haptics.damping: " + significant(atHand, 4) + " N s/m at the hand, over the " +
            significant(most, 4) +
            " N s/m that are safe at this rate_hz and delay: a light hand can chatter in contact, "
            "because the damping of device " +
            options.device.name + " is unknown (allowed: auto, or a smaller value)");
    }
}

// Torques may be unwanted, so these are notes alone.
void noteTorques(std::vector<std::string>& notes, const Scene::Haptics& haptics) {
    if (haptics.torqueLimit && *haptics.torqueLimit < kMinTorque) {
        notes.push_back("haptics.limits.torque: " + significant(*haptics.torqueLimit, 4) +
                        " N m, less than a hand feels (" + significant(kMinTorque, 4) + " N m)");
    }
    if (haptics.slewTorque < kMinTurnSlew) {
        notes.push_back("haptics.limits.slew_Nm_per_s: " + significant(haptics.slewTorque, 4) +
                        " N m/s: a torque of " + significant(kMinTurnSlew, 4) + " N m takes " +
                        significant(kMinTurnSlew / haptics.slewTorque, 4) + " s");
    }
}

} // namespace

std::vector<std::string> forceWarnings(const Scene& scene) {
    const Scene::Haptics& haptics = scene.haptics;
    const HapticOptions options = handOptions(scene);
    const Springs springs = makeSprings(options.device, options.coupling);
    std::vector<std::string> warnings;
    if (haptics.forceLimit == 0.0) {
        warnings.emplace_back(kNoForce);
    } else if (haptics.forceLimit && *haptics.forceLimit < kMinForce) {
        warnings.push_back("haptics.limits.force: " + significant(*haptics.forceLimit, 4) +
                           " N, less than a hand feels (" + significant(kMinForce, 4) + " N)");
    }
    if (haptics.slewForce < kMinSlew) {
        warnings.push_back("haptics.limits.slew_N_per_s: " + significant(haptics.slewForce, 4) +
                           " N/s: a force of 1 N takes " + significant(1.0 / haptics.slewForce, 4) + " s");
    }
    const double felt = springs.stiffness * options.handScale;
    if (felt * kShallow < kMinForce) {
        warnings.push_back("haptics.stiffness: " + significant(felt, 4) +
                           " N/m at the hand: 10 mm inside a "
                           "region it feels " +
                           significant(felt * kShallow, 4) + " N");
    }
    noteBound(warnings, scene, kUnstableTimes, kUnlimited);
    warnDamping(warnings, options);
    warnPull(warnings, options, springs, haptics.pullForce);
    return warnings;
}

std::vector<std::string> hapticNotes(const Scene& scene) {
    const Scene::Haptics& haptics = scene.haptics;
    const DevicePreset device = handOptions(scene).device;
    std::vector<std::string> notes = forceWarnings(scene);
    noteTorques(notes, haptics);
    for (const Scene::Pilot& pilot : scene.pilots) {
        Scene other = scene;
        if (pilot.name != scene.pilot && other.choosePilot(pilot.name)) {
            for (const std::string& warning : forceWarnings(other)) {
                notes.push_back("pilots: " + pilot.name + ": " + warning);
            }
        }
    }
    noteLimit(notes, "limits.force", haptics.forceLimit, device.forceLimit, "N", device.name);
    noteLimit(notes, "limits.torque", haptics.torqueLimit, device.torqueLimit, "N m", device.name);
    noteLimit(notes, "stiffness", haptics.stiffness, device.stiffness / scene.hand.scale, "N/m", device.name);
    noteLimit(notes, "rotational_stiffness", haptics.rotationalStiffness,
              device.rotationalStiffness.value_or(kUnlimited) * scene.hand.scale, "N m/rad", device.name);
    noteTurn(notes, scene);
    noteBound(notes, scene, 1.0, kUnstableTimes);
    noteSlew(notes, haptics.slewForce);
    noteSpeeds(notes, scene);
    return notes;
}

} // namespace fathom
