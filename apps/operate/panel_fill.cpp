// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/panel_fill.h"

#include <algorithm>
#include <cmath>

namespace fathom::operate {

namespace {

// Colour of ImGui (0xAABBGGRR) as the channels of the image.
struct Ink {
    uint32_t redBlue, green, alpha;
};

Ink inkOf(ImU32 c) {
    return {(c & 0xffu) << 16 | (c >> 16 & 0xffu), c & 0xff00u, c >> 24};
}

uint32_t product(uint32_t a, uint32_t b) { // of two shares of 255
    return (a * b + 127) / 255;
}

uint32_t over(uint32_t below, const Ink& ink, uint32_t alpha) {
    const uint32_t share = alpha + (alpha >> 7), rest = 256 - share; // of 256
    const uint32_t redBlue = ((below & 0xff00ffu) * rest + ink.redBlue * share + 0x800080u) >> 8 & 0xff00ffu;
    const uint32_t green = ((below & 0xff00u) * rest + ink.green * share + 0x8000u) >> 8 & 0xff00u;
    return 0xff000000u | redBlue | green;
}

void fillRun(uint32_t* row, int from, int to, const Ink& ink, uint32_t alpha) {
    if (alpha == 255) {
        std::fill(row + from, row + to, 0xff000000u | ink.redBlue | ink.green);
        return;
    }
    for (int x = from; x < to && alpha != 0; ++x) {
        row[x] = over(row[x], ink, alpha);
    }
}

bool isFlat(const PanelItem& item) {
    return item.a.uv.x == item.b.uv.x && item.a.uv.y == item.b.uv.y &&
           (item.isRectangle || (item.a.uv.x == item.c.uv.x && item.a.uv.y == item.c.uv.y &&
                                 item.a.col == item.b.col && item.a.col == item.c.col));
}

void fillRectangle(const RasterImage& image, const PanelItem& item, const PixelBox& box,
                   const Coverage& fonts) {
    const Ink ink = inkOf(item.a.col);
    const uint32_t alpha = product(ink.alpha, fonts.at(item.a.uv.x, item.a.uv.y));
    const bool flat = isFlat(item);
    const float du = (item.b.uv.x - item.a.uv.x) / (item.b.pos.x - item.a.pos.x);
    const float dv = (item.b.uv.y - item.a.uv.y) / (item.b.pos.y - item.a.pos.y);
    for (int y = box.y0; y < box.y1; ++y) {
        uint32_t* row = image.row(y);
        if (flat) {
            fillRun(row, box.x0, box.x1, ink, alpha);
            continue;
        }
        const float v = item.a.uv.y + (static_cast<float>(y) + 0.5f - item.a.pos.y) * dv;
        for (int x = box.x0; x < box.x1; ++x) {
            const float u = item.a.uv.x + (static_cast<float>(x) + 0.5f - item.a.pos.x) * du;
            if (const uint32_t covered = fonts.at(u, v); covered != 0) {
                row[x] = over(row[x], ink, product(ink.alpha, covered));
            }
        }
    }
}

// One side of a triangle, from its upper end.
struct Side {
    float top, bottom, x, slope;
    Side(ImVec2 p, ImVec2 q) {
        if (p.y > q.y || (p.y == q.y && p.x > q.x)) {
            std::swap(p, q); // neighbours compute the same crossing
        }
        top = p.y, bottom = q.y, x = p.x;
        slope = q.y > p.y ? (q.x - p.x) / (q.y - p.y) : 0.0f;
    }
    bool crosses(float y) const { return top <= y && y < bottom; }
    float at(float y) const { return x + (y - top) * slope; }
};

// A value that is linear over a triangle.
struct Slope {
    float here = 0.0f, x = 0.0f, y = 0.0f; // at corner a, per pixel
    float at(float dx, float dy) const { return here + dx * x + dy * y; }
};

class Shading {
public:
    explicit Shading(const PanelItem& item)
        : item_(item)
        , ink_(inkOf(item.a.col))
        , oneColour_(((item.a.col ^ item.b.col) & 0xffffffu) == 0 &&
                     ((item.a.col ^ item.c.col) & 0xffffffu) == 0) {
        for (int k = 0; k < 4; ++k) {
            const auto channel = [&](const ImDrawVert& v) {
                return static_cast<float>(v.col >> (8 * k) & 0xffu);
            };
            channels_[k] = slopeOf(channel(item.a), channel(item.b), channel(item.c));
        }
        u_ = slopeOf(item.a.uv.x, item.b.uv.x, item.c.uv.x);
        v_ = slopeOf(item.a.uv.y, item.b.uv.y, item.c.uv.y);
        oneTexel_ = u_.x == 0.0f && u_.y == 0.0f && v_.x == 0.0f && v_.y == 0.0f;
    }

    void run(uint32_t* row, int y, int from, int to, const Coverage& fonts) const {
        const float dy = static_cast<float>(y) + 0.5f - item_.a.pos.y;
        uint32_t covered = fonts.at(u_.here, v_.here);
        for (int x = from; x < to; ++x) {
            const float dx = static_cast<float>(x) + 0.5f - item_.a.pos.x;
            covered = oneTexel_ ? covered : fonts.at(u_.at(dx, dy), v_.at(dx, dy));
            const uint32_t alpha = product(level(3, dx, dy), covered);
            row[x] = over(row[x], oneColour_ ? ink_ : inkAt(dx, dy), alpha);
        }
    }

private:
    Slope slopeOf(float a, float b, float c) const {
        const ImVec2 &p = item_.a.pos, &q = item_.b.pos, &r = item_.c.pos;
        const float bx = q.x - p.x, by = q.y - p.y, cx = r.x - p.x, cy = r.y - p.y, area = bx * cy - by * cx;
        const float db = b - a, dc = c - a;
        return area != 0.0f ? Slope{a, (db * cy - dc * by) / area, (dc * bx - db * cx) / area}
                            : Slope{a, 0.0f, 0.0f};
    }
    uint32_t level(int k, float dx, float dy) const {
        return static_cast<uint32_t>(std::clamp(channels_[k].at(dx, dy) + 0.5f, 0.0f, 255.0f));
    }
    Ink inkAt(float dx, float dy) const {
        return {level(0, dx, dy) << 16 | level(2, dx, dy), level(1, dx, dy) << 8, 255};
    }

    const PanelItem& item_;
    Ink ink_;
    bool oneColour_, oneTexel_ = false;
    Slope channels_[4], u_, v_;
};

void fillTriangle(const RasterImage& image, const PanelItem& item, const PixelBox& box,
                  const Coverage& fonts) {
    const Side sides[3] = {{item.a.pos, item.b.pos}, {item.b.pos, item.c.pos}, {item.c.pos, item.a.pos}};
    const bool flat = isFlat(item);
    const Ink ink = inkOf(item.a.col);
    const uint32_t alpha = flat ? product(ink.alpha, fonts.at(item.a.uv.x, item.a.uv.y)) : 0;
    const Shading shading(item);
    for (int y = box.y0; y < box.y1; ++y) {
        const float centre = static_cast<float>(y) + 0.5f;
        float left = 1e9f, right = -1e9f;
        for (const Side& side : sides) {
            if (side.crosses(centre)) {
                left = std::min(left, side.at(centre));
                right = std::max(right, side.at(centre));
            }
        }
        if (left >= right) {
            continue;
        }
        const int from = std::max(box.x0, static_cast<int>(std::ceil(std::max(left, -1e6f) - 0.5f)));
        const int to = std::min(box.x1, static_cast<int>(std::ceil(std::min(right, 1e6f) - 0.5f)));
        if (flat && from < to) {
            fillRun(image.row(y), from, to, ink, alpha);
        } else if (from < to) {
            shading.run(image.row(y), y, from, to, fonts);
        }
    }
}

} // namespace

uint32_t Coverage::at(float u, float v) const {
    const float x = std::clamp(u * static_cast<float>(width) - 0.5f, 0.0f, static_cast<float>(width - 1));
    const float y = std::clamp(v * static_cast<float>(height) - 0.5f, 0.0f, static_cast<float>(height - 1));
    const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
    const auto fx = static_cast<uint32_t>((x - static_cast<float>(x0)) * 256.0f + 0.5f);
    const auto fy = static_cast<uint32_t>((y - static_cast<float>(y0)) * 256.0f + 0.5f);
    const unsigned char* upper = texels + static_cast<size_t>(y0) * static_cast<size_t>(width) + x0;
    const unsigned char* lower = y0 + 1 < height ? upper + width : upper;
    const int next = x0 + 1 < width ? 1 : 0;
    const uint32_t above = upper[0] * (256 - fx) + upper[next] * fx;
    const uint32_t below = lower[0] * (256 - fx) + lower[next] * fx;
    return (above * (256 - fy) + below * fy + 0x8000u) >> 16;
}

void fillItem(const RasterImage& image, const PanelItem& item, const PixelBox& within,
              const Coverage& fonts) {
    const PixelBox box = overlap(item.box, within);
    if (box.empty()) {
        return;
    }
    if (item.isRectangle) {
        fillRectangle(image, item, box, fonts);
    } else {
        fillTriangle(image, item, box, fonts);
    }
}

bool hides(const PanelItem& item, const PixelBox& box, const Coverage& fonts) {
    return item.isRectangle && item.a.col >> 24 == 255 && isFlat(item) && overlap(item.box, box) == box &&
           fonts.at(item.a.uv.x, item.a.uv.y) == 255;
}

} // namespace fathom::operate
