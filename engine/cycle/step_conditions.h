// SPDX-License-Identifier: Apache-2.0
// What the rules of a haptic step depend on.
#pragma once

namespace fathom {

// The conditions of one step: HapticCycle determines them before the hand and the tool move.
struct StepConditions {
    bool sampleFinite = true; // the hand's sample is finite
    bool off = false;         // forces off, dead-man open or device lost
    bool clutch = false;
    bool recentre = false;  // the clutch's button is down, and there is no force
    bool setReady = false;  // there is a set, or none is needed
    bool stale = false;     // the scene is old
    bool armStill = false;  // a real arm stands still
    bool movesTool = false; // the tool is moved in this step
    bool newData = false;   // and the regions have changed since it was moved last
};

} // namespace fathom
