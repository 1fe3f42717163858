// SPDX-License-Identifier: Apache-2.0
// What a hand feels against the time from camera to force: error of the felt surface and ripple of the force,
// for filter, memory, friction, error budget, smooth planes and frame rate.
#include "apps/profile/felt_surface.h"
#include "apps/profile/frame_sequence.h"
#include "apps/profile/interleave.h"
#include "apps/profile/studies.h"
#include "apps/verify/pressed_gripper.h"

namespace fathom::profile {

namespace {

constexpr double kUsualRate = 30.0; // [Hz]

struct FeelSetting {
    std::string name;
    std::function<void(Scene&)> change;
    double rateHz = kUsualRate;
    bool isDefault = false;
    bool quick = false; // part of a quick run
};

std::function<void(Scene&)> filter(uint32_t radius, double sigma) {
    return [=](Scene& scene) {
        scene.filter.radius = radius;
        scene.filter.sigma = sigma;
    };
}

// One line per setting; each changes one thing of the default, and the last ones combine them.
std::vector<FeelSetting> feelSettings() {
    const auto plain = [](Scene&) {};
    std::vector<FeelSetting> list{{"default", plain, kUsualRate, true, true}};
    list.push_back({"no filter", filter(0, 0.01), kUsualRate, false, true});
    for (const uint32_t radius : {1u, 2u, 3u, 5u}) {
        for (const double sigma : {0.003, 0.005, 0.01, 0.02}) {
            const Scene usual;
            if (radius != usual.filter.radius || sigma != usual.filter.sigma) {
                const std::string size = std::to_string(2 * radius + 1);
                list.push_back({size + "x" + size + " s" + digits(1e3 * sigma) + "mm", filter(radius, sigma),
                                kUsualRate, false, radius == 2 && sigma == 0.005});
            }
        }
    }
    for (const double mu : {0.05, 0.1, 0.2, 0.4}) {
        list.push_back({"friction " + digits(mu), [=](Scene& scene) { scene.haptics.friction = mu; },
                        kUsualRate, false, mu == 0.1});
    }
    for (const double budget : {0.0, 0.0003, 0.001}) {
        list.push_back({"budget " + digits(1e3 * budget) + "mm",
                        [=](Scene& scene) { scene.errorBudget = budget; }, kUsualRate, false,
                        budget == 0.001});
    }
    list.push_back({"no smooth planes", [](Scene& scene) { scene.haptics.smooth = false; }});
    for (const uint32_t frames : {8u, 30u}) {
        list.push_back({"memory " + std::to_string(frames),
                        [=](Scene& scene) { scene.filter.memory = frames; }, kUsualRate, false,
                        frames == 30});
    }
    for (const double rate : {15.0, 60.0, 90.0}) {
        list.push_back({digits(rate) + " Hz", plain, rate, false, rate == 60.0});
    }
    return list;
}

// Everything in a row except the frame's times.
StudyRow feltRow(const StudyContext& context, const FrameSequence& source, const FeltPlaces& places,
                 const FeelSetting& setting, FrameBench& bench) {
    std::vector<HostFixtures> frames;
    for (const SampleFrame& image : source.frames) {
        bench.run(image);
        if (frames.empty()) {
            const std::string wrong = bench.differsFromTwins(image, 64);
            verify(wrong.empty(), "feel", setting.name, wrong + " differs from the float64 twin");
        }
        frames.push_back(bench.set().host);
    }
    const FeltSurface felt =
        places.feel(bench.scene(), frames, setting.rateHz, context.settings.quick ? 0.4 : 1.6);
    StudyRow row;
    row.source = source.name;
    row.setting = setting.name;
    row.isDefault = setting.isDefault;
    row.error = 1e3 * felt.error;
    row.more = {felt.ripple, felt.band, 1e3 * felt.bias, felt.query.submit.p50, felt.tick.submit.p50};
    return row;
}

void addFeltSource(const StudyContext& context, Study& study, const FrameSequence& source,
                   const FrameSequence& exact) {
    const Tool tool(buildSphereTree(gripperLeaves()));
    const HostFixtures truth =
        regionsOf(context.device, studyScene(context.settings), exact.camera, exact.frames.front());
    refuseEmpty(context.settings, exact, truth.spheres);
    const FeltPlaces places(tool, truth);
    std::vector<std::unique_ptr<FrameBench>> benches;
    std::vector<StudyRow> rows;
    std::vector<double> rates;
    for (const FeelSetting& setting : feelSettings()) {
        if (context.settings.quick && !setting.quick) {
            continue;
        }
        Scene scene = studyScene(context.settings);
        setting.change(scene);
        benches.push_back(std::make_unique<FrameBench>(context.device, scene, source.camera));
        rows.push_back(feltRow(context, source, places, setting, *benches.back()));
        rates.push_back(setting.rateHz);
    }
    const std::vector<FrameCost> costs =
        measureInterleaved(benches, source.frames, context.settings.repeats());
    for (size_t i = 0; i < rows.size(); ++i) {
        const double published = costs[i].total.p50, force = published + rows[i].more[3] + rows[i].more[4];
        rows[i].cost = costs[i].frame;
        rows[i].more.insert(rows[i].more.end(), {published, force, force + 500.0 / rates[i]});
        study.rows.push_back(std::move(rows[i]));
    }
}

double cameraToForce(const StudyRow& row) {
    return row.more[6];
}
double meanAge(const StudyRow& row) {
    return row.more[7];
}

void addPanels(Study& study) {
    const auto ripple = [](const StudyRow& row) { return row.more[0]; };
    const auto band = [](const StudyRow& row) { return row.more[1]; };
    study.panels.push_back(frontPanel(study, "where the surface is felt"));
    PlotPanel whole = frontPanel(study, "ripple of the force at a still hand", {}, ripple);
    whole.yLabel = "RMS of the force at 1000 N/m [N]";
    study.panels.push_back(std::move(whole));
    PlotPanel felt = frontPanel(study, "ripple that is felt as vibration", {}, band);
    felt.yLabel = "force in 10 to 35 Hz at 1000 N/m [N]";
    study.panels.push_back(std::move(felt));
    PlotPanel age = frontPanel(study, "the same, against the age of the frame that is felt", meanAge, band);
    age.xLabel = "camera to force and half a frame [ms]";
    age.yLabel = "force in 10 to 35 Hz at 1000 N/m [N]";
    study.panels.push_back(std::move(age));
}

} // namespace

Study feelStudy(const StudyContext& context) {
    Study study;
    study.name = "feel";
    study.title = "Feel: error of the felt surface and ripple of the force against time from camera to force";
    study.labels =
        "11x11 s10mm: filter.radius 5, filter.sigma 10 mm; budget: error_budget; memory: filter.memory";
    study.verified = "class bits and points of a frame of every setting against the float64 twins, 20 um";
    study.errorName = "distance of the felt surface from the true one, RMS";
    study.errorUnit = "mm";
    study.rankBy.time = cameraToForce;
    study.rankBy.reason = "the noise of other cameras differs (compare ripple_N and the scenes)";
    study.timeName = "camera to force p50 (published frame, contact query, haptic step)";
    study.moreNames = {"ripple_N", "ripple_10_35_Hz_N",          "bias_mm",     "query_ms",
                       "step_ms",  "upload_to_published_p50_ms", "to_force_ms", "to_force_and_half_frame_ms"};
    const bool quick = context.settings.quick;
    const uint32_t width = quick ? 320 : 640, height = quick ? 240 : 480;
    for (const char* scene : {"torus", "sphere"}) {
        if (!quick || scene == std::string("torus")) {
            addFeltSource(context, study, analyticFrames(scene, width, height, quick ? 6 : 24),
                          exactFrame(scene, width, height));
        }
    }
    markFront(study);
    addPanels(study);
    return study;
}

} // namespace fathom::profile
