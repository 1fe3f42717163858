// SPDX-License-Identifier: Apache-2.0
// Divides a run into a few phases, lettered A, B, C ... as in the figures of the paper.
#pragma once

#include "apps/replay/trace_history.h"

#include <vector>

namespace fathom {

enum class PhaseKind { Off, Free, Contact, Guidance, Fading, Trapped };

// Escaping counts as contact.
const char* phaseName(PhaseKind kind);

struct Phase {
    double begin = 0.0, end = 0.0; // [s]
    PhaseKind kind = PhaseKind::Free;
};

// At most `most` (1..26) phases that cover the run without gaps; neighbours differ in kind. A phase shorter
// than 2 % of the run is merged into its longer neighbour. Guidance takes precedence over contact.
std::vector<Phase> findPhases(const TraceHistory& history, size_t most = 26);

} // namespace fathom
