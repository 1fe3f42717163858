// SPDX-License-Identifier: Apache-2.0
// Group precision: every float32 pass of a frame against its float64 twin, over ranges, noise levels, filter
// widths and tiny weights.

#include "apps/stability/case_text.h"
#include "apps/stability/pass_errors.h"

#include <cmath>

namespace fathom::stability {

namespace {

constexpr double kShare = 1e-6; // fraction of the range: 1 um at 1 m; float32 rounds to 6e-8

std::vector<double> rangesFor(RunLength runLength) {
    return runLength == RunLength::Full ? std::vector<double>{0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0}
                                        : std::vector<double>{0.1, 1.0, 100.0};
}

using Measure = std::function<PassError(const PrecisionRig&, double range)>;
using Change = std::function<void(Scene&, CameraInfo&, double range)>;

struct Sweep {
    PassError all;
    Outcome::Curve curve{"largest error", "range [m]", "error / range", {}, {}, true, true};
};

// One frame per range and noise level. `change` edits scene and camera before anything is built.
Sweep overRanges(const DeviceSource& device, RunLength runLength, const std::vector<double>& noises,
                 const Measure& measure, const Change& change = {}) {
    Sweep sweep;
    for (const double range : rangesFor(runLength)) {
        CameraInfo camera = cameraFor(range);
        Scene scene = sceneFor(range);
        if (change) {
            change(scene, camera, range);
        }
        PrecisionRig rig(device(), scene, camera);
        PassError here;
        for (const double noise : noises) {
            rig.run(imageFor(camera, range, noise, static_cast<uint64_t>(1e4 * noise) + 5));
            here.add(measure(rig, range));
        }
        sweep.curve.x.push_back(range);
        sweep.curve.y.push_back(here.error);
        sweep.all.add(here);
    }
    return sweep;
}

Outcome errorOutcome(const Sweep& sweep, double limit, const std::string& unit, const std::string& what) {
    const PassError& e = sweep.all;
    Outcome out = outcomeOf(e.error, limit, unit,
                            what + " " + num(e.values) + " values compared, " + num(e.unsure) +
                                " decisions on a threshold, " + num(e.wrong) + " wrong ones.");
    require(out, e.wrong == 0 && e.values > 0,
            "decisions differ from the twin's, or there was nothing to compare");
    out.curves.push_back(sweep.curve);
    return out;
}

Outcome rangeOutcome(const Sweep& sweep, double limit, const std::string& unit, const std::string& what) {
    return errorOutcome(sweep, limit, unit, what + " Range 0.1 to 100 m;");
}

const std::vector<double> kNoises{0.0, 0.0005, 0.005};

Outcome classify(const DeviceSource& device, RunLength runLength) {
    const Sweep sweep = overRanges(device, runLength, kNoises,
                                   [](const PrecisionRig& rig, double) { return classifyError(rig); });
    Outcome out = rangeOutcome(sweep, 0.0, "1",
                               "Classify, colour gates and boxes, noise off and on: class bits that differ "
                               "although the twin's decision is not on a threshold.");
    out.figure = out.figure == out.figure ? static_cast<double>(sweep.all.wrong) : out.figure;
    out.curves.clear();
    return out;
}

Outcome surfaceClean(const DeviceSource& device, RunLength runLength) {
    return rangeOutcome(overRanges(device, runLength, {0.0}, surfaceError), kShare, "1",
                        "Surface (filter of 5 x 5), no noise: largest error of a point over the range.");
}

Outcome surfaceNoisy(const DeviceSource& device, RunLength runLength) {
    return rangeOutcome(overRanges(device, runLength, {0.0005, 0.005, 0.02}, surfaceError), kShare, "1",
                        "Surface (filter of 5 x 5), noise of 0.05, 0.5 and 2 % of the depth and 4 % holes: "
                        "largest error of a point over the range.");
}

Outcome occlusion(const DeviceSource& device, RunLength runLength) {
    const Change apart = [](Scene&, CameraInfo& camera, double range) {
        camera.registered = false;
        camera.colour.width = 120;
        camera.colour.height = 90;
        camera.colour.fx = camera.colour.fy = 130.0;
        camera.colour.cx = 60.3;
        camera.colour.cy = 44.1;
        camera.colourTdepth = {{0.05 * range, 0.002 * range, 0.001 * range},
                               rotationExp({0.002, 0.004, -0.003})};
    };
    return rangeOutcome(overRanges(device, runLength, kNoises, occlusionError, apart), kShare, "1",
                        "Occlusion, a colour camera next to the depth camera: nearest depth per cell against "
                        "the twin's bounds, over the range.");
}

Outcome thin(const DeviceSource& device, RunLength runLength) {
    return rangeOutcome(overRanges(device, runLength, {0.0, 0.0002}, thinError), kShare, "1",
                        "Thin: growth of the kept spheres, apart from one step outward, over the range.");
}

Outcome spheres(const DeviceSource& device, RunLength runLength) {
    return rangeOutcome(overRanges(device, runLength, kNoises, sphereError), kShare, "1",
                        "Spheres: centre and radius over the range.");
}

Outcome tree(const DeviceSource& device, RunLength runLength) {
    return rangeOutcome(
        overRanges(device, runLength, kNoises, treeError), kShare, "1",
        "Tree: centre and radius of every node over the range; no child outside its parent in float64. Radii "
        "are rounded outward by 1e-6 of themselves and 0.1 um, and so are the twin's.");
}

// Six frames, each with different noise and holes.
Outcome hold(const DeviceSource& device, RunLength runLength) {
    Sweep sweep;
    for (const double range : rangesFor(runLength)) {
        Scene scene = sceneFor(range);
        scene.holdSeconds = 0.12;
        PrecisionRig rig(device(), scene, cameraFor(range));
        reference::HoldMemory twin;
        PassError here;
        for (int frame = 0; frame < 6; ++frame) {
            rig.run(imageFor(rig.camera(), range, 0.002, static_cast<uint64_t>(frame) + 40), frame / 30.0);
            here.add(holdError(rig, twin, frame / 30.0, std::max(0, frame - 1) / 30.0, range));
        }
        sweep.curve.x.push_back(range);
        sweep.curve.y.push_back(here.error);
        sweep.all.add(here);
    }
    return errorOutcome(
        sweep, kShare, "1",
        "Hold, six frames with noise and changing holes: centre and radius of held points over the range.");
}

Outcome moments(const DeviceSource& device, RunLength runLength) {
    return rangeOutcome(overRanges(device, runLength, kNoises, momentsError), kShare, "1",
                        "Moments: mean of the guidance class over the range.");
}

Outcome guidance(const DeviceSource& device, RunLength runLength) {
    return rangeOutcome(
        overRanges(
            device, runLength, kNoises, [](const PrecisionRig& rig, double) { return guidanceError(rig); },
            [](Scene& scene, CameraInfo&, double range) {
                // Select the flat part left of the step.
                const dvec3 centre = scene.baseTcamera.apply({-0.25 * range, 0.0, range});
                scene.fixtures[1].box = Box{centre - dvec3(0.12 * range), centre + dvec3(0.12 * range)};
            }),
        1e-5, "rad",
        "Guidance: the normal of a planar class, against a twin with another eigenvalue solver.");
}

// Filter widths at 1 m, from far below the pixel spacing to far wider than the image.
Outcome filterWidths(const DeviceSource& device, RunLength runLength) {
    Sweep sweep;
    sweep.curve.xLabel = "sigma [m]";
    const std::vector<double> sigmas =
        runLength == RunLength::Full ? std::vector<double>{1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 0.1, 0.3, 1.0}
                                     : std::vector<double>{1e-4, 1e-2, 1.0};
    for (const double sigma : sigmas) {
        PassError here;
        for (const uint32_t radius : runLength == RunLength::Full ? std::vector<uint32_t>{1, 2, 5, 16}
                                                                  : std::vector<uint32_t>{2, 16}) {
            Scene scene = sceneFor(1.0);
            scene.filter.sigma = sigma;
            scene.filter.radius = radius;
            PrecisionRig rig(device(), scene, cameraFor(1.0));
            for (const double noise : {0.0, 0.005}) {
                rig.run(imageFor(rig.camera(), 1.0, noise, 3));
                here.add(surfaceError(rig, 1.0));
            }
        }
        sweep.curve.x.push_back(sigma);
        sweep.curve.y.push_back(here.error);
        sweep.all.add(here);
    }
    return errorOutcome(sweep, kShare, "m",
                        "Surface at 1 m, sigma of the filter from 1e-4 to 1 m, windows of 3 x 3 to 33 x 33, "
                        "noise off and on.");
}

// Neighbour weights exp(-d^2 / (2 sigma^2)) between 1e-36 and 1e-46, where float32 becomes denormal and then
// zero.
Outcome tinyWeights(const DeviceSource& device, RunLength runLength) {
    Sweep sweep;
    sweep.curve.xLabel = "weight of a neighbour";
    const double spacing = 1.0 / (1.1 * 96.0); // [m] between neighbours at 1 m
    for (const double exponent :
         runLength == RunLength::Full
             ? std::vector<double>{80.0, 85.0, 87.0, 87.5, 90.0, 95.0, 100.0, 103.0, 104.0, 110.0}
             : std::vector<double>{87.0, 95.0, 104.0}) {
        Scene scene = sceneFor(1.0);
        scene.filter.sigma = spacing / std::sqrt(2.0 * exponent);
        PrecisionRig rig(device(), scene, cameraFor(1.0));
        PassError here;
        for (const double noise : {0.0, 0.0005}) {
            rig.run(imageFor(rig.camera(), 1.0, noise, 4));
            here.add(surfaceError(rig, 1.0));
        }
        sweep.curve.x.push_back(std::exp(-exponent));
        sweep.curve.y.push_back(here.error);
        sweep.all.add(here);
    }
    return errorOutcome(
        sweep, kShare, "m",
        "Surface at 1 m with weights of the neighbours from 2e-35 through the denormal numbers to zero.");
}

} // namespace

std::vector<Case> precisionCases(const DeviceSource& device) {
    const auto on = [&](const char* name, Outcome (*run)(const DeviceSource&, RunLength)) {
        return Case{name, Group::Precision,
                    [device, run](RunLength runLength) { return run(device, runLength); }};
    };
    return {on("precision-occlusion", occlusion),
            on("precision-classify", classify),
            on("precision-surface-without-noise", surfaceClean),
            on("precision-surface-with-noise", surfaceNoisy),
            on("precision-filter-widths", filterWidths),
            on("precision-denormal-weights", tinyWeights),
            on("precision-thin", thin),
            on("precision-spheres", spheres),
            on("precision-hold", hold),
            on("precision-tree", tree),
            on("precision-moments", moments),
            on("precision-guidance", guidance)};
}

} // namespace fathom::stability
