// SPDX-License-Identifier: Apache-2.0
// Depth error against time for the filter's window, sigma, weights, tiles and skipped patches. On analytic
// scenes, the error is against exact depth; on recordings, it is the scatter between frames.
#include "apps/profile/frame_sequence.h"
#include "apps/profile/interleave.h"
#include "apps/profile/studies.h"

#include <algorithm>

namespace fathom::profile {

namespace {

constexpr double kEdgeJump = 0.02; // relative jump of the exact depth that counts as an edge
constexpr int kEdgeReach = 3;      // [pixels] distance from the jump that still counts as edge

enum class Window { Direct, Tiles, Blocks }; // how the shader reads a window

struct Setting {
    uint32_t radius;
    double sigma;
    Window window;
    bool everyPatch;
    bool polynomial = false; // polynomial weights
};

Window windowOf(const Plan& plan) {
    return plan.filterBlock ? Window::Blocks : plan.tiled ? Window::Tiles : Window::Direct;
}

std::string nameOf(const Setting& s, Window usual) {
    const char* windows[] = {" direct", " tiles", " blocks"};
    std::string name = std::to_string(2 * s.radius + 1) + "x" + std::to_string(2 * s.radius + 1);
    name = s.radius == 0 ? "none" : name + " s" + digits(s.sigma * 1e3) + "mm";
    name += s.window == usual || s.radius == 0 ? "" : windows[static_cast<size_t>(s.window)];
    return name + (s.polynomial ? " polynomial" : "") + (s.everyPatch ? " all patches" : "");
}

std::vector<Setting> settingsOf(const Scene& scene, bool quick, Window usual) {
    std::vector<Setting> list;
    const double sigma = scene.filter.sigma;
    for (uint32_t radius : quick ? std::vector<uint32_t>{0, 2} : std::vector<uint32_t>{0, 1, 2, 3, 5, 8}) {
        list.push_back({radius, sigma, usual, false});
    }
    for (double s : quick ? std::vector<double>{0.003} : std::vector<double>{0.003, 0.005, 0.02, 0.05}) {
        for (uint32_t radius : quick ? std::vector<uint32_t>{2} : std::vector<uint32_t>{2, 5}) {
            list.push_back({radius, s, usual, false});
        }
    }
    for (Window window : {Window::Direct, Window::Tiles, Window::Blocks}) {
        if (window != usual) {
            list.push_back({2, sigma, window, false});
        }
    }
    list.push_back({2, sigma, usual, true});
    for (uint32_t radius : quick ? std::vector<uint32_t>{2} : std::vector<uint32_t>{1, 2, 5}) {
        list.push_back({radius, sigma, usual, false, true});
    }
    for (double s : quick ? std::vector<double>{} : std::vector<double>{0.003, 0.005}) {
        list.push_back({2, s, usual, false, true});
    }
    const auto same = [&](const Setting& s) { return s.radius == scene.filter.radius && s.sigma == sigma; };
    if (std::none_of(list.begin(), list.end(), same)) {
        list.push_back({scene.filter.radius, sigma, usual, false});
    }
    return list;
}

// Marks pixels near a jump of the exact depth.
std::vector<uint8_t> edgesOf(const FrameSequence& source) {
    const int w = static_cast<int>(source.camera.depth.width),
              h = static_cast<int>(source.camera.depth.height);
    const std::vector<double>& truth = source.frames.front().truth;
    std::vector<uint8_t> edges(truth.size(), 0);
    const auto at = [&](int u, int v) { return truth[static_cast<size_t>(v) * w + u]; };
    for (int v = 0; v < h; ++v) {
        for (int u = 0; u + 1 < w; ++u) {
            for (const auto& [nu, nv] : {std::pair{u + 1, v}, std::pair{u, std::min(v + 1, h - 1)}}) {
                if (std::abs(at(u, v) - at(nu, nv)) <= kEdgeJump * at(u, v)) {
                    continue;
                }
                for (int y = std::max(0, v - kEdgeReach); y <= std::min(h - 1, v + kEdgeReach); ++y) {
                    for (int x = std::max(0, u - kEdgeReach); x <= std::min(w - 1, u + kEdgeReach); ++x) {
                        edges[static_cast<size_t>(y) * w + x] = 1;
                    }
                }
            }
        }
    }
    return edges;
}

// Errors of the filtered depths [mm].
struct DepthErrors {
    double squares = 0.0;
    size_t count = 0;
    std::vector<double> edge;

    void add(const FrameSequence& source, const reference::PointImage& points,
             std::span<const uint32_t> masks, const std::vector<uint8_t>& edges) {
        for (size_t i = 0; i < points.z.size(); ++i) {
            const double truth = source.frames.front().truth[i];
            if (points.z[i] == 0.0 || masks[i] == 0 || truth == 0.0) {
                continue;
            }
            const double e = (points.z[i] - truth) * 1e3;
            if (edges[i] != 0) {
                edge.push_back(std::abs(e));
            } else {
                squares += e * e;
                ++count;
            }
        }
    }
    double rms() const { return count > 0 ? std::sqrt(squares / static_cast<double>(count)) : NAN; }
    double edgeP90() { return edge.empty() ? NAN : spreadOf(edge).p90; }
};

// Typical change of a pixel between consecutive frames over sqrt(2) [mm]: the noise of one frame in a static
// scene. Uses the median (x 1.4826), so moving pixels hardly count.
double scatterOf(const std::vector<reference::PointImage>& frames) {
    std::vector<double> changes;
    for (size_t f = 1; f < frames.size(); ++f) {
        for (size_t i = 0; i < frames[f].z.size(); ++i) {
            if (frames[f].z[i] != 0.0 && frames[f - 1].z[i] != 0.0) {
                changes.push_back(std::abs(frames[f].z[i] - frames[f - 1].z[i]) * 1e3);
            }
        }
    }
    return changes.empty() ? NAN : spreadOf(std::move(changes)).p50 * 1.4826 / std::sqrt(2.0);
}

Scene sceneFor(const Settings& settings, const Setting& s) {
    Scene scene = studyScene(settings);
    scene.filter.radius = s.radius;
    scene.filter.sigma = s.sigma;
    scene.filter.weights = s.polynomial ? Scene::Filter::Weights::Polynomial : Scene::Filter::Weights::Exact;
    if (s.everyPatch) { // a class of all points lists every patch
        FixtureClass all;
        all.name = "all";
        all.role = Role::Guidance;
        scene.fixtures.push_back(all);
    }
    return scene;
}

std::unique_ptr<FrameBench> benchOf(const StudyContext& context, const FrameSequence& source,
                                    const Setting& s) {
    return std::make_unique<FrameBench>(context.device, sceneFor(context.settings, s), source.camera,
                                        [&](Plan& plan) {
                                            plan.tiled = s.window == Window::Tiles;
                                            plan.filterBlock = s.window == Window::Blocks;
                                        });
}

// Everything in a row except the times.
StudyRow errorRow(const StudyContext& context, const FrameSequence& source, const std::string& setting,
                  FrameBench& bench) {
    StudyRow row;
    row.source = source.name;
    row.setting = setting;
    const bool exact = !source.frames.front().truth.empty();
    const std::vector<uint8_t> edges = exact ? edgesOf(source) : std::vector<uint8_t>{};
    const uint32_t own =
        (1u << studyScene(context.settings).fixtures.size()) - 1; // without everyPatch's extra class
    DepthErrors errors;
    std::vector<reference::PointImage> frames;
    for (const SampleFrame& image : source.frames) {
        bench.run(image);
        if (&image == &source.frames.front()) {
            const std::string wrong = bench.differsFromTwins(image);
            verify(wrong.empty(), "filter", row.setting, wrong + " differs from the float64 twin");
        }
        frames.push_back(bench.points());
        if (exact) {
            std::vector<uint32_t> masks = bench.masks();
            std::for_each(masks.begin(), masks.end(), [&](uint32_t& m) { m &= own; });
            errors.add(source, frames.back(), masks, edges);
        }
    }
    row.error = exact ? errors.rms() : scatterOf(frames);
    row.more = {errors.edgeP90()};
    return row;
}

// Measures all settings of one source, interleaved.
void addSource(const StudyContext& context, Study& study, const FrameSequence& source) {
    const Scene scene = studyScene(context.settings);
    const Window usual = windowOf(makePlan(scene, source.camera, 1, context.device.facts()));
    std::vector<std::unique_ptr<FrameBench>> benches;
    std::vector<StudyRow> rows;
    for (const Setting& s : settingsOf(scene, context.settings.quick, usual)) {
        benches.push_back(benchOf(context, source, s));
        rows.push_back(errorRow(context, source, nameOf(s, usual), *benches.back()));
        rows.back().isDefault = s.radius == scene.filter.radius && s.sigma == scene.filter.sigma &&
                                s.window == usual && !s.everyPatch &&
                                s.polynomial == (scene.filter.weights == Scene::Filter::Weights::Polynomial);
    }
    const std::vector<FrameCost> costs =
        measureInterleaved(benches, source.frames, context.settings.repeats());
    for (size_t i = 0; i < rows.size(); ++i) {
        const auto surface = costs[i].passes.find("surface");
        rows[i].cost = costs[i].frame;
        rows[i].cost.gpu = surface != costs[i].passes.end() ? surface->second : Spread{};
        rows[i].more.insert(rows[i].more.end(), {costs[i].frame.gpu.p50, costs[i].total.p50});
        study.rows.push_back(std::move(rows[i]));
    }
}

} // namespace

Study filterStudy(const StudyContext& context) {
    Study study;
    study.name = "filter";
    study.labels = "11x11 s10mm: filter.radius 5, filter.sigma 10 mm";
    study.title = "Filter: depth error against time of the surface pass";
    study.verified = "class bits and points of a frame against the float64 twins, 20 um";
    const bool recorded = !context.settings.source.empty();
    study.errorName = recorded ? "scatter between repeats" : "depth error RMS away from edges";
    study.errorUnit = "mm";
    study.rankBy.time = gpuTime;
    study.timeName = "surface pass, GPU time p50";
    study.moreNames = {"edge_error_p90_mm", "all_passes_p50_ms", "upload_to_published_p50_ms"};
    study.rankBy.reason = "no setting is best on every scene: narrow windows and sigmas suit thin objects, "
                          "wide ones suit large surfaces (compare the scenes, and edge_error_p90_mm); rows "
                          "of one window and sigma differ only as their names say";
    const uint32_t frames = context.settings.quick ? 2 : 6;
    for (const FrameSequence& source : studySources(context.settings, {"torus", "corner", "tank"}, frames)) {
        addSource(context, study, source);
    }
    markFront(study);
    study.panels.push_back(frontPanel(study, study.errorName));
    if (!recorded) {
        PlotPanel edges = frontPanel(study, "error within 3 pixels of an edge", {},
                                     [](const StudyRow& row) { return row.more[0]; });
        edges.yLabel = "90th percentile of |depth error| at edges [mm]";
        study.panels.push_back(std::move(edges));
    }
    return study;
}

} // namespace fathom::profile
