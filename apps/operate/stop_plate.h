// SPDX-License-Identifier: Apache-2.0
// Always on screen: the key that turns forces off, and the keys that are useful now.
#pragma once

#include "apps/operate/console.h"
#include "apps/operate/hud.h"
#include "apps/operate/layout.h"

namespace fathom::operate {

// The places of gap bar and stop plate: right of the view where its room is wide enough, otherwise inside.
void besideView(Rooms& rooms, const PixelRect& view, float scale);
// The plate; a click on it turns forces off, too.
void drawStop(Console& console, const Fonts& fonts, const PixelRect& room);
// The keyboard's cursor, and the useful keys and the newest notice at the lower edge of a view, left of the
// stop plate. driven: a device or path moves the hand.
void drawHint(Console& console, bool driven, const PixelRect& view, const PixelRect& stop);
// Text that ends at `bottom`, in as many lines as the width needs, on a dark plate. Returns its height.
float drawWordsAbove(float x, float bottom, float width, const std::string& words, ImU32 colour);
// As many of the pieces, which are separated by three spaces, as the width has room for; the last stays.
std::string piecesThatFit(const std::string& hint, float width);

} // namespace fathom::operate
