// SPDX-License-Identifier: Apache-2.0
// The letters that an ImGui frame draws, to find cut and overlapping text.
#pragma once

#include <imgui.h>
#include <string>
#include <vector>

namespace fathom::testing {

// A letter, its clip rectangle, and the draw list it is in. Pixels of the window.
struct DrawnLetter {
    ImVec4 box, clip; // x0, y0, x1, y1
    std::string list;
};

// The letters of the last rendered frame: quads with a picture of the font's texture.
std::vector<DrawnLetter> drawnLetters();

// Letters cut by their clip rectangle or the window's edge, by more than a pixel. Lists that scroll may cut
// them at their upper and lower ends.
std::vector<DrawnLetter> cutLetters(const std::vector<DrawnLetter>& letters);

// Letters that another letter of the same list covers.
std::vector<DrawnLetter> overlaps(const std::vector<DrawnLetter>& letters);

} // namespace fathom::testing
