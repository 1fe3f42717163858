// SPDX-License-Identifier: Apache-2.0
#include "engine/model/cover_refine.h"

#include "tests/model/meshes.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace fathom;
using namespace fathom::testing;

namespace {

// A plate, whose cells of a grid are far from the best parts.
struct Plate {
    TriangleMesh mesh = boxMesh(dvec3(0.0), {0.3, 0.1, 0.004});
    MeshDistance distance{mesh, true};
    CoverFitting fitting = pieces();

    CoverFitting pieces() const {
        std::vector<CoverPiece> cut = cutToPieces(mesh, distance, 0.006, 0.01);
        PieceGroups groups(cut);
        return {mesh, distance, std::move(cut), std::move(groups), {}};
    }
    // Three of the spheres contain a half, a quarter and an eighth of its length, the others the rest.
    std::vector<Sphere> uneven() const {
        std::vector<CoverShare> shares(8);
        for (uint32_t p = 0; p < fitting.pieces.size(); ++p) {
            const double x = fitting.pieces[p].middle.x / 0.3 + 0.5;
            const int left = std::min(static_cast<int>((x - 0.875) * 40.0), 4);
            shares[x < 0.5 ? 0 : (x < 0.75 ? 1 : (x < 0.875 ? 2 : 3 + left))].push_back(p);
        }
        std::vector<Sphere> spheres;
        for (const CoverShare& share : shares) {
            spheres.push_back(sphereAround(fitting, share));
        }
        return spheres;
    }
};

bool containsAll(const CoverFitting& f, const std::vector<Sphere>& spheres) {
    return std::ranges::all_of(f.pieces, [&spheres](const CoverPiece& piece) {
        return std::ranges::any_of(
            spheres, [&piece](const Sphere& s) { return piece.radiusFrom(s.centre) <= s.radius; });
    });
}

} // namespace

TEST_CASE("Refining splits the worst sphere, merges others for it and still contains every piece") {
    const Plate plate;
    const std::vector<Sphere> before = plate.uneven();
    const std::vector<Sphere> after = refinedCover(plate.fitting, before, 8);
    CHECK(containsAll(plate.fitting, before));
    CHECK(containsAll(plate.fitting, after));
    CHECK(after.size() <= 8);
    CHECK(worstOf(plate.fitting, after) < 0.6 * worstOf(plate.fitting, before));
}

TEST_CASE("Refining uses leaves that are left, and returns a cover that it cannot improve as it was") {
    const Plate plate;
    const std::vector<Sphere> one = refinedCover(plate.fitting, {plate.uneven()[0], plate.uneven()[1]}, 1);
    CHECK(one.size() == 2);
    const std::vector<Sphere> many = refinedCover(plate.fitting, plate.uneven(), 64);
    CHECK(many.size() > 8);
    CHECK(many.size() <= 64);
    CHECK(containsAll(plate.fitting, many));
    const std::vector<Sphere> again = refinedCover(plate.fitting, many, 64);
    CHECK(worstOf(plate.fitting, again) <= worstOf(plate.fitting, many));
}

TEST_CASE("A fitted sphere has the radius of its farthest piece") {
    const Plate plate;
    CoverShare share;
    for (uint32_t p = 0; p < plate.fitting.pieces.size(); p += 3) {
        share.push_back(p);
    }
    const Sphere s = sphereAround(plate.fitting, share);
    CHECK(s.radius == doctest::Approx(radiusAround(plate.fitting.pieces, share, s.centre)).epsilon(1e-11));
}
