// SPDX-License-Identifier: Apache-2.0
// The state of the forces, as the window shows it: one word, the worst that applies, and chips for the rest.
#pragma once

#include "apps/operate/console.h"
#include "apps/operate/run_view.h"
#include "engine/cycle/haptic_options.h"

#include <imgui.h>
#include <string>
#include <vector>

namespace fathom::operate {

// The pattern of the frame round the large view.
enum class Edge { Thin, Thick, Double, Dashed, Hatched };

// Word, sign, colour and pattern, so that a state never depends on colour alone.
struct Mode {
    const char* word = "";
    const char* sign = "";
    ImU32 colour = 0;
    Edge edge = Edge::Thin;
    const char* meaning = "";
};

// Valid during the call only.
struct ModeInput {
    const Console& console;
    const RunView& run;
    const HapticOptions& haptics;
};

// LOOK-BACK, FORCES OFF, FORCES FADING, HELD, STALE, AT LIMIT, CONTACT or ARMED.
Mode modeOf(const ModeInput& input);

// What does not replace the word: GUIDE, FROZEN, REC, CLUTCH; why there is no force: NO REGIONS YET, LAGS,
// ESCAPING, DEAD-MAN OPEN, DEVICE LOST, REGION GONE, NO CAMERA IMAGE; in playback the recorded state.
struct Chip {
    std::string word;
    ImU32 colour = 0;
    const char* meaning = "";
};
std::vector<Chip> chipsOf(const ModeInput& input);

// The frame inside of a rectangle of the window, and the word with its chips at the middle of its upper edge.
void drawMode(Console& console, const ModeInput& input, ImFont* font, ImVec2 corner, ImVec2 size);
// Why forces did not come on (Console::Messages::refusal), in the middle of the rectangle.
void drawRefusal(Console& console, ImFont* font, ImVec2 corner, ImVec2 size);

} // namespace fathom::operate
