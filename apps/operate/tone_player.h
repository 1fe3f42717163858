// SPDX-License-Identifier: Apache-2.0
// Plays the tones of a live run.
#pragma once

#include "apps/operate/speaker.h"
#include "apps/operate/tones.h"

#include <memory>

namespace fathom::operate {

// Window thread.
class TonePlayer {
public:
    // silent: only notes tones, for a run without a window.
    explicit TonePlayer(bool silent)
        : speaker_(silent ? nullptr : std::make_unique<Speaker>()) {}

    // Once per window frame: notes the tone that is due in console.status, and plays it if tones are on.
    void step(Console& console, const RunView& run, const Alarms& alarms);

private:
    ToneRules rules_;
    std::unique_ptr<Speaker> speaker_; // null: silent
};

} // namespace fathom::operate
