// SPDX-License-Identifier: Apache-2.0
// Depth smoothing and point generation: Fathom's surface pass and its float64 twin compared with OpenCV and
// PCL.
#include "apps/profile/frame_sequence.h"
#include "apps/profile/peers/peers.h"
#include "apps/profile/peers_rows.h"

#include "engine/reference/surface.h"
#include "engine/types/median.h"

#include <algorithm>

namespace fathom::profile {

namespace {

constexpr double kPeerPoint = 2e-5; // [m]
constexpr double kPeerJump = 0.02;  // relative depth jump that counts as an edge
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

// A scene that selects every measured point. Besides the surface pass, only classify and moments run.
Scene everyPoint(uint32_t radius) {
    Scene scene;
    FixtureClass all;
    all.name = "all";
    all.role = Role::Guidance;
    scene.fixtures = {all};
    scene.holdSeconds = 0.0;
    scene.filter.radius = radius;
    return scene;
}

// gpu: device time of the surface pass (of the whole frame if the device has no clock); submit: the frame,
// from submission to result.
Cost passCost(const FrameCost& cost) {
    Cost out = cost.frame;
    const auto surface = cost.passes.find("surface");
    out.gpu = surface != cost.passes.end() ? surface->second : out.gpu;
    return out;
}

// Measured depths [m]; NaN = no measurement.
std::vector<float> measured(const reference::FrameView& view) {
    std::vector<float> z;
    for (int v = 0; v < view.height(); ++v) {
        for (int u = 0; u < view.width(); ++u) {
            const double depth = view.z(u, v);
            z.push_back(depth > 0.0 ? static_cast<float>(depth) : kNone);
        }
    }
    return z;
}

// Marks pixels whose whole window is measured and has no jump. All filters should agree there.
std::vector<uint8_t> flatPixels(const reference::FrameView& view, int radius) {
    std::vector<uint8_t> flat(view.pixels(), 0);
    for (int v = radius; v + radius < view.height(); ++v) {
        for (int u = radius; u + radius < view.width(); ++u) {
            const double z0 = view.z(u, v);
            bool ok = z0 > 0.0;
            for (int k = 0; ok && k < (2 * radius + 1) * (2 * radius + 1); ++k) {
                const double z = view.z(u - radius + k % (2 * radius + 1), v - radius + k / (2 * radius + 1));
                ok = z > 0.0 && std::abs(z - z0) <= kPeerJump * z0;
            }
            flat[view.index(u, v)] = ok ? 1 : 0;
        }
    }
    return flat;
}

// RMS difference [mm] over flat pixels at which both have a depth; NaN if there are none.
template <class A, class B>
double rmsBetween(const std::vector<A>& a, const std::vector<B>& b, const std::vector<uint8_t>& flat) {
    double squares = 0.0, count = 0.0;
    for (size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
        if (flat[i] != 0 && a[i] > 0 && b[i] > 0) { // false for NaN
            const double off = 1e3 * (static_cast<double>(a[i]) - static_cast<double>(b[i]));
            squares += off * off;
            count += 1.0;
        }
    }
    return count > 0.0 ? std::sqrt(squares / count) : NAN;
}

double medianDepth(std::vector<float> z) {
    std::erase_if(z, [](float value) { return std::isnan(value); });
    return z.empty() ? 1.0 : double{medianOf(z)};
}

StudyRow twinRow(const StudyContext& context, const reference::FrameView& view, const std::string& source,
                 std::vector<double>& z) {
    StudyRow row = peerRow(source, "Fathom float64 twin");
    const std::vector<uint32_t> masks(view.pixels(), 1);
    reference::SurfaceImage twin;
    const Repeats few{3, 5, 0.2};
    row.cost = timeCpu(context.settings.quick ? Repeats{1, 1, 0.0} : few,
                       [&] { twin = reference::surface(view, masks); });
    row.more[kThreads] = 1.0;
    z = twin.points.z;
    return row;
}

void addFilter(const StudyContext& context, const FrameSequence& frames, uint32_t radius,
               std::vector<StudyRow>& rows) {
    const std::string window = std::to_string(2 * radius + 1);
    const std::string source = "filter " + frames.name + " " + window + "x" + window;
    const SampleFrame& image = frames.frames.front();
    const Scene scene = everyPoint(radius);
    FrameBench bench(context.device, scene, frames.camera);
    bench.run(image);
    const std::string wrong = bench.differsFromTwins(image);
    verify(wrong.empty(), "peers", source, wrong + " differs from the float64 twin");
    const std::vector<double> ours = bench.points().z;
    const reference::FrameView view(scene, frames.camera, image.baseTcamera, image.depth, image.colour);
    const std::vector<float> raw = measured(view);
    const std::vector<uint8_t> flat = flatPixels(view, static_cast<int>(radius));
    const size_t first = rows.size();
    const auto judge = [&](StudyRow& row, const auto& z) {
        row.more[kFromOurs] = rmsBetween(z, ours, flat);
        row.more[kFromTruth] = rmsBetween(z, image.truth, flat);
        rows.push_back(row);
    };
    StudyRow row = peerRow(source, "Fathom surface pass");
    row.cost = passCost(bench.measure({image}, context.settings.repeats()));
    row.error = 0.0;
    row.isDefault = true;
    row.more[kThreads] = deviceThreads(context.device);
    judge(row, ours);
    std::vector<double> twin;
    row = twinRow(context, view, source, twin);
    judge(row, twin);
    // The same Gaussian as in Fathom, for a surface perpendicular to the view at the median depth.
    const double pixels = scene.filter.sigma * frames.camera.depth.fx / medianDepth(raw);
    for (const auto& method : peers::filterMethods(radius, pixels, scene.filter.sigma)) {
        const auto peer = method.make();
        peer->load({frames.camera.depth, raw});
        row = peerRow(source, method.name);
        row.cost = timeCpu(context.settings.repeats(), [&] { peer->run(); });
        row.more[kThreads] = method.threads;
        judge(row, peer->depths());
    }
    fillRatios(rows, first, first, first);
}

// Counts points that differ from the pixel's ray times its depth, lack a measurement, or are missing.
size_t wrongPoints(const reference::FrameView& view, const std::vector<dvec3>& points,
                   const std::function<bool(size_t)>& present) {
    size_t wrong = 0;
    for (int v = 0; v < view.height(); ++v) {
        for (int u = 0; u < view.width(); ++u) {
            const size_t i = view.index(u, v);
            const double z = view.z(u, v);
            wrong += present(i) != (z > 0.0) ||
                     (z > 0.0 && !(glm::length(points[i] - view.point(u, v, z)) <= kPeerPoint));
        }
    }
    return wrong;
}

} // namespace

double deviceThreads(const gpu::Device& device) {
    return device.facts().kind == DeviceKind::Cpu ? static_cast<double>(device.facts().hostProcessors) : NAN;
}

void addPeerFilters(const StudyContext& context, std::vector<StudyRow>& rows) {
    for (FrameSequence& frames : studySources(context.settings, {"plane", "torus"}, 1)) {
        if (frames.frames.empty()) {
            continue;
        }
        for (const uint32_t radius :
             context.settings.quick ? std::vector<uint32_t>{2} : std::vector<uint32_t>{2, 3, 5, 8}) {
            addFilter(context, frames, radius, rows);
        }
    }
}

void addPeerPoints(const StudyContext& context, std::vector<StudyRow>& rows) {
    FrameSequence frames = context.settings.quick ? wallFrame(320, 240, 1.0) : wallFrame(640, 480, 1.0);
    SampleFrame& image = frames.frames.front();
    for (size_t i = 0; i < image.depth.size(); ++i) { // whole millimetres, with holes
        image.depth[i] = static_cast<uint16_t>(i % 97 == 0 ? 0 : image.depth[i] / 10);
    }
    frames.camera.metresPerUnit = 0.001;
    const std::string source = "points " + frames.name;
    Scene scene = everyPoint(0);
    scene.filter.edge = 0.0;
    scene.filter.isolated = false;
    FrameBench bench(context.device, scene, frames.camera);
    bench.run(image);
    const reference::FrameView view(scene, frames.camera, image.baseTcamera, image.depth, image.colour);
    const reference::PointImage ours = bench.points();
    const size_t first = rows.size();
    StudyRow row = peerRow(source, "Fathom surface pass");
    row.error = static_cast<double>(wrongPoints(view, ours.at, [&](size_t i) { return ours.z[i] > 0.0; }));
    verify(row.error == 0.0, "peers", source, digits(row.error) + " points differ from float64");
    row.cost = passCost(bench.measure({image}, context.settings.repeats()));
    row.more[kThreads] = deviceThreads(context.device);
    row.isDefault = true;
    rows.push_back(row);
    for (const auto& method : peers::pointMethods()) {
        const auto peer = method.make();
        peer->load(frames.camera.depth, image.depth);
        peer->run();
        const std::vector<dvec3> points = peer->points();
        row = peerRow(source, method.name);
        row.error =
            static_cast<double>(wrongPoints(view, points, [&](size_t i) { return points[i].z > 0.0; }));
        row.cost = timeCpu(context.settings.repeats(), [&] { peer->run(); });
        row.more[kThreads] = method.threads;
        rows.push_back(row);
    }
    fillRatios(rows, first, first, first);
}

} // namespace fathom::profile
