// SPDX-License-Identifier: Apache-2.0
#include "tests/apps/drawn_text.h"

#include <algorithm>
#include <cmath>

namespace fathom::testing {

namespace {

bool scrolls(const std::string& list) {
    return list.find("inside") != std::string::npos;
}

void addLetters(const ImDrawList& list, std::vector<DrawnLetter>& letters) {
    for (const ImDrawCmd& command : list.CmdBuffer) {
        for (unsigned int i = 0; i + 5 < command.ElemCount; ++i) {
            const ImDrawIdx* at = list.IdxBuffer.Data + command.IdxOffset + i;
            const bool quad = at[1] == at[0] + 1 && at[2] == at[0] + 2 && at[3] == at[0] && at[4] == at[2] &&
                              at[5] == at[0] + 3;
            if (!quad) {
                continue;
            }
            const ImDrawVert& a = list.VtxBuffer[static_cast<int>(command.VtxOffset) + at[0]];
            const ImDrawVert& c = list.VtxBuffer[static_cast<int>(command.VtxOffset) + at[2]];
            const ImDrawVert& b = list.VtxBuffer[static_cast<int>(command.VtxOffset) + at[1]];
            const bool upright =
                b.pos.y == a.pos.y && b.pos.x == c.pos.x && b.uv.y == a.uv.y && b.uv.x == c.uv.x;
            const bool picture = upright && std::abs((c.uv.x - a.uv.x) * (c.uv.y - a.uv.y)) > 1e-9f;
            if (picture && (a.col >> IM_COL32_A_SHIFT & 0xff) > 20) {
                letters.push_back({{a.pos.x, a.pos.y, c.pos.x, c.pos.y}, command.ClipRect, list._OwnerName});
            }
            i += 5;
        }
    }
}

} // namespace

std::vector<DrawnLetter> drawnLetters() {
    std::vector<DrawnLetter> letters;
    const ImDrawData* data = ImGui::GetDrawData();
    for (int i = 0; i < data->CmdListsCount; ++i) {
        addLetters(*data->CmdLists[i], letters);
    }
    return letters;
}

std::vector<DrawnLetter> cutLetters(const std::vector<DrawnLetter>& letters) {
    constexpr float kOff = 1.0f; // [pixels]
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    std::vector<DrawnLetter> cut;
    for (const DrawnLetter& l : letters) {
        const bool sideways = l.box.x < l.clip.x - kOff || l.box.z > l.clip.z + kOff || l.box.x < -kOff ||
                              l.box.z > size.x + kOff;
        const bool upright = !scrolls(l.list) && (l.box.y < l.clip.y - kOff || l.box.w > l.clip.w + kOff ||
                                                  l.box.y < -kOff || l.box.w > size.y + kOff);
        if (sideways || upright) {
            cut.push_back(l);
        }
    }
    return cut;
}

std::vector<DrawnLetter> overlaps(const std::vector<DrawnLetter>& letters) {
    constexpr float kShare = 0.5f; // of the smaller letter, in both directions
    std::vector<DrawnLetter> found;
    for (size_t i = 0; i < letters.size(); ++i) {
        for (size_t k = i + 1; k < letters.size(); ++k) {
            const ImVec4 &a = letters[i].box, &b = letters[k].box;
            const float x = std::min(a.z, b.z) - std::max(a.x, b.x),
                        y = std::min(a.w, b.w) - std::max(a.y, b.y);
            const float wide = std::min(a.z - a.x, b.z - b.x), high = std::min(a.w - a.y, b.w - b.y);
            if (letters[i].list == letters[k].list && x > kShare * wide && y > kShare * high) {
                found.push_back(letters[i]);
            }
        }
    }
    return found;
}

} // namespace fathom::testing
