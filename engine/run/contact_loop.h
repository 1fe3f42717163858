// SPDX-License-Identifier: Apache-2.0
// The contact cadence in real time: queries the newest fixture set at the newest tool pose, once per new
// pose.
#pragma once

#include "engine/cycle/cadence_trace.h"
#include "engine/run/channels.h"
#include "engine/run/run_clock.h"

namespace fathom {

// The queries as the loops use them.
class ContactAnswers {
public:
    virtual ~ContactAnswers() = default;
    // Contact thread. Fills `out` for the newest fixture set; false when there is none yet.
    virtual bool answer(const QueryPlace& at, ContactSet& out) = 0;
    // Clearance thread. StepRecord::clearance of the tool there; NaN = not known.
    virtual double clearance(const ToolPlace& /*place*/) { return kNotKnown; }
};

class ContactLoop {
public:
    // pause [s]: between polls of an empty mailbox; about half a haptic period.
    ContactLoop(ContactAnswers& answers, Channels& channels, const RunClock& clock, double pause,
                CadenceTrace* trace)
        : answers_(answers)
        , channels_(channels)
        , clock_(clock)
        , pause_(pause)
        , trace_(trace) {}

    // Runs until `stop`. Passes on exceptions of the query.
    void run(const std::atomic<bool>& stop);

private:
    void answerOne(const QueryPlace& at);

    ContactAnswers& answers_;
    Channels& channels_;
    const RunClock& clock_;
    double pause_;
    CadenceTrace* trace_;
    QueryNote note_;
};

} // namespace fathom
