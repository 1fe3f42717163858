// SPDX-License-Identifier: Apache-2.0
#include "apps/stability/loop_rig.h"

#include "engine/haptics/limits.h"

namespace fathom::stability {

namespace {

constexpr double kNoLimit = 1e9;
constexpr double kReach = 0.01; // [m] reach of the contact query

SimulatedHandOptions handOptions(const LoopSpec& spec) {
    SimulatedHandOptions options;
    options.loop = {spec.wholeMass(), spec.wholeDamping(), spec.hand.stiffness};
    options.armLength = spec.armLength;
    options.encoderStep = spec.encoderStep;
    options.encoderAngle = spec.encoderAngle;
    options.delayTicks = spec.delay;
    return options;
}

} // namespace

HapticOptions loopOptions(const LoopSpec& spec, const Tool& tool) {
    HapticOptions options;
    options.period = spec.period();
    options.device = devicePreset("ideal");
    options.device.stiffness = kNoLimit; // so that only the passive bound limits it
    options.device.damping = spec.damping;
    options.device.rotationalStiffness.reset();
    options.device.rotationalDamping = spec.damping * spec.armLength * spec.armLength;
    options.lowPassGain = lowPassGain(spec.lowPassHz, options.period);
    options.deviceDelayTicks = spec.delay;

    options.coupling.period = options.period;
    options.coupling.delayTicks = spec.delay + lowPassDelayTicks(options.lowPassGain);
    options.coupling.toolRadius = tool.gyrationRadius();
    options.coupling.stiffness = spec.stiffness;
    options.coupling.rotationalStiffness = spec.rotationalStiffness;
    options.coupling.damping = spec.virtualDamping;
    options.forceLimit = spec.limited ? options.device.forceLimit : kNoLimit;
    options.torqueLimit = spec.limited ? options.device.torqueLimit : kNoLimit;
    if (!spec.limited) {
        options.slewForce = options.slewTorque = kNoLimit / options.period;
    }
    options.coupling.slewForce = options.slewForce;
    options.coupling.slewTorque = options.slewTorque;
    options.springs = makeSprings(options.device, options.coupling);
    options.passivityController = spec.controller;
    options.proxy.friction = spec.friction;
    options.proxy.rows.smooth = spec.smooth;
    options.needsContacts = spec.fixtures.has_value();
    return options;
}

LoopRig::LoopRig(const LoopSpec& spec)
    : spec_(spec)
    , tool_(buildSphereTree(spec.leaves))
    , options_(loopOptions(spec, tool_))
    , hand_(HandPath(spec.path), handOptions(spec))
    , cycle_(std::make_unique<HapticCycle>(tool_, spec_.shapes, options_, hand_.handle())) {
    if (spec_.fixtures) {
        grid_.build(spec_.fixtures->spheres);
    }
}

void LoopRig::show(HostFixtures fixtures) {
    spec_.fixtures = std::move(fixtures);
    grid_.build(spec_.fixtures->spheres);
}

void LoopRig::account(const Wrench& felt, const Pose& before, double period) {
    const Pose& after = hand_.handle();
    const dvec3 moved = after.position - before.position;
    const dvec3 turned = rotationBetween(before.rotation, after.rotation);
    const double kk = spec_.armLength * spec_.armLength;
    const double square = glm::dot(moved, moved) + kk * glm::dot(turned, turned);
    energyOut_ += glm::dot(felt.force, moved) + glm::dot(felt.torque, turned);
    dissipated_ += spec_.damping * square / period;
    pathLength_ += std::sqrt(square);
}

const StepRecord& LoopRig::tick() {
    const double period = measured_ > 0.0 ? measured_ : options_.period;
    StepInput input = stepInput(hand_.read(time_), time_);
    input.measuredPeriod = measured_;
    input.guidance = spec_.guidance;
    if (spec_.fixtures) {
        ContactSet& next = sets_[contacts_.active() == &sets_[0] ? 1 : 0];
        cull_.query(tool_, cycle_->pose(), kReach, *spec_.fixtures, grid_, next);
        next.query = ticks_;
        contacts_.offer([&next] { return &next; });
        input.frame = spec_.fixtures->frame;
        input.generation = spec_.fixtures->generation;
        input.captureTime = time_;
    }
    record_ = contacts_.step(*cycle_, input);
    const uint64_t slots = spec_.delay + 1;
    sent_[ticks_ % slots] = record_.deviceWrench;
    ++ticks_;
    const Pose before = hand_.handle();
    hand_.write(record_.deviceWrench, period);
    account(sent_[ticks_ % slots], before, period); // the oldest: the force that the hand felt
    time_ += period;
    return record_;
}

void LoopRig::run(double seconds) {
    const double end = time_ + seconds - 0.5 * options_.period;
    while (time_ < end) {
        tick();
    }
}

Shape wallShape(const dvec3& normal, double height) {
    Shape shape;
    shape.kind = ShapeKind::Plane;
    const dvec3 up(0.0, 0.0, 1.0), axis = glm::cross(up, normal);
    const double sine = glm::length(axis);
    const dvec3 across = sine > 0.0 ? axis / sine : dvec3(1.0, 0.0, 0.0);
    shape.baseTshape = {normal * height, rotationExp(across * std::atan2(sine, normal.z))};
    return shape;
}

Shape lineShape(const dvec3& along) {
    Shape shape = wallShape(along, 0.0); // its z axis points along
    shape.kind = ShapeKind::Line;
    return shape;
}

HostFixtures sphereWall(double height, uint64_t generation) {
    constexpr double kRadius = 0.04, kSpacing = 0.004;
    constexpr int kHalf = 8;
    HostFixtures fixtures;
    fixtures.frame = static_cast<int64_t>(generation);
    fixtures.generation = generation;
    fixtures.origin = {0.0, 0.0, height};
    for (int i = -kHalf; i <= kHalf; ++i) {
        for (int j = -kHalf; j <= kHalf; ++j) {
            fixtures.spheres.add({kSpacing * i, kSpacing * j, -kRadius}, kRadius);
        }
    }
    return fixtures;
}

HandWaypoint wayAt(double t, const dvec3& position, const dvec3& rotation) {
    return {t, {position, rotationExp(rotation)}, 0};
}

} // namespace fathom::stability
