// SPDX-License-Identifier: Apache-2.0
// Protrusion and gaps of a tool's spheres against the time of a tick, for different leaf counts. Compares
// covers from `fathom spheres` with cubic grids.
#include "apps/profile/drag.h"
#include "apps/profile/gripper.h"
#include "apps/profile/studies.h"
#include "engine/model/sphere_cover.h"

#include <algorithm>
#include <cmath>

namespace fathom::profile {

namespace {

constexpr size_t kMaxMade = 1024; // leaves of a generated cover; more take minutes

// Presses the tool into the wall and drags it.
DragResult pressed(const StudyContext& context, const Tool& tool) {
    DragSetting d;
    d.tool = &tool;
    d.ticks = context.settings.quick ? 100 : 1000;
    d.spacing = 0.004;
    d.press = 0.002;
    d.follow = true;
    return drag(d);
}

StudyRow rowOf(const StudyContext& context, const std::string& source, const std::vector<Solid>& shape,
               const std::vector<Sphere>& spheres) {
    const Tool tool(buildSphereTree(spheres));
    const Fit fit = fitOf(shape, spheres);
    StudyRow row;
    row.source = source;
    row.setting = std::to_string(tool.leafCount()) + " leaves";
    const DragResult run = pressed(context, tool);
    const double share = static_cast<double>(run.contacts) / static_cast<double>(run.poses.size());
    verify(run.deepest <= 1e-9, "tool", row.setting,
           "a leaf entered region spheres by " + digits(run.deepest * 1e6) + " um");
    verify(share >= 0.9, "tool", row.setting,
           "the tool touches the wall in " + digits(share * 100.0) + " % of the ticks only");
    row.error = std::max(fit.protrusion, fit.gap) * 1e3;
    row.cost = run.steps.cost();
    row.more = {fit.protrusion * 1e3, fit.gap * 1e3, static_cast<double>(tool.leafCount()),
                run.queries.cost().cpu.p50, share};
    return row;
}

double gapAt(const std::vector<Sphere>& spheres, const dvec3& p) {
    double least = HUGE_VAL;
    for (const Sphere& s : spheres) {
        least = std::min(least, glm::length(p - s.centre) - s.radius);
    }
    return least;
}

// Covers from `fathom spheres` for the gripper's mesh. They cover the surface; a cavity inside may remain and
// counts as a gap.
void addMadeCovers(const StudyContext& context, Study& study, const std::vector<Solid>& shape,
                   const std::vector<size_t>& counts) {
    const TriangleMesh mesh = gripperMesh();
    const MeshDistance distance(mesh, true);
    for (size_t most : counts) {
        if (most > kMaxMade) {
            continue;
        }
        CoverOptions options;
        options.leaves = static_cast<uint32_t>(most);
        const std::vector<Sphere> spheres = coverMesh(mesh, distance, options).spheres;
        StudyRow row = rowOf(context, "covers that fathom spheres makes", shape, spheres);
        for (const dvec3& p : mesh.points) {
            verify(gapAt(spheres, p) <= 1e-9, "tool", row.setting, "a point of the mesh is in no sphere");
        }
        study.rows.push_back(std::move(row));
    }
}

} // namespace

Study toolStudy(const StudyContext& context) {
    Study study;
    study.name = "tool";
    study.title = "Tool: how well spheres fit a gripper against the time of a tick";
    study.verified = "covers leave no gap, and generated covers contain the points of the mesh; no leaf "
                     "enters a sphere in any run; nine of ten ticks are in contact";
    study.errorName = "protrusion or gap, the larger";
    study.errorUnit = "mm";
    study.rankBy.time = cpuTime;
    study.timeName = "step in contact, CPU time p50";
    study.moreNames = {"protrusion_mm", "gap_mm", "leaves", "query_p50_ms", "share_in_contact"};
    const std::vector<Solid> shape = gripper();
    const std::vector<size_t> counts =
        context.settings.quick ? std::vector<size_t>{16, 128}
                               : std::vector<size_t>{8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096};
    for (double share : {0.866025404, 0.7}) {
        for (size_t most : counts) {
            StudyRow row = rowOf(context, share > 0.86 ? "covering spheres" : "smaller spheres, with gaps",
                                 shape, coverWith(shape, most, share));
            verify(share < 0.86 || row.more[1] <= 1e-6, "tool", row.setting,
                   "covering spheres leave a gap of " + digits(row.more[1]) + " mm");
            study.rows.push_back(std::move(row));
        }
    }
    addMadeCovers(context, study, shape, counts);
    markFront(study);
    study.noDefault = "no leaf count is a default: the scene file determines the tool's spheres";
    study.findings.push_back(study.noDefault);
    study.panels.push_back(frontPanel(study, "protrusion or gap, the larger"));
    study.panels.push_back(frontPanel(study, "gaps that the spheres leave", {},
                                      [](const StudyRow& row) { return row.more[1]; }));
    study.panels.back().yLabel = "largest gap [mm]";
    return study;
}

} // namespace fathom::profile
