// SPDX-License-Identifier: Apache-2.0
#include "engine/model/piece_groups.h"

#include "tests/model/meshes.h"

#include <algorithm>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

TEST_CASE("Every piece is in one group and inside its sphere; all groups but the last are full") {
    const TriangleMesh ring = ringMesh(0.05, 0.015, 40, 20);
    std::vector<CoverPiece> all = cutToPieces(ring, MeshDistance(ring, true), 0.004, 0.01);
    REQUIRE(all.size() > 200);
    for (const size_t count : {size_t{0}, size_t{1}, size_t{63}, size_t{64}, size_t{65}, all.size()}) {
        CAPTURE(count);
        const std::vector<CoverPiece> pieces(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count));
        const PieceGroups groups(pieces);
        CHECK(groups.size() == count);
        CHECK(groups.count() == (count + 63) / 64);
        REQUIRE(groups.places().size() == count);
        std::vector<int> seen(count, 0);
        double largest = 0.0;
        for (size_t p = 0; p < count; ++p) {
            const uint32_t place = groups.places()[p];
            const CoverPiece& there = groups.pieces(place / 64)[place % 64];
            ++seen[place];
            CHECK(there.middle == pieces[p].middle);
            const Sphere& about = groups.boundOf(place / 64);
            CHECK(there.radiusFrom(about.centre) <= about.radius * (1.0 + 1e-12));
            largest = std::max(largest, about.radius);
        }
        CHECK(std::count(seen.begin(), seen.end(), 1) == static_cast<std::ptrdiff_t>(count));
        CHECK((count < all.size() || largest < 0.05)); // neighbours, not any 64
    }
}
