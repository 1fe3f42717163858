// SPDX-License-Identifier: Apache-2.0
// The few phases that a run falls into, lettered A, B, C ... as in the figures of the paper.
#pragma once

#include "apps/replay/trace_history.h"

#include <vector>

namespace fathom {

enum class PhaseKind { Off, Free, Contact, Guidance, Fading, Trapped };

// The word for a phase. Escaping counts as contact.
const char* phaseName(PhaseKind kind);

struct Phase {
    double begin = 0.0, end = 0.0; // [s]
    PhaseKind kind = PhaseKind::Free;
};

// Neighbouring phases differ in kind, follow each other without gaps and cover the run; at most `most`
// (1..26). What is shorter than 2 % of the run is taken for a flicker of its longer neighbour. Guidance goes
// before contact.
std::vector<Phase> findPhases(const TraceHistory& history, size_t most = 26);

} // namespace fathom
