// SPDX-License-Identifier: Apache-2.0
// Sphere covers of a mesh for the command `spheres`: Fathom's, and an octree and a grid to compare it with.
#pragma once

#include "apps/spheres/spheres_report.h"
#include "engine/model/sphere_cover.h"
#include "engine/reference/cell_cover.h"
#include "engine/types/clock.h"

#include <string>
#include <utility>
#include <vector>

namespace fathom {

// Covers one mesh, by several methods, and measures each cover.
class CoverMaker {
public:
    explicit CoverMaker(const LoadedMesh& loaded)
        : mesh_(loaded.mesh)
        , distance_(loaded.mesh, loaded.facts.closed()) {}

    Cover ours(const CoverOptions& options) {
        const auto start = Clock::now();
        Cover cover = coverMesh(mesh_, distance_, options);
        add("fathom", cover.spheres, start);
        return cover;
    }
    void others(size_t leaves) {
        auto start = Clock::now();
        add("octree", reference::octreeCover(mesh_, distance_, leaves), start);
        start = Clock::now();
        add("grid", reference::gridCover(mesh_, distance_, leaves), start);
    }
    const std::vector<CoverRow>& rows() const { return rows_; }
    std::vector<CoverRow> takeRows() { return std::exchange(rows_, {}); }

private:
    void add(const std::string& name, const std::vector<Sphere>& spheres, Clock::time_point start) {
        const double took = secondsSince(start);
        rows_.push_back({name, spheres.size(), measureCover(spheres, mesh_, distance_), took});
    }

    const TriangleMesh& mesh_;
    MeshDistance distance_;
    std::vector<CoverRow> rows_;
};

} // namespace fathom
