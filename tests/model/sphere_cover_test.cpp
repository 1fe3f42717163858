// SPDX-License-Identifier: Apache-2.0
#include "engine/model/sphere_cover.h"

#include "engine/model/cover_measure.h"
#include "engine/model/mesh_file.h"
#include "engine/model/sph_file.h"
#include "engine/types/error.h"
#include "tests/model/meshes.h"
#include "tests/support/scratch_folder.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

struct Made {
    Cover cover;
    CoverMeasure measure;
};

Made make(const TriangleMesh& mesh, bool solid, const CoverOptions& options) {
    const MeshDistance distance(mesh, solid);
    Made made;
    made.cover = coverMesh(mesh, distance, options);
    made.measure = measureCover(made.cover.spheres, mesh, distance, 0.3);
    return made;
}

CoverOptions leaves(uint32_t count, uint32_t effort = 1) {
    CoverOptions options;
    options.leaves = count;
    options.effort = effort;
    return options;
}

} // namespace

TEST_CASE("A cover contains the mesh for every number of leaves and keeps its proven bound") {
    const TriangleMesh mesh = boxMesh({0.02, 0.0, -0.01}, {0.12, 0.06, 0.03});
    double before = 1.0;
    for (uint32_t count : {1u, 2u, 7u, 33u}) {
        const Made made = make(mesh, true, leaves(count));
        INFO(count << " leaves");
        CHECK(made.cover.spheres.size() <= count);
        CHECK(made.cover.spheres.size() >= 1);
        CHECK(made.measure.outside == 0);
        CHECK(made.measure.protrusionMax <= made.cover.protrusionBound * (1.0 + 1e-9));
        CHECK(made.measure.bound == doctest::Approx(made.cover.protrusionBound));
        CHECK(made.cover.protrusionBound < before);
        CHECK(made.measure.insideCovered > 0.999);
        before = made.cover.protrusionBound;
    }
}

TEST_CASE("A single sphere around a box is close to the smallest possible") {
    const dvec3 size(0.12, 0.06, 0.03);
    const Made made = make(boxMesh({1.0, 2.0, 3.0}, size), true, leaves(1, 2));
    REQUIRE(made.cover.spheres.size() == 1);
    CHECK(made.cover.spheres[0].radius == doctest::Approx(0.5 * glm::length(size)).epsilon(0.002));
}

TEST_CASE("The allowed protrusion is kept, and a smaller one needs more leaves") {
    const TriangleMesh ring = ringMesh(0.05, 0.015, 40, 20);
    size_t before = 0;
    for (double allowed : {0.01, 0.004, 0.002}) {
        CoverOptions options;
        options.protrusion = allowed;
        const Made made = make(ring, true, options);
        CHECK(made.cover.protrusionBound <= allowed * (1.0 + 1e-9));
        CHECK(made.measure.outside == 0);
        CHECK(made.cover.spheres.size() > before);
        before = made.cover.spheres.size();
    }
    CoverOptions impossible;
    impossible.protrusion = 1e-7;
    CHECK_THROWS_AS(make(ring, true, impossible), Error);
}

TEST_CASE("A mesh without an inside is covered as a shell, with spheres protruding on both sides") {
    TriangleMesh open = boxMesh(dvec3(0.0), dvec3(0.1));
    open.triangles.resize(10);
    const Made made = make(open, false, leaves(40));
    CHECK(made.measure.outside == 0);
    CHECK(made.measure.protrusionMax <= made.cover.protrusionBound * (1.0 + 1e-9));
    CHECK(made.measure.volumeRatio == 0.0);
}

TEST_CASE("Two intersecting parts are covered as one") {
    TriangleMesh cross = boxMesh(dvec3(0.0), {0.1, 0.02, 0.02});
    addBox(cross, dvec3(0.0), {0.02, 0.1, 0.02});
    const Made made = make(cross, true, leaves(30));
    CHECK(made.measure.outside == 0);
    CHECK(made.cover.protrusionBound < 0.01);
}

TEST_CASE("Thin blades of any aspect are cut into few pieces and stay inside of the cover") {
    for (const double thickness : {1e-9, 1e-6, 1e-4, 1e-3}) {
        CAPTURE(thickness);
        const Made made = make(boxMesh({0.0, 0.0, 0.0}, {0.5, thickness, 0.013}), true, leaves(40));
        CHECK(made.measure.outside == 0);
        CHECK(made.cover.pieces < 250'000);
    }
}

TEST_CASE("A cover is deterministic") {
    const TriangleMesh mesh = boxMesh(dvec3(0.0), {0.1, 0.05, 0.02});
    const Made a = make(mesh, true, leaves(12)), b = make(mesh, true, leaves(12));
    REQUIRE(a.cover.spheres.size() == b.cover.spheres.size());
    for (size_t i = 0; i < a.cover.spheres.size(); ++i) {
        CHECK(a.cover.spheres[i].centre == b.cover.spheres[i].centre);
        CHECK(a.cover.spheres[i].radius == b.cover.spheres[i].radius);
    }
}

TEST_CASE("The measure detects an uncovered corner and the protrusion of a sphere") {
    const TriangleMesh mesh = boxMesh(dvec3(0.0), dvec3(2.0));
    const MeshDistance distance(mesh, true);
    const std::vector<Sphere> ball{{dvec3(0.0), 1.5}};
    const CoverMeasure m = measureCover(ball, mesh, distance, 0.3);
    CHECK(m.outside >= 8); // the corners at least
    CHECK(m.deepestGap == doctest::Approx(std::sqrt(3.0) - 1.5).epsilon(1e-9));
    CHECK(m.protrusionMax == doctest::Approx(0.5).epsilon(0.01));
    CHECK(m.bound == doctest::Approx(0.5).epsilon(1e-9));
    const std::vector<Sphere> large{{dvec3(0.0), 2.0}};
    const CoverMeasure whole = measureCover(large, mesh, distance, 0.3);
    CHECK(whole.outside == 0);
    CHECK(whole.volumeRatio == doctest::Approx(4.18879).epsilon(0.03));
    CHECK(whole.insideCovered == 1.0);
}

TEST_CASE("The tree of a real jaw contains the jaw: the leaves read from the file contain every sample") {
    const std::filesystem::path file = "../shared/data/meshes/uuv_manipulators_Apache-2.0/Jaw.stl";
    if (!std::filesystem::exists(file)) {
        MESSAGE("SKIPPED: no such file: " << file);
        return;
    }
    const LoadedMesh loaded = loadMesh(file);
    const MeshDistance distance(loaded.mesh, loaded.facts.closed());
    const Cover cover = coverMesh(loaded.mesh, distance, leaves(48));
    const testing::ScratchFile sph("jaw.sph");
    writeSph(buildSphereTree(cover.spheres), sph.path());
    const SphereTree tree = readSph(sph.path());
    std::vector<Sphere> used;
    for (const Sphere& s : tree.lastLevel()) {
        if (s.radius >= 0.0) {
            used.push_back(s);
        }
    }
    CHECK(used.size() == cover.spheres.size());
    const CoverMeasure m = measureCover(used, loaded.mesh, distance, 0.5);
    CHECK(m.outside == 0);
    CHECK(m.protrusionMax < 0.016);
}
