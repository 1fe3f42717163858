// SPDX-License-Identifier: Apache-2.0
// Protrusion and gaps of a tool's spheres against the time of a turn, over the number of leaves. The tool is
// an analytic gripper, so that its distance is exact.
#include "apps/profile/drag.h"
#include "apps/profile/studies.h"
#include "devices/simulated/solid.h"

#include <algorithm>

namespace fathom::profile {

namespace {

// Palm, wrist and two fingers; towards -z, where the wall is.
std::vector<Solid> gripper() {
    const Paint paint;
    const Pose palm{dvec3(0.0, 0.0, 0.0), dquat(1, 0, 0, 0)};
    return {boxAt(palm, dvec3(0.045, 0.02, 0.012), paint),
            capsuleBetween(dvec3(0, 0, 0.02), dvec3(0, 0, 0.1), 0.018, paint),
            capsuleBetween(dvec3(0.035, 0, -0.01), dvec3(0.035, 0, -0.06), 0.008, paint),
            capsuleBetween(dvec3(-0.035, 0, -0.01), dvec3(-0.035, 0, -0.06), 0.008, paint)};
}

double distanceTo(const std::vector<Solid>& shape, const dvec3& p) {
    double least = HUGE_VAL;
    for (const Solid& s : shape) {
        least = std::min(least, signedDistance(s, p));
    }
    return least;
}

// Spheres on a cubic grid of edge `cell` wherever the cell's ball meets the shape. share 0.866 (half the
// cell's diagonal) covers the shape wholly; less leaves gaps and stands out less.
std::vector<Sphere> cover(const std::vector<Solid>& shape, double cell, double share) {
    std::vector<Sphere> spheres;
    const double radius = share * cell;
    for (double z = -0.07 - 0.5 * cell; z <= 0.12 + cell; z += cell) {
        for (double y = -cell * std::floor(0.022 / cell + 0.5); y <= 0.022 + cell; y += cell) {
            for (double x = -cell * std::floor(0.048 / cell + 0.5); x <= 0.048 + cell; x += cell) {
                if (distanceTo(shape, {x, y, z}) < 0.866 * cell) {
                    spheres.push_back({{x, y, z}, radius});
                }
            }
        }
    }
    return spheres;
}

// The finest grid of at most `most` spheres.
std::vector<Sphere> coverWith(const std::vector<Solid>& shape, size_t most, double share) {
    double fine = 0.002, coarse = 0.12;
    for (int i = 0; i < 18; ++i) {
        const double middle = std::sqrt(fine * coarse);
        (cover(shape, middle, share).size() > most ? fine : coarse) = middle;
    }
    return cover(shape, coarse, share);
}

struct Fit {
    double protrusion = 0.0, gap = 0.0; // [m] farthest of the spheres from the shape; of the shape from them
};

// By the points of each sphere that no exact formula bounds: 200 directions, and shape points on a 2 mm grid.
Fit fitOf(const std::vector<Solid>& shape, const std::vector<Sphere>& spheres) {
    Fit fit;
    for (const Sphere& s : spheres) {
        for (int k = 0; k < 200; ++k) {
            const double z = 1.0 - (2.0 * k + 1.0) / 200.0, a = 2.399963229728653 * k,
                         ring = std::sqrt(1.0 - z * z);
            fit.protrusion = std::max(
                fit.protrusion,
                distanceTo(shape, s.centre + s.radius * dvec3(ring * std::cos(a), ring * std::sin(a), z)));
        }
    }
    for (double z = -0.07; z <= 0.12; z += 0.002) {
        for (double y = -0.022; y <= 0.022; y += 0.002) {
            for (double x = -0.048; x <= 0.048; x += 0.002) {
                if (distanceTo(shape, {x, y, z}) > 0.0) {
                    continue;
                }
                double least = HUGE_VAL;
                for (const Sphere& s : spheres) {
                    least = std::min(least, glm::length(dvec3(x, y, z) - s.centre) - s.radius);
                }
                fit.gap = std::max(fit.gap, least);
            }
        }
    }
    return fit;
}

StudyRow rowOf(const StudyContext& context, const std::vector<Solid>& shape, size_t most, double share) {
    const std::vector<Sphere> spheres = coverWith(shape, most, share);
    const Tool tool(buildSphereTree(spheres));
    const Fit fit = fitOf(shape, spheres);
    StudyRow row;
    row.source = share > 0.86 ? "covering spheres" : "smaller spheres, with gaps";
    row.setting = std::to_string(tool.leafCount()) + " leaves";
    verify(share < 0.86 || fit.gap <= 1e-9, "tool", row.setting,
           "covering spheres leave a gap of " + digits(fit.gap * 1e3) + " mm");
    DragSetting d;
    d.tool = &tool;
    d.ticks = context.settings.quick ? 100 : 1000;
    d.spacing = 0.004;
    d.press = 0.002;
    const DragResult run = drag(d);
    verify(run.deepest <= 1e-9, "tool", row.setting,
           "a leaf entered a sphere by " + digits(run.deepest * 1e6) + " um");
    row.error = std::max(fit.protrusion, fit.gap) * 1e3;
    row.cost = run.turns.cost();
    row.more = {fit.protrusion * 1e3, fit.gap * 1e3, static_cast<double>(tool.leafCount()),
                run.queries.cost().cpu.p50,
                static_cast<double>(run.contacts) / static_cast<double>(run.poses.size())};
    return row;
}

} // namespace

Study toolStudy(const StudyContext& context) {
    Study study;
    study.name = "tool";
    study.title = "Tool: how well spheres fit a gripper against the time of a turn";
    study.verified = "covering spheres leave no gap; no leaf in a sphere in any run";
    study.errorName = "protrusion or gap, the larger";
    study.errorUnit = "mm";
    study.time = TimeKind::Cpu;
    study.timeName = "turn in contact, CPU time p50";
    study.moreNames = {"protrusion_mm", "gap_mm", "leaves", "query_p50_ms", "share_in_contact"};
    const std::vector<Solid> shape = gripper();
    const std::vector<size_t> counts =
        context.settings.quick ? std::vector<size_t>{16, 128}
                               : std::vector<size_t>{8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096};
    for (double share : {0.866025404, 0.7}) {
        for (size_t most : counts) {
            study.rows.push_back(rowOf(context, shape, most, share));
        }
    }
    markFront(study);
    study.noDefault = "no count is a default: the scene file gives the tool's spheres";
    study.findings.push_back(study.noDefault);
    study.panels.push_back(frontPanel(study, "protrusion or gap, the larger"));
    return study;
}

} // namespace fathom::profile
