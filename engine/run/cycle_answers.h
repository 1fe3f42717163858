// SPDX-License-Identifier: Apache-2.0
// ContactAnswers of a run: asks the device's cycles.
#pragma once

#include "engine/cycle/device_cycles.h"
#include "engine/run/contact_loop.h"

namespace fathom {

// Answers queries over the newest fixture set of the cycles, which must outlive it.
class CycleAnswers final : public ContactAnswers {
public:
    explicit CycleAnswers(DeviceCycles& cycles)
        : cycles_(cycles) {}
    bool answer(const QueryPlace& at, ContactSet& out) override { return cycles_.answer(at, out); }
    double clearance(const ToolPlace& place) override { return cycles_.clearance(place); }

private:
    DeviceCycles& cycles_;
};

} // namespace fathom
