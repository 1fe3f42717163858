// SPDX-License-Identifier: Apache-2.0
#include "engine/model/cover_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <queue>

namespace fathom {

namespace {

struct Span3 {
    dvec3 low{std::numeric_limits<double>::max()}, high{-std::numeric_limits<double>::max()};
    void add(const dvec3& p) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
};

Span3 spanOf(const std::vector<CoverPiece>& pieces, const CoverShare& share) {
    Span3 span;
    for (uint32_t p : share) {
        for (const dvec3& corner : pieces[p].corner) {
            span.add(corner - pieces[p].margin);
            span.add(corner + pieces[p].margin);
        }
    }
    return span;
}

CoverShare everything(const std::vector<CoverPiece>& pieces) {
    CoverShare all(pieces.size());
    for (uint32_t p = 0; p < all.size(); ++p) {
        all[p] = p;
    }
    return all;
}

using Cell = std::array<int, 3>;

std::map<Cell, CoverShare> cellsOf(const std::vector<CoverPiece>& pieces, const Span3& span, double edge) {
    std::map<Cell, CoverShare> cells;
    const dvec3 count = glm::ceil((span.high - span.low) / edge - 1e-9);
    for (uint32_t p = 0; p < pieces.size(); ++p) {
        const dvec3 at =
            glm::min(glm::floor((pieces[p].middle - span.low) / edge), glm::max(count - 1.0, dvec3(0.0)));
        cells[{static_cast<int>(at.x), static_cast<int>(at.y), static_cast<int>(at.z)}].push_back(p);
    }
    return cells;
}

} // namespace

std::pair<CoverShare, CoverShare> halvesOf(const std::vector<CoverPiece>& pieces, const CoverShare& share) {
    const Span3 span = spanOf(pieces, share);
    const dvec3 size = span.high - span.low, middle = 0.5 * (span.low + span.high);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    std::pair<CoverShare, CoverShare> parts;
    for (uint32_t p : share) {
        (pieces[p].middle[axis] <= middle[axis] ? parts.first : parts.second).push_back(p);
    }
    return parts;
}

dvec3 middleOf(const std::vector<CoverPiece>& pieces, const CoverShare& share) {
    const Span3 span = spanOf(pieces, share);
    return 0.5 * (span.low + span.high);
}

std::vector<CoverShare> gridShares(const std::vector<CoverPiece>& pieces, size_t most) {
    const Span3 span = spanOf(pieces, everything(pieces));
    const dvec3 size = span.high - span.low;
    const double longest = std::max(size.x, std::max(size.y, size.z));
    std::vector<CoverShare> best{everything(pieces)};
    for (int n = 2, misses = 0; misses < 3 && n < 200; ++n) { // the count need not rise with n
        const std::map<Cell, CoverShare> cells = cellsOf(pieces, span, longest / n);
        if (cells.size() > most) {
            ++misses;
            continue;
        }
        best.clear();
        for (const auto& [cell, share] : cells) {
            best.push_back(share);
        }
    }
    return best;
}

std::vector<CoverShare> splitShares(const std::vector<CoverPiece>& pieces, size_t most,
                                    const std::function<double(const CoverShare&)>& badness) {
    std::vector<CoverShare> shares{everything(pieces)};
    std::priority_queue<std::pair<double, size_t>> worst;
    worst.push({badness(shares[0]), 0});
    while (shares.size() < most && !worst.empty()) {
        const size_t at = worst.top().second;
        worst.pop();
        auto [first, second] = halvesOf(pieces, shares[at]);
        if (first.empty() || second.empty()) {
            continue;
        }
        worst.push({badness(first), at});
        worst.push({badness(second), shares.size()});
        shares[at] = std::move(first);
        shares.push_back(std::move(second));
    }
    return shares;
}

} // namespace fathom
