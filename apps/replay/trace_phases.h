// SPDX-License-Identifier: Apache-2.0
// Divides a run into a few phases with letters A, B, C ..., as in the paper's figures.
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

// Returns at most `most` (1..26) phases that cover the run without gaps; neighbours differ in kind. Merges a
// phase shorter than 2 % of the run into its longer neighbour. Guidance takes precedence over contact.
std::vector<Phase> findPhases(const TraceHistory& history, size_t most = 26);

} // namespace fathom
