// SPDX-License-Identifier: Apache-2.0
#include "engine/model/piece_groups.h"

#include <algorithm>
#include <numeric>

namespace fathom {

namespace {

// Halves along the longest side, at multiples of the group's size, until one group is left.
void sortNeighbours(const std::vector<CoverPiece>& pieces, std::span<uint32_t> part) {
    if (part.size() <= PieceGroups::kGroup) {
        return;
    }
    dvec3 low(1e300), high(-1e300);
    for (const uint32_t p : part) {
        low = glm::min(low, pieces[p].middle);
        high = glm::max(high, pieces[p].middle);
    }
    const dvec3 size = high - low;
    const int side = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const size_t groups = (part.size() + PieceGroups::kGroup - 1) / PieceGroups::kGroup;
    const size_t half = groups / 2 * PieceGroups::kGroup;
    std::nth_element(part.begin(), part.begin() + static_cast<std::ptrdiff_t>(half), part.end(),
                     [&](uint32_t a, uint32_t b) {
                         const double x = pieces[a].middle[side], y = pieces[b].middle[side];
                         return x != y ? x < y : a < b;
                     });
    sortNeighbours(pieces, part.first(half));
    sortNeighbours(pieces, part.subspan(half));
}

Sphere sphereAbout(std::span<const CoverPiece> group) {
    dvec3 low(1e300), high(-1e300);
    for (const CoverPiece& piece : group) {
        low = glm::min(low, piece.middle);
        high = glm::max(high, piece.middle);
    }
    Sphere about{0.5 * (low + high), 0.0};
    for (const CoverPiece& piece : group) {
        about.radius = std::max(about.radius, glm::distance(about.centre, piece.middle) + piece.reach);
    }
    return about;
}

} // namespace

PieceGroups::PieceGroups(const std::vector<CoverPiece>& pieces)
    : places_(pieces.size()) {
    std::vector<uint32_t> order(pieces.size());
    std::iota(order.begin(), order.end(), 0u);
    sortNeighbours(pieces, order);
    for (const uint32_t p : order) {
        places_[p] = static_cast<uint32_t>(pieces_.size());
        pieces_.push_back(pieces[p]);
    }
    for (size_t first = 0; first < size(); first += kGroup) {
        bounds_.push_back(sphereAbout(this->pieces(first / kGroup)));
    }
}

} // namespace fathom
