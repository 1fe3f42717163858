// SPDX-License-Identifier: Apache-2.0
// The card that lists the recordings of a folder and opens one.
#pragma once

#include "apps/operate/console.h"

#include <filesystem>

namespace fathom::operate {

// The folders in `in` that hold a recording with its scene, the newest first; at most 200. Throws Error in
// one line when the folder cannot be read.
std::vector<std::string> recordingsIn(const std::filesystem::path& in);

// Once per window frame: lists them when the pilot asks, and takes the keys O, Enter and Esc. Then
// OpenCard::next names what to open and OpenCard::leaves requests the end of this window. mayGoLive: the live
// run is one of the choices.
void stepOpenCard(Console& console, const std::filesystem::path& in, bool mayGoLive);
// After the last frame: what opens next; empty = nothing. Nothing opens when the time or a signal (stopped)
// has ended the window before the pilot closed it.
std::string opensNext(const Console& console, bool stopped);
// In the middle of a rectangle of the window.
void drawOpenCard(Console& console, ImVec2 corner, ImVec2 size);

} // namespace fathom::operate
