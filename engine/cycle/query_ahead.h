// SPDX-License-Identifier: Apache-2.0
// Where the tool will be when an answer of the contact cadence is used.
#pragma once

#include "engine/cycle/step_record.h"

namespace fathom {

// Chooses the pose of the next contact query. While answers are at most kInTime ticks old, that is the
// tool's present pose. While they are later, it is the pose that the tool will have when the answer becomes
// active: the present one, moved by its own velocity for lead(). The reach then grows by what the hand may
// add meanwhile. Haptic thread; noexcept, no allocation.
class QueryAhead {
public:
    // T [s]: haptic period.
    explicit QueryAhead(double period) noexcept
        : period_(period) {}

    // One tick: where the tool is now. elapsed [s]: measured since the last tick; 0 = a period.
    void moved(const ToolPlace& now, double elapsed) noexcept;
    // An answer to a query at `askedAt` [s] became active at `now` [s].
    void answered(double askedAt, double now) noexcept;
    // The tool was placed elsewhere: no velocity.
    void restart() noexcept { started_ = false; }

    // Place and reach of the next query. joints: number of joints of the arm, 0 = free tool.
    QueryPlace ask(const ToolPlace& now, double time, size_t joints) const noexcept;

    double lead() const noexcept; // [s] by which queries look ahead

    static constexpr double kInTime = 2.5;  // ticks: an answer of this age is not late
    static constexpr double kMaxLead = 0.2; // [s]
    // [m] largest growth of the reach for late answers; a pressed arm can add another 0.02 m
    static constexpr double kMaxReach = 0.02;
    static constexpr double kHandAccel = 5.0; // [m/s^2] that a hand may add meanwhile
    static constexpr double kSmooth = 0.005;  // [s] average of the velocity

private:
    double period_;
    double age_ = 0.0; // [s] of recent answers: rises at once, falls slowly
    ToolPlace before_;
    dvec3 velocity_{0.0}, spin_{0.0}; // [m/s], [rad/s]
    JointVector rates_{};             // [rad/s], [m/s]
    bool started_ = false;
};

} // namespace fathom
