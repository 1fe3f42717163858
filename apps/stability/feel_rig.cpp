// SPDX-License-Identifier: Apache-2.0
#include "apps/stability/feel_rig.h"

#include "apps/stability/worlds.h"
#include "apps/verify/pressed_gripper.h"
#include "engine/reference/contact_oracle.h"

#include <cmath>

namespace fathom::stability {

namespace {

constexpr uint32_t kWide = 160, kHigh = 120; // [pixels]
constexpr uint32_t kMaxFrames = 1000000;
constexpr double kFrameRate = 30.0; // [Hz]
constexpr double kWall = 0.6;       // [m] scene "wall"

bool isWall(const FeelSpec& spec) {
    return spec.scene == "wall";
}

Scene feltScene(const FeelSpec& spec) {
    Scene scene = redScene(FeelRig::kRegion);
    scene.errorBudget = spec.errorBudget;
    scene.haptics = spec.haptics;
    return scene;
}

} // namespace

FeelRig::FeelRig(const FeelSpec& spec)
    : spec_(spec)
    , scene_(feltScene(spec))
    , tool_(toolOf(spec.ball ? std::vector<Sphere>{{dvec3(0.0), 0.01}} : gripperLeaves()))
    , options_(makeHapticOptions(scene_, tool_))
    , camera_(cameraOf(spec.noise))
    , make_(scene_, camera_.info(), true) {
    Scene exact = scene_;
    exact.errorBudget = exact.filter.edge = 0.0;
    exact.filter.radius = 0;
    SimulatedCamera seen = cameraOf(false);
    ImageFixtures make(exact, seen.info(), false);
    truth_ = isWall(spec_) ? wallFrame(make, false) : make.make(*seen.next().value());
}

SimulatedCamera FeelRig::cameraOf(bool noise) const {
    SimulatedCameraOptions options;
    options.width = kWide;
    options.height = kHigh;
    options.focal = spec_.focal;
    options.frames = kMaxFrames;
    options.metresPerUnit = 0.0001;
    options.noise = noise;
    options.water = options.motion = false;
    options.threads = 1;
    return SimulatedCamera(analyticScene(isWall(spec_) ? "plane" : spec_.scene).value(), options);
}

// Every pixel at kWall, with the noise of the simulated camera.
HostFixtures FeelRig::wallFrame(ImageFixtures& make, bool noise) {
    const std::vector<uint32_t> red(kWide * kHigh, 0xff2020c0u); // 0xAABBGGRR
    std::vector<uint16_t> depth(kWide * kHigh);
    const double sigma = noise ? SimulatedCamera::kDepthSigmaShare * depthSigma(kWall) : 0.0;
    for (uint16_t& raw : depth) {
        const double seen = kWall + (noise ? sigma * rng_.normal() : 0.0);
        raw = static_cast<uint16_t>(std::lround(seen / camera_.info().metresPerUnit));
    }
    Frame::Content content;
    content.captureTime = static_cast<double>(frames_) / kFrameRate;
    content.depth = depth;
    content.colour = red;
    content.baseTcamera = Pose{};
    return make.make(content);
}

// Optical depth [m] at which the tool touches the exact regions.
double FeelRig::restingPlace(double x, double y, const dquat& rotation) const {
    const auto touches = [&](double z) {
        return oracleSmallestGap(tool_, {dvec3(x, y, z), rotation}, truth_) < 0.0;
    };
    return firstTouch(0.4, 1.0, touches);
}

Pose FeelRig::at(double x, double y, double depth, const dvec3& rotation) const {
    const dquat turned = rotationExp(rotation);
    return {dvec3(x, y, restingPlace(x, y, turned) + depth), turned};
}

Pose FeelRig::onRing(double angle, double depth) const {
    constexpr double kRing = 0.1; // [m]
    const dvec3 axis = glm::normalize(dvec3(0.3, 0.4, -1.0));
    const dvec3 u = glm::normalize(glm::cross(axis, dvec3(0.0, 1.0, 0.0))), v = glm::cross(axis, u);
    const dvec3 place = kRing * (std::cos(angle) * u + std::sin(angle) * v);
    return at(place.x, place.y, depth);
}

void FeelRig::follow(std::vector<HandWaypoint> path) {
    if (!rig_) {
        rig_ = std::make_unique<LockstepRig>(tool_, options_, path.front().deviceThandle);
    }
    started_ = static_cast<double>(ticks_) * period();
    if (spec_.loop) {
        SimulatedHandOptions hand;
        hand.loop = *spec_.loop;
        hand.armLength = std::sqrt(*options_.device.rotationalDamping / *options_.device.damping);
        hand_ = std::make_unique<SimulatedHand>(HandPath(std::move(path)), hand);
    } else {
        hand_ = std::make_unique<ScriptedHand>(HandPath(std::move(path)));
    }
}

void FeelRig::look() {
    if (!still_ || spec_.noise) {
        still_ = isWall(spec_) ? wallFrame(make_, spec_.noise) : make_.make(*camera_.next().value());
    }
    rig_->show(*still_);
    ++frames_;
}

void FeelRig::run(double seconds) {
    const auto count = static_cast<uint64_t>(std::lround(seconds / period()));
    for (uint64_t k = 0; k < count; ++k, ++ticks_) {
        const double now = static_cast<double>(ticks_) * period();
        while (static_cast<double>(frames_) <= now * kFrameRate) {
            look();
        }
        const HandSample sample = hand_->read(now - started_);
        record_ = rig_->step(sample.deviceThandle);
        hand_->write(record_.deviceWrench, period());
        trace_.add(record_.wrench, sample.deviceThandle.position);
    }
}

} // namespace fathom::stability
