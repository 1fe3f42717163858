// SPDX-License-Identifier: Apache-2.0
// Surface error against build time over the error budget and the radius: how far the boundary of the spheres
// that are kept lies from that of all spheres.
#include "apps/profile/region_boundary.h"
#include "apps/profile/shot_source.h"
#include "apps/profile/studies.h"

#include "engine/contact/cull_cpu.h"
#include "engine/reference/contact_oracle.h"

namespace fathom::profile {

namespace {

constexpr double kReach = 0.01;   // [m] of the queries
constexpr double kOutward = 2e-6; // [m] float32 rounding of centres and radii

struct Built {
    StudyRow row;
    RegionSpheres spheres; // of the first frame
};

Scene sceneFor(const Settings& settings, double radius, double budget) {
    Scene scene = studyScene(settings);
    scene.errorBudget = budget;
    scene.holdSeconds = 0.0; // of one frame: nothing is held over from the one before
    for (FixtureClass& f : scene.fixtures) {
        f.radius = radius;
    }
    return scene;
}

void timeQueries(const StudyContext& context, const FrameBench& bench, const Pose& camera, StudyRow& row) {
    const Tool tool = ballTool(256);
    const Fixtures& host = bench.set().host;
    const Pose pose = touchingPose(tool, host, camera);
    CullCpu cull;
    ContactSet set;
    cull.query(tool, pose, kReach, host, bench.set().grid, set);
    std::vector<uint32_t> found = set.source;
    verify(set.reach < 0.9 * kReach || found == oracleSources(tool, pose, kReach, host), "fixture",
           row.setting, "the query differs from brute force");
    const Cost cost = timeCpu(context.settings.effort(),
                              [&] { cull.query(tool, pose, kReach, host, bench.set().grid, set); });
    row.more.push_back(cost.submit.p50);
    row.more.push_back(static_cast<double>(host.spheres.size()));
}

Built build(const StudyContext& context, const ShotSource& source, double radius, double budget,
            const RegionSpheres* all) {
    FrameBench bench(context.device, sceneFor(context.settings, radius, budget), source.camera);
    Built built;
    built.row.source = source.name + " R " + digits(radius * 1e3) + " mm";
    built.row.setting = digits(budget * 1e3) + " mm";
    bench.run(source.shots.front());
    built.spheres = bench.set().host.spheres;
    BoundaryError error;
    if (all != nullptr && all->size() > 0) {
        error = boundaryError(*all, built.spheres, context.settings.quick ? 300 : 2000, 7);
        verify(error.worstInside <= kOutward, "fixture", built.row.setting,
               "the region shrank by " + digits(error.worstInside * 1e6) + " um");
        verify(error.max <= budget + kOutward, "fixture", built.row.setting,
               "the boundary moved by " + digits(error.max * 1e6) + " um, more than the budget");
    }
    const FrameCost cost = bench.measure(source.shots, context.settings.effort());
    built.row.error = error.max * 1e3;
    built.row.cost = cost.frame;
    built.row.more = {error.rms * 1e3, cost.publish.p50, cost.total.p50};
    if (built.spheres.size() > 0) {
        timeQueries(context, bench, source.shots.front().baseTcamera, built.row);
    } else {
        built.row.more.resize(5, NAN);
    }
    return built;
}

PlotPanel queryPanel(const Study& study) {
    PlotPanel panel = frontPanel(study, "query of 256 leaves in touch, 10 mm reach, CPU",
                                 [](const StudyRow& row) { return row.more[3]; });
    panel.xLabel = "query p50 [ms]";
    return panel;
}

} // namespace

Study fixtureStudy(const StudyContext& context) {
    Study study;
    study.name = "fixture";
    study.title = "Fixture: what the error budget costs and saves";
    study.verified = "kept spheres cover all spheres, error within the budget, query equal to brute force";
    study.errorName = "largest distance between the boundaries of kept and of all spheres";
    study.errorUnit = "mm";
    study.timeName = "submission until landed, p50";
    study.moreNames = {"error_rms_mm", "publish_p50_ms", "upload_to_published_p50_ms", "query_p50_ms",
                       "spheres"};
    study.defaultReason = "0.1 mm is a fifth of the sensor noise, so nobody can feel what a smaller budget "
                          "keeps; where the noise "
                          "itself lets few points go, leaving them out costs the pass and gains little, "
                          "elsewhere the query and "
                          "the publishing gain (query_p50_ms, spheres)";
    const bool quick = context.settings.quick;
    const double chosen = studyScene(context.settings).errorBudget;
    const std::vector<double> radii = quick ? std::vector{0.04} : std::vector{0.003, 0.01, 0.04, 0.06};
    const std::vector<double> budgets =
        quick ? std::vector{0.0, 0.0001, 0.001}
              : std::vector{0.0, 0.00002, 0.00005, 0.0001, 0.0002, 0.0005, 0.001, 0.002};
    for (const ShotSource& source : studySources(context.settings, {"torus", "plane"}, 2)) {
        for (double radius : radii) {
            RegionSpheres all;
            for (double budget : budgets) {
                Built built = build(context, source, radius, budget, budget > 0.0 ? &all : nullptr);
                built.row.isDefault = budget == chosen && radius == radii[radii.size() - (quick ? 1 : 2)];
                if (budget == 0.0) {
                    all = std::move(built.spheres);
                }
                study.rows.push_back(std::move(built.row));
            }
        }
    }
    markFront(study);
    study.panels = {frontPanel(study, "build: submission until the set has landed"), queryPanel(study)};
    for (PlotPanel& panel : study.panels) {
        panel.yLabel = "largest boundary error [mm]";
    }
    return study;
}

} // namespace fathom::profile
