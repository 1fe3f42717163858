// SPDX-License-Identifier: Apache-2.0
// Groups of 64 neighbouring surface pieces, so that most containment tests are done once per group.
#pragma once

#include "engine/model/cover_pieces.h"
#include "engine/types/sphere_tree.h"

#include <algorithm>
#include <span>

namespace fathom {

class PieceGroups {
public:
    static constexpr size_t kGroup = 64;

    explicit PieceGroups(const std::vector<CoverPiece>& pieces);

    size_t count() const { return bounds_.size(); }
    size_t size() const { return pieces_.size(); }
    std::span<const CoverPiece> pieces(size_t group) const { // all groups but the last are full
        return std::span(pieces_).subspan(group * kGroup, std::min(kGroup, size() - group * kGroup));
    }
    const Sphere& boundOf(size_t group) const { return bounds_[group]; } // contains its pieces
    // kGroup * group + index in the group, for each piece in input order.
    const std::vector<uint32_t>& places() const { return places_; }

private:
    std::vector<CoverPiece> pieces_;
    std::vector<uint32_t> places_;
    std::vector<Sphere> bounds_;
};

} // namespace fathom
