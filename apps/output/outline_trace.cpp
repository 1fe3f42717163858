// SPDX-License-Identifier: Apache-2.0
#include "apps/output/silhouette.h"

#include <algorithm>
#include <cstddef>

namespace fathom {

namespace {

struct Corner {
    int u, v; // the top left corner of pixel (u, v)
};

// Walks along the border of a mask with the inside to the right.
class Walker {
public:
    Walker(const std::vector<uint8_t>& mask, int width, int height)
        : mask_(mask)
        , width_(width)
        , height_(height)
        , seen_(mask.size()) {}

    bool inside(int u, int v) const {
        return u >= 0 && v >= 0 && u < width_ && v < height_ && mask_[at(u, v)] != 0;
    }
    // A top edge (pixel inside, pixel above outside) that no walk has visited.
    bool fresh(int u, int v) const { return inside(u, v) && !inside(u, v - 1) && seen_[at(u, v)] == 0; }

    std::vector<Corner> walk(int u, int v) {
        std::vector<Corner> corners;
        Corner here{u, v};
        int heading = 0; // 0 right, 1 down, 2 left, 3 up
        do {
            corners.push_back(here);
            if (heading == 0) {
                seen_[at(here.u, here.v)] = 1;
            }
            here.u += kStepU[heading];
            here.v += kStepV[heading];
            heading = next(here, heading);
        } while (here.u != u || here.v != v || heading != 0);
        corners.push_back(here);
        return corners;
    }

private:
    static constexpr int kStepU[4] = {1, 0, -1, 0};
    static constexpr int kStepV[4] = {0, 1, 0, -1};

    size_t at(int u, int v) const {
        return static_cast<size_t>(v) * static_cast<size_t>(width_) + static_cast<size_t>(u);
    }

    // Turns left if the pixel ahead on the left is inside (diagonal neighbours are connected), goes straight
    // if the pixel ahead on the right is inside, and otherwise turns right.
    int next(const Corner& c, int heading) const {
        // Offset of the pixel ahead on the left of the corner, for each heading.
        constexpr int kLeftU[4] = {0, 0, -1, -1}, kLeftV[4] = {-1, 0, 0, -1};
        const int right = (heading + 1) % 4;
        if (inside(c.u + kLeftU[heading], c.v + kLeftV[heading])) {
            return (heading + 3) % 4;
        }
        return inside(c.u + kLeftU[right], c.v + kLeftV[right]) ? heading : right;
    }

    const std::vector<uint8_t>& mask_;
    int width_, height_;
    std::vector<uint8_t> seen_;
};

// Moving average along the line. Removes the staircase of a border between pixels.
OutlineLine smooth(const OutlineLine& line, bool closed) {
    const auto count =
        static_cast<std::ptrdiff_t>(line.size()) - (closed ? 1 : 0); // a closed line repeats its start
    const std::ptrdiff_t half = std::min<std::ptrdiff_t>(4, count / 8);
    std::vector<glm::dvec2> sums{
        glm::dvec2(0.0)}; // of all points before; exact, the points are whole numbers
    sums.reserve(line.size() + 1);
    for (const glm::dvec2& p : line) {
        sums.push_back(sums.back() + p);
    }
    const auto sum = [&](std::ptrdiff_t from, std::ptrdiff_t to) { // of points [from, to), inside the line
        return sums[static_cast<size_t>(to)] - sums[static_cast<size_t>(from)];
    };
    OutlineLine result;
    result.reserve(line.size());
    for (std::ptrdiff_t i = 0; i < count; ++i) {
        const std::ptrdiff_t reach = closed ? half : std::min({half, i, count - 1 - i});
        const std::ptrdiff_t from = i - reach, to = i + reach + 1;
        glm::dvec2 all = sum(std::max<std::ptrdiff_t>(0, from), std::min(count, to));
        if (from < 0) { // beyond the start: the end of a closed line
            all += sum(count + from, count);
        }
        if (to > count) {
            all += sum(0, to - count);
        }
        result.push_back(all / static_cast<double>(2 * reach + 1));
    }
    if (closed && !result.empty()) {
        result.push_back(result.front());
    }
    return result;
}

// Appends the pieces of a closed walk that do not follow the edge of the image.
void appendPieces(const std::vector<Corner>& corners, int width, int height,
                  std::vector<OutlineLine>& lines) {
    const auto edge = [&](const Corner& a, const Corner& b) {
        return (a.u == b.u && (a.u == 0 || a.u == width)) || (a.v == b.v && (a.v == 0 || a.v == height));
    };
    OutlineLine piece;
    bool whole = true;
    const size_t before = lines.size();
    for (size_t i = 0; i < corners.size(); ++i) {
        if (i > 0 && edge(corners[i - 1], corners[i])) {
            whole = false;
            if (piece.size() > 1) {
                lines.push_back(smooth(piece, false));
            }
            piece.clear();
        }
        piece.emplace_back(corners[i].u, corners[i].v);
    }
    if (piece.size() < 2) {
        return;
    }
    // The walk began inside the last piece, so the first piece continues it.
    lines.push_back(smooth(piece, whole));
    if (!whole && lines.size() > before + 1 && lines[before].front() == lines.back().back()) {
        lines.back().insert(lines.back().end(), lines[before].begin() + 1, lines[before].end());
        lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(before));
    }
}

} // namespace

std::vector<OutlineLine> traceOutline(const std::vector<uint8_t>& mask, int width, int height, size_t least) {
    std::vector<OutlineLine> lines;
    Walker walker(mask, width, height);
    for (int v = 0; v < height; ++v) {
        const uint8_t* row = mask.data() + static_cast<size_t>(v) * static_cast<size_t>(width);
        for (int u = 0; u < width; ++u) {
            const bool top = row[u] != 0 && (v == 0 || row[u - width] == 0); // most pixels are no border
            if (top && walker.fresh(u, v)) {
                const std::vector<Corner> corners = walker.walk(u, v);
                if (corners.size() > least) {
                    appendPieces(corners, width, height, lines);
                }
            }
        }
    }
    return lines;
}

// A rim of one pixel makes the edge of the image a border like any other.
std::vector<OutlineLine> traceArea(const std::vector<uint8_t>& mask, int width, int height) {
    const auto across = static_cast<size_t>(width), wide = across + 2;
    std::vector<uint8_t> rimmed(wide * (static_cast<size_t>(height) + 2));
    for (size_t v = 0; v < static_cast<size_t>(height); ++v) {
        std::copy_n(mask.data() + v * across, across, rimmed.data() + (v + 1) * wide + 1);
    }
    std::vector<OutlineLine> lines = traceOutline(rimmed, width + 2, height + 2, 0);
    for (OutlineLine& line : lines) {
        for (glm::dvec2& p : line) {
            p -= 1.0;
        }
    }
    return lines;
}

} // namespace fathom
