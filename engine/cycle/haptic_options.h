// SPDX-License-Identifier: Apache-2.0
// Options of the haptic cycle, derived once from scene, tool and device preset.
#pragma once

#include "engine/contact/tool.h"
#include "engine/haptics/coupling.h"
#include "engine/haptics/guidance.h"
#include "engine/haptics/proxy.h"
#include "engine/scene/scene.h"
#include "engine/types/haptic_device.h"

namespace fathom {

struct HapticOptions {
    double period = 0.001; // T [s] nominal; ramps, slew and damping use it
    DevicePreset device;
    CouplingOptions coupling; // input of the springs; the margins need it
    Springs springs;
    ProxyOptions proxy;
    GuidanceLimits guidance;
    bool paperGuidance = false; // mode `paper`, else `target`
    dquat baseRdevice{1.0, 0.0, 0.0, 0.0};
    double handScale = 1.0;                       // tool motion per hand motion
    uint32_t clutchBit = kDefaultClutch;          // in StepInput::buttons; 0 = none
    double forceLimit = 20.0, torqueLimit = 2.0;  // [N], [N m] at the tool; includes the hand's torque limit
    double slewForce = 2000.0, slewTorque = 50.0; // [N/s], [N m/s]
    double lowPassGain = 1.0;                     // limits.h; 1 = off
    bool needsContacts = true;  // the scene has regions of points: hold the tool until the first contact set
    double softStartTime = 0.2; // [s] time for forces to return after forces off or an open dead-man
    // Damps the energy that moving fixtures feed into the hand (engine/haptics/passivity.h); changes no force
    // when there is none.
    bool passivityController = true;
    uint32_t deviceDelayTicks = 0; // ticks from write() to the hand; coupling.delayTicks includes them
};

// The options that do not depend on the tool. Throws BadInput as makeHapticOptions().
HapticOptions handOptions(const Scene& scene);

// Throws BadInput (unknown device; damping that leaves automatic stiffness nothing) or Error (springs
// impossible).
HapticOptions makeHapticOptions(const Scene& scene, const Tool& tool);

} // namespace fathom
