// SPDX-License-Identifier: Apache-2.0
// The contact cadence in real time: the newest tool pose against the newest fixture set, as often as there is
// a new pose.
#pragma once

#include "apps/binding/crossings.h"
#include "apps/binding/run_clock.h"
#include "engine/cycle/cadence_trace.h"

namespace fathom {

// What the loop needs of the query behind it. One thread.
class ContactAnswers {
public:
    virtual ~ContactAnswers() = default;
    // Fills `out` for the newest fixture set; false when there is none yet.
    virtual bool answer(const ToolState& place, ContactSet& out) = 0;
};

class ContactLoop {
public:
    // pause [s]: between looks at the mailbox; about half a haptic period.
    ContactLoop(ContactAnswers& answers, Crossings& crossings, const RunClock& clock, double pause,
                CadenceTrace* trace)
        : answers_(answers)
        , crossings_(crossings)
        , clock_(clock)
        , pause_(pause)
        , trace_(trace) {}

    // Until `stop`. Throws what the query throws.
    void run(const std::atomic<bool>& stop);

private:
    void answerOne(const ToolState& place);

    ContactAnswers& answers_;
    Crossings& crossings_;
    const RunClock& clock_;
    double pause_;
    CadenceTrace* trace_;
    QueryNote note_;
};

} // namespace fathom
