// SPDX-License-Identifier: Apache-2.0
#include "apps/stability/feel_guidance.h"

#include "apps/stability/case_text.h"
#include "apps/stability/image_fixtures.h"
#include "apps/stability/loop_rig.h"
#include "devices/simulated/simulated_camera.h"
#include "devices/simulated/simulated_hand.h"
#include "engine/cloud/guidance_estimates.h"
#include "engine/cloud/guidance_pose.h"
#include "engine/reference/classify.h"
#include "engine/reference/surface.h"
#include "engine/types/colour_copy.h"

#include <algorithm>
#include <cmath>

namespace fathom::stability {

namespace {

constexpr double kStandoff = 0.08; // [m]

// One guidance class of an analytic scene, seen by the swaying camera with noise.
class SwayedClass {
public:
    // hue [degree] of the class.
    SwayedClass(const std::string& scene, Band hue)
        : scene_(redScene(0.04))
        , camera_(cameraOf(scene)) {
        FixtureClass& valve = scene_.fixtures.front();
        valve.role = Role::Guidance;
        valve.hue = hue;
        valve.standoff = kStandoff;
    }

    // The next frame. shift [m]: how far the scene has moved.
    GuidancePose look(const dvec3& shift) {
        const std::optional<Frame> next = camera_.next();
        Frame::Content frame = **next;
        frame.baseTcamera->position += shift; // as if the camera stood and the scene had moved
        std::vector<uint32_t> rgba;
        readColours(frame, rgba);
        const reference::FrameView view(scene_, camera_.info(), *frame.baseTcamera, frame.depth, rgba);
        const auto classified = reference::classify(view, nullptr);
        const reference::PointImage points = reference::surface(view, classified.masks).points;
        std::vector<dvec3> seen;
        for (size_t i = 0; i < points.z.size(); ++i) {
            if (points.z[i] != 0.0) {
                seen.push_back(points.at[i]);
            }
        }
        GuidancePose pose = cloud::guidancePose(cloud::momentsOf(seen), scene_.fixtures.front(), 0,
                                                frame.baseTcamera->position);
        raw_ = pose.target.position;
        estimates_.apply({&pose, 1}, scene_, frame.baseTcamera->position, frame.captureTime);
        return pose;
    }
    const dvec3& raw() const { return raw_; } // [m] target of the last frame alone

private:
    static SimulatedCamera cameraOf(const std::string& scene) {
        SimulatedCameraOptions options;
        options.width = 320;
        options.height = 240;
        options.frames = 100000;
        options.threads = 1;
        return SimulatedCamera(analyticScene(scene).value(), options);
    }

    Scene scene_;
    SimulatedCamera camera_;
    cloud::GuidanceEstimates estimates_;
    dvec3 raw_{0.0};
};

dvec3 meanOf(const std::vector<dvec3>& points) {
    dvec3 mean(0.0);
    for (const dvec3& p : points) {
        mean += p / static_cast<double>(points.size());
    }
    return mean;
}

// RMS distance from the mean.
double spread(const std::vector<dvec3>& points) {
    const dvec3 mean = meanOf(points);
    double sum = 0.0;
    for (const dvec3& p : points) {
        sum += glm::dot(p - mean, p - mean) / static_cast<double>(points.size());
    }
    return std::sqrt(sum);
}

// Switched on after 0.3 s, as a pilot would; a hand at the target feels its motion times the stiffness.
Outcome swayCase(RunLength runLength, const char* scene, Band hue, const char* what) {
    SwayedClass valve(scene, hue);
    Guidance guidance;
    std::vector<dvec3> targets, raw;
    const int frames = some(runLength, 390, 150);
    for (int frame = 0; frame < frames; ++frame) {
        const GuidancePose pose = valve.look(dvec3(0.0));
        for (int tick = 0; tick < 33; ++tick) {
            guidance.step({&pose, 1}, pose.target, frame > 9, false, 0.001);
        }
        if (frame > 30) {
            targets.push_back(guidance.target().position);
            raw.push_back(valve.raw());
        }
    }
    Outcome out = outcomeOf(spread(targets), 1e-4, "m",
                            std::string("RMS motion of the target at ") + what +
                                " under a camera that sways by 20 mm and 1.5 degrees, with noise. The "
                                "target of each frame alone moves by " +
                                num(spread(raw)) + " m.");
    const double off = glm::distance(meanOf(targets), meanOf(raw));
    require(out, guidance.hasTarget(), "there is no target");
    require(out, off <= 0.006, "it is " + num(off) + " m from what is seen");
    return out;
}

// What really moves must be followed.
Outcome followCase(RunLength runLength) {
    constexpr double kSpeed = 0.03, kWay = 0.06; // [m/s], [m]
    SwayedClass valve("torus", {345.0, 20.0});
    Guidance guidance;
    double farthest = 0.0, end = 0.0;
    dvec3 start(0.0);
    const int frames = some(runLength, 240, 120);
    for (int frame = 0; frame < frames; ++frame) {
        const double moved = std::clamp(kSpeed * (frame - 30) / SimulatedCamera::kFrameRate, 0.0, kWay);
        const GuidancePose pose = valve.look({moved, 0.0, 0.0});
        for (int tick = 0; tick < 33; ++tick) {
            guidance.step({&pose, 1}, pose.target, true, false, 0.001);
        }
        start = frame == 30 ? guidance.target().position : start;
        end = frame < 30 ? 0.0 : glm::distance(guidance.target().position, start + dvec3(moved, 0.0, 0.0));
        farthest = std::max(farthest, end);
    }
    Outcome out = outcomeOf(farthest, 0.01, "m",
                            "Lag of the target while a valve moves 60 mm at 30 mm/s before a swaying camera: "
                            "the gate of 2 mm and about four frames.");
    require(out, end <= 0.003, "it ends " + num(end) + " m away");
    return out;
}

// [m] places of a tool that guidance pulls over 0.3 m, tick by tick. The hand has no spring.
std::vector<double> pulledWay(bool paper, double speed, double mass, int ticks) {
    LoopSpec spec;
    const Tool tool(buildSphereTree(spec.leaves));
    HapticOptions options = loopOptions(spec, tool);
    options.paperGuidance = paper;
    options.guidance.speed = speed;
    HapticCycle cycle(tool, std::span<const Shape>{}, options, {});
    SimulatedHandOptions loop;
    loop.loop = {mass, 0.5, 0.0};
    SimulatedHand hand(HandPath({{0.0, {}, 0}}), loop);
    GuidancePose target;
    target.present = target.planar = true;
    target.target.position = {0.0, 0.0, 0.3};
    std::vector<double> way;
    for (int k = 0; k < ticks; ++k) {
        const double t = 0.001 * k;
        StepInput input = stepInput({hand.read(t).deviceThandle, kGuidanceButton}, t);
        input.guidance = {&target, 1};
        const StepRecord record = cycle.step(input);
        hand.write(record.deviceWrench, 0.001);
        way.push_back(record.tool.position.z);
    }
    return way;
}

// A hand that gives way is pulled no faster than the pilot asked, in both modes, whatever its mass.
Outcome speedCase(RunLength runLength) {
    double worst = 0.0, farthest = 0.0;
    for (const bool paper : {false, true}) {
        for (const double speed : {0.02, 0.1}) {
            for (const double mass : {0.1, 1.0}) {
                const auto way = pulledWay(paper, speed, mass, some(runLength, 6000, 2500));
                for (size_t k = 20; k < way.size(); ++k) {
                    worst = std::max(worst, (way[k] - way[k - 20]) / 0.02 / speed);
                }
                farthest = std::max(farthest, way.back());
            }
        }
    }
    Outcome out = outcomeOf(worst, 1.1, "1",
                            "Fastest tool within 20 ms that guidance pulls with up to 2 N over 0.3 m, over "
                            "the speed that the pilot asked for: 20 and 100 mm/s, hands of 0.1 and 1 kg "
                            "without a spring, both modes.");
    require(out, farthest >= 0.15, "no hand came near the target: " + num(farthest) + " m");
    return out;
}

} // namespace

void addFeelGuidance(std::vector<Case>& cases) {
    const auto put = [&](const std::string& name, std::function<Outcome(RunLength)> run) {
        cases.push_back({"feel-guidance-" + name, Group::Feel, std::move(run)});
    };
    put("under-sway", [](RunLength e) { return swayCase(e, "tank", {40.0, 70.0}, "a valve of the tank"); });
    put("under-sway-plane", [](RunLength e) { return swayCase(e, "torus", {345.0, 20.0}, "a flat ring"); });
    put("follows", followCase);
    put("speed", speedCase);
}

} // namespace fathom::stability
