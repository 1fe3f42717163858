// SPDX-License-Identifier: Apache-2.0
// Surface error against build time for error budgets and radii. The error is the distance between the
// boundaries of the kept spheres and of all spheres.
#include "apps/profile/frame_sequence.h"
#include "apps/profile/interleave.h"
#include "apps/profile/region_boundary.h"
#include "apps/profile/studies.h"

#include "engine/contact/cull_cpu.h"
#include "engine/reference/contact_oracle.h"

namespace fathom::profile {

namespace {

constexpr double kReach = 0.01;   // [m] of the queries
constexpr double kOutward = 2e-6; // [m] float32 rounding of centres and radii

Scene sceneFor(const Settings& settings, double radius, double budget) {
    Scene scene = studyScene(settings);
    scene.errorBudget = budget;
    scene.holdSeconds = 0.0; // single frames: no held points
    for (FixtureClass& f : scene.fixtures) {
        f.radius = radius;
    }
    return scene;
}

// Always queries the set of the first frame, so that every budget is measured on the same surface.
void addQuery(const StudyContext& context, FrameBench& bench, const SampleFrame& image, StudyRow& row) {
    bench.run(image);
    const HostFixtures& host = bench.set().host;
    if (host.spheres.size() == 0) {
        row.more.insert(row.more.end(), {NAN, 0.0});
        return;
    }
    const Tool tool = ballTool(256);
    const Pose pose = touchingPose(tool, host, image.baseTcamera);
    CullCpu cull({host.spheres.size(), tool.leafCount() * host.spheres.size()}); // room for all results
    ContactSet set;
    cull.query(tool, pose, kReach, host, bench.set().grid.get(), set);
    verify(set.reach > 0.99 * kReach, "fixture", row.setting, "the query answered for a shorter reach");
    verify(set.source == oracleSources(tool, pose, kReach, host), "fixture", row.setting,
           "the query differs from brute force");
    const Cost cost = timeCpu(context.settings.repeats(),
                              [&] { cull.query(tool, pose, kReach, host, bench.set().grid.get(), set); });
    row.more.insert(row.more.end(), {cost.submit.p50, static_cast<double>(host.spheres.size())});
}

// Boundary error against all spheres. Throws when it exceeds the budget or the region shrank.
BoundaryError errorOf(const StudyContext& context, const RegionSpheres& all, const RegionSpheres& kept,
                      double budget, const std::string& setting) {
    if (budget == 0.0 || all.size() == 0) {
        return {};
    }
    const BoundaryError error = boundaryError(all, kept, context.settings.quick ? 300 : 2000, 7);
    verify(error.worstInside <= kOutward, "fixture", setting,
           "the region shrank by " + digits(error.worstInside * 1e6) + " um");
    verify(error.max <= budget + kOutward, "fixture", setting,
           "the boundary moved by " + digits(error.max * 1e6) + " um, more than the budget");
    return error;
}

// Measures all budgets of one radius, interleaved. The first budget is 0.
void addRadius(const StudyContext& context, Study& study, const FrameSequence& source, double radius,
               const std::vector<double>& budgets, bool usual) {
    std::vector<std::unique_ptr<FrameBench>> benches;
    std::vector<StudyRow> rows;
    RegionSpheres all;
    for (const double budget : budgets) {
        benches.push_back(std::make_unique<FrameBench>(
            context.device, sceneFor(context.settings, radius, budget), source.camera));
        benches.back()->run(source.frames.front());
        const RegionSpheres& spheres = benches.back()->set().host.spheres;
        if (budget == 0.0) {
            all = spheres;
            refuseEmpty(context.settings, source, all);
        }
        StudyRow& row = rows.emplace_back();
        row.source = source.name + " R " + digits(radius * 1e3) + " mm";
        row.setting = digits(budget * 1e3) + " mm";
        row.isDefault = usual && budget == studyScene(context.settings).errorBudget;
        const BoundaryError error = errorOf(context, all, spheres, budget, row.setting);
        row.error = error.max * 1e3;
        row.more = {error.rms * 1e3};
    }
    const std::vector<FrameCost> costs =
        measureInterleaved(benches, source.frames, context.settings.repeats());
    for (size_t i = 0; i < rows.size(); ++i) {
        rows[i].cost = costs[i].frame;
        rows[i].more.insert(rows[i].more.end(), {costs[i].publish.p50, costs[i].total.p50});
        addQuery(context, *benches[i], source.frames.front(), rows[i]);
        study.rows.push_back(std::move(rows[i]));
    }
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
    study.rankBy.time = [](const StudyRow& row) { return row.more[2]; };
    study.timeName = "upload until published, p50";
    study.moreNames = {"error_rms_mm", "publish_p50_ms", "upload_to_published_p50_ms", "query_p50_ms",
                       "spheres"};
    study.rankBy.reason = "0.1 mm is a fifth of the sensor noise, so the points that a smaller budget keeps "
                          "cannot be felt; where noise keeps most points, thinning costs time in the pass "
                          "and gains little, elsewhere the query and publishing gain (query_p50_ms, spheres)";
    const bool quick = context.settings.quick;
    const std::vector<double> radii = quick ? std::vector{0.04} : std::vector{0.003, 0.01, 0.04, 0.06};
    const std::vector<double> budgets =
        quick ? std::vector{0.0, 0.0001, 0.001}
              : std::vector{0.0, 0.00002, 0.00005, 0.0001, 0.0002, 0.0005, 0.001, 0.002};
    for (const FrameSequence& source : studySources(context.settings, {"torus", "plane"}, 2)) {
        for (double radius : radii) {
            addRadius(context, study, source, radius, budgets,
                      radius == radii[radii.size() - (quick ? 1 : 2)]);
        }
    }
    markFront(study);
    study.panels = {frontPanel(study, "build: upload until the set is published"), queryPanel(study)};
    for (PlotPanel& panel : study.panels) {
        panel.yLabel = "largest boundary error [mm]";
    }
    return study;
}

} // namespace fathom::profile
