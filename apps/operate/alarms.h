// SPDX-License-Identifier: Apache-2.0
// Alarms in three levels, in words and with a sign, latched until the pilot has acknowledged them.
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

// What no turn tells.
struct Health {
    bool gpuGone = false;       // and no other one is there yet
    bool handGone = false;      // the haptic device is away or silent
    std::string recorderFailed; // why nothing is recorded any more; empty = it is well
};

class Alarms {
public:
    // Looks at the run; once a window frame.
    void step(Console& console, const RunView& run, const HapticOptions& haptics, const Scene& scene,
              const Health& health = {});
    // Raises one that no rule sees.
    void raise(Level level, const std::string& key, const std::string& words, double t);

    // Shown: active, or latched and not yet acknowledged. Highest level first,
    // of one level what is not acknowledged, and what is still on, before the rest.
    std::vector<const Alarm*> shown() const;
    const Alarm* worst() const; // of those not acknowledged; null when none
    std::vector<std::string> inWords() const;

private:
    void set(bool on, Level level, const char* key, const std::string& words, double t);
    void stepScene(const StepRecord& tick, const HapticOptions& haptics, bool deviceGone);
    std::vector<Alarm> alarms_;
    bool waits_ = false;     // for the first picture after the GPU was lost
    int64_t lostFrame_ = -1; // newest picture while it was
};

void drawAlarms(Console& console, const Alarms& alarms);

} // namespace fathom::operate
