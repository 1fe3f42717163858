// SPDX-License-Identifier: Apache-2.0
// Alarms in three levels, each with text and a sign, filtered in time, latched until the pilot acknowledges
// them.
#pragma once

#include "apps/operate/console.h"
#include "apps/operate/run_view.h"
#include "engine/cycle/haptic_options.h"

#include <deque>
#include <imgui.h>
#include <map>
#include <string>
#include <vector>

namespace fathom::operate {

enum class Level { Advisory, Caution, Warning };

// One line for the pilot: what happens, then what to do; of an alarm that is over, only what happened.
struct Alarm {
    Level level = Level::Advisory;
    std::string key, what, todo;
    double since = 0.0, last = 0.0; // [s] of the run: raised, and cause seen last
    bool active = false, acknowledged = false;
    std::string words() const {
        return !active ? "ended: " + what : todo.empty() ? what : what + ": " + todo;
    }
};

// An alarm that is over.
struct EndedAlarm {
    Level level = Level::Advisory;
    std::string what;
    double since = 0.0, end = 0.0; // [s] of the run
};

const char* levelName(Level level);
const char* levelSign(Level level);
ImU32 levelColour(Level level);

// Conditions that a step record does not contain.
struct Health {
    bool gpuGone = false;       // lost and not reopened yet
    bool handGone = false;      // the haptic device is disconnected or silent
    std::string recorderFailed; // why the recording ended; empty = no failure
};

class Alarms {
public:
    // settle: factor on the times that filter brief causes; 0 = every cause is an alarm at once.
    explicit Alarms(double settle = 1.0)
        : settle_(settle) {}

    // Evaluates all rules; called once per window frame.
    void step(Console& console, const RunView& run, const HapticOptions& haptics, const Scene& scene,
              const Health& health = {});
    // Raises an alarm outside the rules; it is latched at once.
    void raise(Level level, const std::string& key, const std::string& what, double t);

    // Active alarms and latched ones that are not acknowledged. Sorted by level; within a level,
    // unacknowledged and active alarms come first.
    std::vector<const Alarm*> shown() const;
    const Alarm* worst() const; // the first unacknowledged one; null when none
    std::vector<std::string> inWords() const;
    const std::deque<EndedAlarm>& history() const { return history_; } // newest first

private:
    // A cause that may come and go within a moment.
    struct Filter {
        double after = 0.0; // [s] that the cause must last
        double hold = 0.0;  // [s] without it until the alarm is over
    };
    struct Text {
        std::string what, todo;
    };
    void set(bool on, Level level, const std::string& key, const Text& text, double t, Filter filter);
    void set(bool on, Level level, const std::string& key, const Text& text, double t) {
        set(on, level, key, text, t, Filter());
    }
    void update(Alarm& alarm, bool on, const Text& text, double t, Filter filter);
    bool lasts(bool on, const std::string& key, double t, double after);
    void stepProtection(const RunView& run, const Scene& scene, const StepRecord& tick, bool forces);
    void stepScene(const StepRecord& tick, bool deviceGone, bool forces);
    void stepForces(const RunView& run, const HapticOptions& haptics, bool forces);
    void stepTargets(const RunView& run, const Scene& scene, double t);

    double settle_;
    std::vector<Alarm> alarms_;
    std::deque<EndedAlarm> history_;
    std::map<std::string, double>
        pendingSince_;               // [s] start of each cause that has not lasted long enough for an alarm
    bool awaitsGpu_ = false;         // from the loss of the GPU until its next frame
    std::vector<double> regionSeen_; // [s] per fixture row: when it last had a region
    double forcePossible_ = 0.0;     // [s] when a tick last had regions, so that a force was possible
    int64_t lostFrame_ = -1;         // newest frame at that time
};

// Panel: present alarms, then the history.
void drawAlarms(Console& console, const Alarms& alarms);
// Lines over a view, the worst first, as many as there is room for; acknowledged and ended ones are dimmed
// and come last. at: upper left corner; room: width and height.
void drawAlarmLines(Console& console, const Alarms& alarms, ImVec2 at, ImVec2 room);

} // namespace fathom::operate
