// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/panel_fill.h"

#include <algorithm>

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
        const Coverage::Line line =
            fonts.line(item.a.uv.y + (static_cast<float>(y) + 0.5f - item.a.pos.y) * dv);
        for (int x = box.x0; x < box.x1; ++x) {
            const float u = item.a.uv.x + (static_cast<float>(x) + 0.5f - item.a.pos.x) * du;
            if (const uint32_t covered = line.at(u); covered != 0) {
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
        top = p.y;
        bottom = q.y;
        x = p.x;
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

// Colour and coverage of a triangle's pixels. Most triangles are the soft edges of lines: one colour, one
// texel.
class Shading {
public:
    Shading(const PanelItem& item, const Coverage& fonts)
        : item_(item)
        , fonts_(fonts)
        , ink_(inkOf(item.a.col))
        , oneColour_(((item.a.col ^ item.b.col) & 0xffffffu) == 0 &&
                     ((item.a.col ^ item.c.col) & 0xffffffu) == 0)
        , oneAlpha_(((item.a.col ^ item.b.col) | (item.a.col ^ item.c.col)) >> 24 == 0)
        , oneTexel_(item.a.uv.x == item.b.uv.x && item.a.uv.x == item.c.uv.x && item.a.uv.y == item.b.uv.y &&
                    item.a.uv.y == item.c.uv.y)
        , oneLine_(item.a.uv.y == item.b.uv.y && item.a.uv.y == item.c.uv.y) {
        const ImVec2 &p = item.a.pos, &q = item.b.pos, &r = item.c.pos;
        bx_ = q.x - p.x;
        by_ = q.y - p.y;
        cx_ = r.x - p.x;
        cy_ = r.y - p.y;
        const float area = bx_ * cy_ - by_ * cx_;
        inverse_ = area != 0.0f ? 1.0f / area : 0.0f;
        for (int k = oneColour_ ? 3 : 0; k < 4; ++k) {
            const auto channel = [&](const ImDrawVert& v) {
                return static_cast<float>(v.col >> (8 * k) & 0xffu);
            };
            channels_[k] = slopeOf(channel(item.a), channel(item.b), channel(item.c));
        }
        if (oneTexel_) {
            covered_ = fonts.at(item.a.uv.x, item.a.uv.y);
        } else {
            u_ = slopeOf(item.a.uv.x, item.b.uv.x, item.c.uv.x);
            v_ = slopeOf(item.a.uv.y, item.b.uv.y, item.c.uv.y);
            line_ = fonts.line(item.a.uv.y);
        }
    }

    void run(uint32_t* row, int y, int from, int to) const {
        const float dy = static_cast<float>(y) + 0.5f - item_.a.pos.y;
        for (int x = from; x < to; ++x) {
            const float dx = static_cast<float>(x) + 0.5f - item_.a.pos.x;
            const uint32_t covered = oneTexel_  ? covered_
                                     : oneLine_ ? line_.at(u_.at(dx, dy))
                                                : fonts_.at(u_.at(dx, dy), v_.at(dx, dy));
            const uint32_t level = oneColour_ && oneAlpha_ ? ink_.alpha : this->level(3, dx, dy);
            row[x] = over(row[x], oneColour_ ? ink_ : inkAt(dx, dy),
                          covered == 255 ? level : product(level, covered));
        }
    }

private:
    Slope slopeOf(float a, float b, float c) const {
        const float db = b - a, dc = c - a;
        return {a, (db * cy_ - dc * by_) * inverse_, (dc * bx_ - db * cx_) * inverse_};
    }
    uint32_t level(int k, float dx, float dy) const {
        return static_cast<uint32_t>(
            static_cast<int>(std::clamp(channels_[k].at(dx, dy) + 0.5f, 0.0f, 255.0f)));
    }
    Ink inkAt(float dx, float dy) const {
        return {level(0, dx, dy) << 16 | level(2, dx, dy), level(1, dx, dy) << 8, 255};
    }

    const PanelItem& item_;
    const Coverage& fonts_;
    Ink ink_;
    bool oneColour_, oneAlpha_, oneTexel_, oneLine_; // ImGui's textures of lines are one line each
    float bx_, by_, cx_, cy_, inverse_;              // edges from corner a; 1 / area
    uint32_t covered_ = 255;
    Coverage::Line line_;
    Slope channels_[4], u_, v_;
};

// Calls run(y, from, to) for the rows of a triangle inside the box.
template <class Run>
void eachRow(const PanelItem& item, const PixelBox& box, Run&& run) {
    const Side sides[3] = {{item.a.pos, item.b.pos}, {item.b.pos, item.c.pos}, {item.c.pos, item.a.pos}};
    for (int y = box.y0; y < box.y1; ++y) {
        const float centre = static_cast<float>(y) + 0.5f;
        float left = 1e6f, right = -1e6f;
        for (const Side& side : sides) {
            const float x = side.at(centre);
            left = side.crosses(centre) ? std::min(left, x) : left;
            right = side.crosses(centre) ? std::max(right, x) : right;
        }
        const int from = std::max(box.x0, pixelFrom(left)), to = std::min(box.x1, pixelFrom(right));
        if (from < to) {
            run(y, from, to);
        }
    }
}

void fillTriangle(const RasterImage& image, const PanelItem& item, const PixelBox& box,
                  const Coverage& fonts) {
    if (isFlat(item)) {
        const Ink ink = inkOf(item.a.col);
        const uint32_t alpha = product(ink.alpha, fonts.at(item.a.uv.x, item.a.uv.y));
        eachRow(item, box, [&](int y, int from, int to) { fillRun(image.row(y), from, to, ink, alpha); });
        return;
    }
    const Shading shading(item, fonts);
    eachRow(item, box, [&](int y, int from, int to) { shading.run(image.row(y), y, from, to); });
}

} // namespace

Coverage::Line Coverage::line(float v) const {
    const float y = std::clamp(v * static_cast<float>(height) - 0.5f, 0.0f, static_cast<float>(height - 1));
    const int y0 = static_cast<int>(y);
    Line line;
    line.upper = texels + static_cast<size_t>(y0) * static_cast<size_t>(width);
    line.lower = y0 + 1 < height ? line.upper + width : line.upper;
    line.width = width;
    line.share = static_cast<uint32_t>(static_cast<int>((y - static_cast<float>(y0)) * 256.0f + 0.5f));
    return line;
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
