// SPDX-License-Identifier: Apache-2.0
// When a real arm must stand still.
#pragma once

#include "engine/cycle/step_conditions.h"
#include "engine/cycle/step_record.h"

namespace fathom {

// One thread; noexcept, no allocation.
class ArmHold {
public:
    // Status of the real arm before a step; from the first call on, a real arm is connected. Returns true if
    // the tool may be placed where the arm was measured: it stood still in the last step.
    bool follow(const ArmFollow& status) noexcept;
    // True if a real arm stands still in this step, or must. Reads the conditions before `armStill`.
    bool stands(const StepConditions& conditions) noexcept;
    // End of a step: sets StepRecord::armHold. The arm stands still while anything is wrong, and then until
    // tool and hand meet again or are re-indexed. Needs `finite`, `tool` and `device` of the record.
    void step(const StepConditions& conditions, bool trapped, StepRecord& out) noexcept;

    static constexpr double kResumeWithin = 0.005; // [m] tool to hand, before an arm moves again

private:
    bool connected_ = false;   // a real arm is connected
    bool follows_ = false;     // and reports that it follows
    bool wasStill_ = true;     // result of stands() in the last step
    bool commandsHold_ = true; // StepRecord::armHold of the last step
};

} // namespace fathom
