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
#include <limits>

namespace fathom::profile {

namespace {

constexpr double kDeep = 0.005, kStart = 0.02; // [m] below the surface; in front of it at the start
constexpr double kMaxForce = 0.7;              // share of the device's limit, beyond which no ripple shows
constexpr double kLanding = 0.4;               // [s] until the figures count
constexpr size_t kPlaces = 3;
constexpr double kBeside = 0.05;           // [m] from the tool's path to the truth that does not matter
constexpr double kPlainStiffness = 1000.0; // [N/m] for which the ripple is stated

// A run at one place.
class StillHand {
public:
    StillHand(const Scene& scene, const Tool& tool, const std::vector<HostFixtures>& frames,
              const Pose& start)
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
        StepInput input = stepInput({hand}, now);
        input.captureTime = now;
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
    const std::vector<HostFixtures>& frames_;
    HapticCycle cycle_;
    CullCpu cull_;
    BehindTracker behind_;
    HostFixtures shown_;
    RegionGrid grid_;
    std::array<ContactSet, 2> sets_;
    ActiveContacts<ContactSet*> contacts_;
    CpuSamples query_, step_;
    uint64_t ticks_ = 0, generation_ = 0;
};

Pose moved(const Pose& pose, const dvec3& by) {
    return {pose.position + by, pose.rotation};
}

// The spheres that a tool can meet on its way from the camera along `in`.
HostFixtures alongPath(const HostFixtures& truth, const Tool& tool, const dvec3& from, const dvec3& in) {
    HostFixtures near;
    near.origin = truth.origin;
    const RegionSpheres& all = truth.spheres;
    for (size_t i = 0; i < all.size(); ++i) {
        const dvec3 offset = truth.origin + dvec3(all.x[i], all.y[i], all.z[i]) - from;
        const double beside = glm::length(offset - glm::dot(offset, in) * in);
        if (beside < tool.boundingRadius() + static_cast<double>(all.radius[i]) + kBeside) {
            near.spheres.addFrom(all, i);
        }
    }
    return near;
}

// Sums over all places.
struct FeltSums {
    CpuSamples query, ticks;
    double squares = 0.0, sum = 0.0, samples = 0.0;

    void addGap(double gap) {
        squares += gap * gap;
        sum += gap;
        samples += 1.0;
    }
};

} // namespace

FeltPlaces::FeltPlaces(const Tool& tool, const HostFixtures& truth, const Pose& baseTcamera)
    : tool_(tool) {
    const RegionSpheres& s = truth.spheres;
    for (size_t k = 0; k < kPlaces && s.size() > 0; ++k) {
        const size_t sphere = s.size() * (2 * k + 1) / (2 * kPlaces);
        const dvec3 towards =
            truth.origin + dvec3(s.x[sphere], s.y[sphere], s.z[sphere]) - baseTcamera.position;
        Place place{baseTcamera, glm::normalize(towards), {}};
        place.truth = alongPath(truth, tool, baseTcamera.position, place.in);
        const auto at = [&](double away) {
            return Pose{baseTcamera.position + away * place.in, baseTcamera.rotation};
        };
        const auto touches = [&](double away) {
            return oracleSmallestGap(tool, at(away), place.truth) < 0.0;
        };
        const double beyond = glm::length(towards) + 2.0 * tool.boundingRadius();
        const double away = firstTouch(0.0, beyond, touches);
        if (away > 0.0 && away < beyond) {
            place.rest = at(away);
            places_.push_back(std::move(place));
        }
    }
    if (places_.empty()) {
        throw Error("feel: the tool touches nothing");
    }
}

FeltSurface FeltPlaces::feel(const Scene& scene, const std::vector<HostFixtures>& frames, double rateHz,
                             double seconds) const {
    FeltSurface felt;
    FeltSums sums;
    felt.passive = std::numeric_limits<double>::infinity();
    for (const Place& place : places_) {
        StillHand hand(scene, tool_, frames, moved(place.rest, -kStart * place.in));
        FeltTrace trace(hand.options().period);
        const double stiffness = hand.options().springs.stiffness;
        const double deepest = std::min(kDeep, kMaxForce * hand.options().forceLimit / stiffness);
        const auto ticks = static_cast<int>((kLanding + seconds) / hand.options().period);
        for (int k = 0; k < ticks; ++k) {
            const double t = k * hand.options().period;
            const double depth = std::min(deepest, -kStart + (deepest + kStart) * 2.0 * t / kLanding);
            const StepRecord record = hand.step(moved(place.rest, depth * place.in), rateHz);
            if (t < kLanding) {
                continue;
            }
            trace.add(record.wrench, record.device.position);
            felt.passive = std::min(record.marginPassive, felt.passive); // NaN in every step or in none
            if (hand.newFrameNext(rateHz)) {
                sums.addGap(oracleSmallestGap(tool_, record.tool, place.truth));
            }
        }
        const double scale = kPlainStiffness / stiffness;
        felt.ripple += scale * trace.forceRms() / static_cast<double>(count());
        felt.band += scale * trace.forceBand(10.0, 35.0) / static_cast<double>(count());
        felt.step = std::max(felt.step, scale * trace.forceStep());
        sums.query.add(hand.query());
        sums.ticks.add(hand.steps());
    }
    felt.error = std::sqrt(sums.squares / sums.samples);
    felt.bias = sums.sum / sums.samples;
    felt.query = sums.query.cost();
    felt.tick = sums.ticks.cost();
    return felt;
}

} // namespace fathom::profile
