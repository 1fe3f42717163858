// SPDX-License-Identifier: Apache-2.0
#include "apps/replay/turn_to_tick.h"

namespace fathom {

namespace {

TickState stateOf(TurnState state) {
    switch (state) {
    case TurnState::Off:
        return TickState::Off;
    case TurnState::Free:
        return TickState::Free;
    case TurnState::Contact:
        return TickState::Contact;
    case TurnState::Escape:
        return TickState::Escape;
    case TurnState::Trapped:
        return TickState::Trapped;
    case TurnState::Fading:
        return TickState::Fading;
    }
    return TickState::Off;
}

} // namespace

TickRecord tickOf(const TurnRecord& turn, const ArmPosture& armStart, double turnMicros, bool late) {
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
    tick.turnMicros = turnMicros;
    tick.late = late;
    tick.solves = turn.solves;
    tick.infeasible = turn.infeasible != 0;
    tick.notFinite = !turn.finite;
    tick.arm = turn.arm;
    tick.armStart = armStart;
    return tick;
}

} // namespace fathom
