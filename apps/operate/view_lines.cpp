// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/view_lines.h"

#include "apps/operate/theme.h"

#include <algorithm>
#include <cmath>

namespace fathom::operate {

void dashed(ImDrawList& list, ImVec2 a, ImVec2 b, ImU32 colour, float width, float dash) {
    const float length = std::hypot(b.x - a.x, b.y - a.y);
    for (float at = 0.0f; at < length; at += 2.0f * dash) {
        const float s = at / length, e = std::min(1.0f, (at + dash) / length);
        list.AddLine({a.x + (b.x - a.x) * s, a.y + (b.y - a.y) * s},
                     {a.x + (b.x - a.x) * e, a.y + (b.y - a.y) * e}, colour, width);
    }
}

void thin(std::vector<ImVec2>& points) {
    constexpr float kOff = 0.25f;       // [pixels]
    constexpr size_t kMaxReplaced = 16; // points that one segment may replace
    const auto off = [&](size_t from, size_t to, size_t i) {
        const ImVec2 a = points[from], b = points[to], p = points[i];
        const float x = b.x - a.x, y = b.y - a.y;
        return std::abs(x * (p.y - a.y) - y * (p.x - a.x)) / std::max(1e-6f, std::hypot(x, y));
    };
    size_t kept = 0;
    for (size_t from = 0; from + 1 < points.size();) {
        size_t to = from + 1;
        const auto straight = [&](size_t end) {
            for (size_t i = from + 1; i < end; ++i) {
                if (off(from, end, i) > kOff) {
                    return false;
                }
            }
            return true;
        };
        while (to + 1 < points.size() && to - from < kMaxReplaced && straight(to + 1)) {
            ++to;
        }
        points[++kept] = points[to]; // overwrites only visited points: kept <= to
        from = to;
    }
    points.resize(std::min(points.size(), kept + 1));
}

void fillUnion(ImDrawList& list, const std::vector<Circle>& circles, ImU32 colour) {
    constexpr float kRow = 2.0f; // [pixels]
    float top = 1e9f, bottom = -1e9f;
    for (const Circle& c : circles) {
        top = std::min(top, c.y - c.r);
        bottom = std::max(bottom, c.y + c.r);
    }
    std::vector<std::pair<float, float>> runs;
    for (float y = std::floor(top); y < std::min(bottom, top + 2000.0f); y += kRow) {
        runs.clear();
        for (const Circle& c : circles) {
            const float dy = y + 0.5f * kRow - c.y, square = c.r * c.r - dy * dy;
            if (square > 0.0f) {
                runs.emplace_back(c.x - std::sqrt(square), c.x + std::sqrt(square));
            }
        }
        std::sort(runs.begin(), runs.end());
        for (size_t i = 0; i < runs.size();) {
            float end = runs[i].second;
            size_t next = i + 1;
            for (; next < runs.size() && runs[next].first <= end; ++next) {
                end = std::max(end, runs[next].second);
            }
            list.AddRectFilled({runs[i].first, y}, {end, y + kRow}, colour);
            i = next;
        }
    }
}

void outline(ImDrawList& list, const ViewPort& port, const std::vector<OutlineLine>& lines, ImU32 colour,
             float width, bool isDashed) {
    std::vector<ImVec2> points;
    for (const OutlineLine& l : lines) {
        points.clear();
        for (const glm::dvec2& p : l) {
            points.push_back(port.ofFrame(p));
        }
        constexpr size_t kDash = 7;
        if (!isDashed) {
            thin(points);
        }
        const size_t piece = isDashed ? kDash : std::max<size_t>(1, points.size());
        for (size_t i = 0; i < points.size(); i += 2 * piece) {
            const auto count = static_cast<int>(std::min(piece, points.size() - i));
            list.AddPolyline(points.data() + i, count, colour::kShade, 0, width + 2.0f);
            list.AddPolyline(points.data() + i, count, colour, 0, width);
        }
    }
}

} // namespace fathom::operate
