// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/panel_items.h"

#include <algorithm>
#include <bit>

namespace fathom::operate {

namespace {

PixelBox boxOf(const ImDrawVert& a, const ImDrawVert& b, const ImDrawVert& c) {
    const auto [left, right] = std::minmax({a.pos.x, b.pos.x, c.pos.x});
    const auto [top, bottom] = std::minmax({a.pos.y, b.pos.y, c.pos.y});
    return {pixelFrom(left), pixelFrom(top), pixelFrom(right), pixelFrom(bottom)};
}

// ImGui's order of a rectangle's corners: 0, 1, 2, 0, 2, 3, clockwise from the top left.
bool isRectangleAt(const ImDrawIdx* index, const ImDrawVert* vertices) {
    if (index[3] != index[0] || index[4] != index[2]) {
        return false;
    }
    const ImDrawVert &a = vertices[index[0]], &b = vertices[index[1]], &c = vertices[index[2]],
                     &d = vertices[index[5]];
    const bool square = a.pos.y == b.pos.y && b.pos.x == c.pos.x && c.pos.y == d.pos.y && d.pos.x == a.pos.x;
    const bool even = a.uv.y == b.uv.y && b.uv.x == c.uv.x && c.uv.y == d.uv.y && d.uv.x == a.uv.x;
    return square && even && a.col == b.col && a.col == c.col && a.col == d.col && a.pos.x <= c.pos.x &&
           a.pos.y <= c.pos.y;
}

uint64_t word(float a, float b) {
    return uint64_t{std::bit_cast<uint32_t>(a)} << 32 | std::bit_cast<uint32_t>(b);
}

uint64_t word(int a, int b) {
    return uint64_t{static_cast<uint32_t>(a)} << 32 | static_cast<uint32_t>(b);
}

uint64_t mixedVertex(uint64_t hash, const ImDrawVert& v) {
    return mixed(mixed(mixed(hash, word(v.pos.x, v.pos.y)), word(v.uv.x, v.uv.y)), v.col);
}

void appendCommand(const ImDrawList& list, const ImDrawCmd& command, const PixelBox& clip,
                   std::vector<PanelItem>& items) {
    const ImDrawIdx* index = list.IdxBuffer.Data + command.IdxOffset;
    const ImDrawVert* vertices = list.VtxBuffer.Data + command.VtxOffset;
    for (unsigned i = 0; i + 2 < command.ElemCount;) {
        PanelItem item;
        item.isRectangle = i + 5 < command.ElemCount && isRectangleAt(index + i, vertices);
        item.a = vertices[index[i]];
        item.b = vertices[index[i + (item.isRectangle ? 2 : 1)]];
        item.c = item.isRectangle ? item.b : vertices[index[i + 2]];
        item.box = overlap(boxOf(item.a, item.b, item.c), clip);
        if (!item.box.empty()) {
            items.push_back(item);
        }
        i += item.isRectangle ? 6 : 3;
    }
}

} // namespace

PixelBox overlap(const PixelBox& a, const PixelBox& b) {
    return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

uint64_t PanelItem::hash() const {
    uint64_t h = mixed(isRectangle ? 2 : 1, word(box.x0, box.y0));
    h = mixedVertex(mixedVertex(mixed(h, word(box.x1, box.y1)), a), b);
    return isRectangle ? h : mixedVertex(h, c);
}

void listItems(const ImDrawData& data, const PixelBox& window, std::vector<PanelItem>& items) {
    items.clear();
    for (int i = 0; i < data.CmdListsCount; ++i) {
        const ImDrawList& list = *data.CmdLists[i];
        for (const ImDrawCmd& command : list.CmdBuffer) {
            const ImVec4& c = command.ClipRect;
            const PixelBox clip{static_cast<int>(c.x), static_cast<int>(c.y), static_cast<int>(c.z),
                                static_cast<int>(c.w)};
            if (command.UserCallback == nullptr) {
                appendCommand(list, command, overlap(clip, window), items);
            }
        }
    }
}

} // namespace fathom::operate
