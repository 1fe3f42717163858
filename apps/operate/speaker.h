// SPDX-License-Identifier: Apache-2.0
// Plays tones through ALSA, which is loaded when the first one is played.
#pragma once

#include "apps/operate/tones.h"

#include <memory>

namespace fathom::operate {

// Window thread. A thread of its own waits for the sound card, and no other thread waits for it. Without ALSA
// or a sound card it logs one line, and tones are silent.
class Speaker {
public:
    Speaker();
    ~Speaker(); // waits at most a second for a note that still plays
    Speaker(const Speaker&) = delete;
    Speaker& operator=(const Speaker&) = delete;

    void play(Tone tone); // returns at once; replaces a tone that has not begun

private:
    struct Shared;
    std::unique_ptr<Shared> shared_;
};

} // namespace fathom::operate
