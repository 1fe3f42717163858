// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/tone_player.h"

#include <optional>

namespace fathom::operate {

void TonePlayer::step(Console& console, const RunView& run, const Alarms& alarms) {
    const std::optional<Tone> tone = rules_.step(console, run, alarms);
    if (!tone) {
        return;
    }
    console.status.lastTone = toneName(*tone);
    ++console.status.toneCount;
    if (console.settings.tones && speaker_) {
        speaker_->play(*tone);
    }
}

} // namespace fathom::operate
