// SPDX-License-Identifier: Apache-2.0
#include "apps/profile/felt_surface.h"

#include "apps/verify/felt_trace.h"
#include "apps/verify/pressed_gripper.h"
#include "engine/contact/behind.h"
#include "engine/contact/cull_cpu.h"
#include "engine/reference/contact_oracle.h"
#include "engine/run/active_contacts.h"
#include "engine/types/error.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fathom::profile {

namespace {

constexpr double kDeep = 0.005, kStart = 0.02; // [m] below the surface; in front of it at the start
constexpr double kLanding = 0.4;               // [s] until the figures count
constexpr size_t kPlaces = 3;
constexpr double kPlainStiffness = 1000.0; // [N/m] for which the ripple is stated

// A run at one place.
class StillHand {
public:
    StillHand(const Scene& scene, const Tool& tool, const std::vector<Fixtures>& frames, const Pose& start)
        : options_(makeHapticOptions(scene, tool))
        , reach_(scene.contact.reach)
        , tool_(tool)
        , frames_(frames)
        , cycle_(tool, {}, options_, start) {}

    // The newest frame is that of time x rate.
    StepRecord step(const Pose& hand, double rateHz) {
        const double now = static_cast<double>(ticks_++) * options_.period;
        const auto frame = static_cast<uint64_t>(now * rateHz);
        if (frame + 1 != generation_) {
            show(frame, now);
        }
        ContactSet& next = sets_[contacts_.active() == &sets_[0] ? 1 : 0];
        const Clocks asking;
        cull_.query(tool_, cycle_.pose(), reach_, shown_, grid_, next);
        behind_.update(tool_, shown_, grid_.maxRadius(), next);
        query_.take(asking);
        next.query = ticks_;
        contacts_.offer([&next] { return &next; });
        StepInput input;
        input.time = input.captureTime = now;
        input.deviceThandle = hand;
        input.frame = shown_.frame;
        input.generation = shown_.generation;
        const Clocks stepping;
        const StepRecord record = contacts_.step(cycle_, input);
        step_.take(stepping);
        return record;
    }
    bool newFrameNext(double rateHz) const {
        return static_cast<uint64_t>(static_cast<double>(ticks_) * options_.period * rateHz) + 1 !=
               generation_;
    }
    const HapticOptions& options() const { return options_; }
    const CpuSamples& query() const { return query_; }
    const CpuSamples& steps() const { return step_; }

private:
    void show(uint64_t frame, double now) {
        shown_ = frames_[frame % frames_.size()];
        shown_.frame = static_cast<int64_t>(frame);
        shown_.generation = generation_ = frame + 1;
        shown_.captureTime = now;
        grid_.build(shown_.spheres);
    }

    HapticOptions options_;
    double reach_;
    const Tool& tool_;
    const std::vector<Fixtures>& frames_;
    HapticCycle cycle_;
    CullCpu cull_;
    BehindTracker behind_;
    Fixtures shown_;
    RegionGrid grid_;
    std::array<ContactSet, 2> sets_;
    ActiveContacts<ContactSet*> contacts_;
    CpuSamples query_, step_;
    uint64_t ticks_ = 0, generation_ = 0;
};

// Resting place on the optical axis through a sphere of the truth.
Pose restingPose(const Tool& tool, const Fixtures& truth, size_t sphere) {
    const RegionSpheres& s = truth.spheres;
    const dvec3 towards = glm::normalize(dvec3(s.x[sphere], s.y[sphere], s.z[sphere]));
    const auto touches = [&](double away) {
        return oracleSmallestGap(tool, {truth.origin + away * towards, dquat(1.0, 0.0, 0.0, 0.0)}, truth) <
               0.0;
    };
    return {truth.origin + firstTouch(0.2, 3.0, touches) * towards, dquat(1.0, 0.0, 0.0, 0.0)};
}

} // namespace

FeltSurface feelSurface(const Scene& scene, const Tool& tool, const Fixtures& truth,
                        const std::vector<Fixtures>& frames, double rateHz, double seconds) {
    FeltSurface felt;
    CpuSamples query, steps;
    double squares = 0.0, sum = 0.0, samples = 0.0;
    for (size_t place = 0; place < kPlaces; ++place) {
        const Pose rest = restingPose(tool, truth, truth.spheres.size() * (2 * place + 1) / (2 * kPlaces));
        const dvec3 in = glm::normalize(rest.position - truth.origin);
        const auto deep = [&](double depth) { return Pose{rest.position + depth * in, rest.rotation}; };
        StillHand hand(scene, tool, frames, deep(-kStart));
        FeltTrace trace(hand.options().period);
        const auto ticks = static_cast<int>((kLanding + seconds) / hand.options().period);
        for (int k = 0; k < ticks; ++k) {
            const double t = k * hand.options().period;
            const double depth = std::min(kDeep, -kStart + (kDeep + kStart) * 2.0 * t / kLanding);
            const StepRecord record = hand.step(deep(depth), rateHz);
            if (t < kLanding) {
                continue;
            }
            trace.add(record.wrench, record.device.position);
            if (hand.newFrameNext(rateHz)) {
                const double gap = oracleSmallestGap(tool, record.tool, truth);
                squares += gap * gap, sum += gap, samples += 1.0;
            }
        }
        if (!(glm::length(trace.meanForce()) > 0.0)) {
            throw Error("profile feel: the tool touches nothing");
        }
        const double scale = kPlainStiffness / hand.options().springs.stiffness / kPlaces;
        felt.ripple += scale * trace.forceRms();
        felt.band += scale * trace.forceBand(10.0, 35.0);
        query.add(hand.query());
        steps.add(hand.steps());
    }
    felt.error = std::sqrt(squares / samples);
    felt.bias = sum / samples;
    felt.query = query.cost();
    felt.step = steps.cost();
    return felt;
}

} // namespace fathom::profile
