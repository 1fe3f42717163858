// SPDX-License-Identifier: Apache-2.0
// Warnings of a realtime run about its ticks: a scene that is too old, numbers that are not finite. For one
// thread, which may log.
#pragma once

#include "engine/cycle/step_record.h"
#include "engine/run/channels.h"

#include <cstdint>

namespace fathom {

// Limits the warnings about a state that begins and ends to one per kQuiet. A spell that begins earlier after
// the last warning is reported late, if it lasts until then.
class SpellWarning {
public:
    static constexpr double kQuiet = 5.0; // [s] from one warning to the next
    enum class Event {
        None,
        Begin, // warn now, once per spell
        End,   // of a spell with a warning
    };

    // t: of the tick [s], ascending. on: whether it is in the state.
    Event see(double t, bool on) noexcept;

private:
    double quietUntil_ = 0.0; // [s]
    bool warned_ = false;     // of the present spell
};

// Warns when forces begin to fade because the scene is old, and when frames are fresh again. Counts old
// ticks.
class AgeAlarm {
public:
    // warns: false = only count.
    explicit AgeAlarm(bool warns)
        : warns_(warns) {}

    void see(const StepRecord& record);
    uint64_t staleTicks() const { return staleTicks_; }

private:
    bool warns_;
    SpellWarning warning_;
    uint64_t staleTicks_ = 0;
};

// Warns when ticks begin to have numbers that are not finite; such ticks have no force.
class NumberAlarm {
public:
    void see(const TickRow& row);

private:
    SpellWarning warning_;
};

} // namespace fathom
