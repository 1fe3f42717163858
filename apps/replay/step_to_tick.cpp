// SPDX-License-Identifier: Apache-2.0
#include "apps/replay/step_to_tick.h"

namespace fathom {

namespace {

TickState stateOf(StepState state) {
    switch (state) {
    case StepState::Off:
        return TickState::Off;
    case StepState::Free:
        return TickState::Free;
    case StepState::Contact:
        return TickState::Contact;
    case StepState::Escape:
        return TickState::Escape;
    case StepState::Trapped:
        return TickState::Trapped;
    case StepState::Fading:
        return TickState::Fading;
    case StepState::Waiting:
        return TickState::Waiting;
    }
    return TickState::Off;
}

} // namespace

TickRecord tickOf(const StepRecord& turn, const ArmPosture& armStart, double stepMicros, bool late) {
    TickRecord tick;
    tick.t = turn.t;
    tick.device = turn.device;
    tick.tool = turn.tool;
    tick.wrench = turn.wrench;
    tick.contacts = turn.contacts;
    tick.minGap = turn.minGap;
    tick.state = stateOf(turn.state);
    tick.guidance = turn.guidance;
    tick.frame = turn.frame;
    tick.sceneAge = turn.sceneAge;
    tick.stalled = turn.stalled;
    tick.marginPassive = turn.marginPassive;
    tick.marginUncoupled = turn.marginUncoupled;
    tick.stepMicros = stepMicros;
    tick.late = late;
    tick.solves = turn.solves;
    tick.infeasible = turn.infeasible != 0;
    tick.notFinite = !turn.finite;
    tick.arm = turn.arm;
    tick.armStart = armStart;
    return tick;
}

} // namespace fathom
