// SPDX-License-Identifier: Apache-2.0
// Alarms in three levels, each with text and a sign, latched until the pilot acknowledges them.
#pragma once

#include "apps/operate/console.h"
#include "apps/operate/run_view.h"
#include "engine/cycle/haptic_options.h"

#include <imgui.h>
#include <string>
#include <vector>

namespace fathom::operate {

enum class Level { Advisory, Caution, Warning };

struct Alarm {
    Level level = Level::Advisory;
    std::string key, words;
    double since = 0.0; // [s] of the run
    bool active = false, acknowledged = false;
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
    // Evaluates all rules; called once per window frame.
    void step(Console& console, const RunView& run, const HapticOptions& haptics, const Scene& scene,
              const Health& health = {});
    // Raises an alarm outside the rules.
    void raise(Level level, const std::string& key, const std::string& words, double t);

    // Active alarms and latched ones that are not acknowledged. Sorted by level; within a level,
    // unacknowledged and active alarms come first.
    std::vector<const Alarm*> shown() const;
    const Alarm* worst() const; // the first unacknowledged one; null when none
    std::vector<std::string> inWords() const;

private:
    void set(bool on, Level level, const char* key, const std::string& words, double t);
    void stepProtection(const RunView& run, const Scene& scene, const StepRecord& tick);
    void stepScene(const StepRecord& tick, const HapticOptions& haptics, bool deviceGone);
    std::vector<Alarm> alarms_;
    bool waits_ = false;             // true until the first frame after the GPU was lost
    std::vector<double> regionSeen_; // [s] per fixture row: when it last had a region
    double forcesSeen_ = 0.0;        // [s] when a set was last obeyed
    int64_t lostFrame_ = -1;         // newest frame at that time
};

void drawAlarms(Console& console, const Alarms& alarms);

} // namespace fathom::operate
