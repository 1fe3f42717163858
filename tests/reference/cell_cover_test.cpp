// SPDX-License-Identifier: Apache-2.0
#include "engine/reference/cell_cover.h"

#include "engine/model/cover_measure.h"
#include "engine/model/sphere_cover.h"
#include "tests/model/meshes.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

TEST_CASE("Grid and octree spheres contain the mesh and stay within their number") {
    const TriangleMesh mesh = boxMesh(dvec3(0.0), {0.12, 0.06, 0.03});
    const MeshDistance distance(mesh, true);
    for (size_t most : {1u, 10u, 100u}) {
        for (const auto& spheres :
             {reference::gridCover(mesh, distance, most), reference::octreeCover(mesh, distance, most)}) {
            CHECK(spheres.size() >= 1);
            CHECK(spheres.size() <= most);
            CHECK(measureCover(spheres, mesh, distance, 0.1).outside == 0);
        }
    }
}

TEST_CASE("At the same number of leaves our worst protrusion is not above that of grid and octree") {
    for (const TriangleMesh& mesh :
         {boxMesh(dvec3(0.0), {0.12, 0.06, 0.03}), ringMesh(0.05, 0.015, 40, 20)}) {
        const MeshDistance distance(mesh, true);
        for (uint32_t count : {8u, 40u}) {
            CoverOptions options;
            options.leaves = count;
            options.effort = 1;
            const auto worst = [&](const std::vector<Sphere>& spheres) {
                return measureCover(spheres, mesh, distance, 0.2).protrusionMax;
            };
            const double ours = worst(coverMesh(mesh, distance, options).spheres);
            // 1 % allows for sampling: for a box of 4 x 2 x 1 cubes, these cubes are the best cover.
            CHECK(ours < 1.01 * worst(reference::gridCover(mesh, distance, count)));
            CHECK(ours < 1.01 * worst(reference::octreeCover(mesh, distance, count)));
        }
    }
}
