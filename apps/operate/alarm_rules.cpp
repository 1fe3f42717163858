// SPDX-License-Identifier: Apache-2.0
// The rules of the alarms and their texts. While forces are off, states that concern only forces raise none.
#include "apps/binding/scene_edits.h"
#include "apps/operate/alarms.h"
#include "apps/operate/hud.h"
#include "apps/operate/wrench_figures.h"
#include "apps/output/silhouette.h"
#include "engine/types/printed.h"

#include <algorithm>

namespace fathom::operate {

namespace {

constexpr double kShortLoss = 1.0;  // [s] without regions or forces that raises no alarm yet
constexpr double kHandApart = 0.10; // [m] from hand to tool

// Whether the points of a class end where its box does: more than a tenth of them are at one of its sides.
bool endsAtBox(const HostFixtures& set, uint8_t row, const Box& box) {
    constexpr double kAtSide = 0.003; // [m]
    size_t all = 0, ends = 0;
    for (size_t i = 0; i < set.spheres.size(); ++i) {
        if (set.spheres.fixture[i] == row) {
            const dvec3 at = regionCentre(set, i);
            const dvec3 inside = glm::min(at - box.min, box.max - at);
            ends += std::min(inside.x, std::min(inside.y, inside.z)) < kAtSide ? 1 : 0;
            ++all;
        }
    }
    return 10 * ends > all;
}

} // namespace

// Names the cause when frames stop: the GPU until it has processed a frame again, otherwise the camera.
void Alarms::stepScene(const StepRecord& tick, bool deviceGone, bool forces) {
    const bool stale = isOld(tick.sceneAge);
    lostFrame_ = deviceGone ? tick.frame : lostFrame_;
    awaitsGpu_ = deviceGone || (awaitsGpu_ && stale && tick.frame == lostFrame_);
    set(awaitsGpu_, Level::Warning, "gpu", {"GPU lost, forces fade", "wait, it is opened again"}, tick.t);
    set(!awaitsGpu_ && tick.sceneAge > 5.0 * kStaleAfter, Level::Warning, "camera",
        {printed("No camera image for %.1f s, forces fade", tick.sceneAge),
         "check the camera's cable and power"},
        tick.t);
    const bool ahead = tick.sceneAge < 0.0;
    set(stale && forces, Level::Caution, "stale",
        {ahead ? printed("Newest frame is %.1f s ahead of the clock, forces fade", -tick.sceneAge)
               : printed("Newest frame is older than %.0f ms, forces fade", kStaleAfter * 1e3),
         ahead ? "check which clock the camera stamps with" : "wait; if it stays, close other programs"},
        tick.t, {0.25, 1.0});
}

// The conditions that replay reports as warnings (apps/replay/run_watch.h), from the data of the window.
void Alarms::stepProtection(const RunView& run, const Scene& scene, const StepRecord& tick, bool forces) {
    const HostFixtures& shown = run.scene().set;
    regionSeen_.resize(scene.fixtures.size(), tick.t);
    for (size_t row = 0; row < scene.fixtures.size(); ++row) {
        const FixtureClass& f = scene.fixtures[row];
        const bool counts =
            f.isPoints() && f.role == Role::Forbidden && !isSpare(f) && !f.frozen && shown.frame >= 0;
        const std::vector<uint8_t>& of = shown.spheres.fixture;
        const bool some = !counts || std::find(of.begin(), of.end(), static_cast<uint8_t>(row)) != of.end();
        regionSeen_[row] = some ? tick.t : std::min(regionSeen_[row], tick.t); // time goes back in playback
        set(tick.t - regionSeen_[row] > kShortLoss, Level::Caution, "region " + f.name,
            {"'" + f.name + "' is not seen and not protected",
             "point the camera at it, or pick its colour (K)"},
            tick.t);
        set(counts && f.box && endsAtBox(shown, static_cast<uint8_t>(row), *f.box), Level::Advisory,
            "box " + f.name,
            {"'" + f.name + "' reaches the side of its box, nothing is protected beyond",
             "enlarge the box or remove it"},
            tick.t, {kShortLoss, kShortLoss});
    }
    forcePossible_ =
        tick.state != StepState::Off || tick.frame >= 0 ? tick.t : std::min(forcePossible_, tick.t);
    set(forces && tick.t - forcePossible_ > kShortLoss, Level::Caution, "off",
        shown.frame < 0 ? Text{"No force, no camera image yet", "wait, or check the camera"}
                        : Text{"No force, the regions here are not known yet", "move the hand slowly"},
        tick.t);
}

// What forces can do to the hand.
void Alarms::stepForces(const RunView& run, const HapticOptions& haptics, bool forces) {
    const StepRecord& r = run.step().record;
    const auto on = [&](bool cause, Level level, const char* key, const Text& text, Filter filter) {
        set(forces && cause, level, key, text, r.t, filter);
    };
    const double late = run.rates().worstPeriodMs, apart = glm::distance(r.tool.position, r.device.position);
    on(r.state == StepState::Trapped, Level::Warning, "trapped",
       {"Tool trapped between regions, force fades", "pull the hand back"}, {});
    on(atForceLimit(r, haptics), Level::Caution, "force",
       {printed("Force at its limit of %.3g N", haptics.forceLimit), "ease off"}, {0.0, 1.0});
    on(atTorqueLimit(r, haptics), Level::Caution, "torque",
       {printed("Torque at its limit of %.3g N m", haptics.torqueLimit), "turn the hand back"}, {0.0, 1.0});
    on(late > 1e4 * haptics.period, Level::Caution, "overrun",
       {printed("Forces came %.0f ms late", late), "close other programs"}, {0.0, 1.0});
    on(r.state == StepState::Escape, Level::Caution, "escape",
       {"A region now covers the tool, which moves out", "let the hand follow"}, {0.15, 1.0});
    on(r.marginPassive < kMarginNoise, Level::Caution, "passive",
       {"Springs are stiffer than the device can hold", "lower haptics.stiffness"}, {0.25, 1.0});
    on(apart > kHandApart, Level::Advisory, "apart",
       {printed("Hand and tool are %.0f mm apart", 1e3 * apart), "bring the hand back"}, {0.25, 1.0});
}

void Alarms::stepTargets(const RunView& run, const Scene& scene, double t) {
    for (const GuidancePose& g : run.scene().set.guidance) {
        if (g.fixture < scene.fixtures.size() && !isSpare(scene.fixtures[g.fixture])) {
            const std::string& name = scene.fixtures[g.fixture].name;
            set(!g.present, Level::Advisory, "target " + name,
                {"No target, '" + name + "' is hardly seen", "point the camera at it"}, t);
        }
    }
}

void Alarms::step(Console& console, const RunView& run, const HapticOptions& haptics, const Scene& scene,
                  const Health& health) {
    const double now = run.anyTick() ? run.step().record.t : 0.0;
    set(health.handGone, Level::Warning, "hand",
        {"Haptic device lost, forces are off", "check its cable; it reconnects by itself"}, now);
    set(!health.recorderFailed.empty(), Level::Caution, "recorder",
        {"Recording stopped, " + health.recorderFailed, "free disk space, then press R"}, now);
    if (run.anyTick()) {
        const StepRecord& r = run.step().record;
        set(!r.finite, Level::Warning, "finite",
            {"A tick had no force, a number was not finite", "Space, then restart"}, r.t);
        stepScene(r, health.gpuGone, console.switches.forces);
        stepProtection(run, scene, r, console.switches.forces);
        stepForces(run, haptics, console.switches.forces);
        const ArmState arm = run.step().driven ? run.step().armStatus.state : ArmState::Follows;
        set(isFault(arm), Level::Warning, "arm",
            {printed("Arm %s, arm and tool stand still", armStateName(arm)), "check the arm, then press A"},
            r.t);
        set(console.switches.frozen, Level::Advisory, "frozen",
            {"Fixtures frozen, new images do not change them", "F to release"}, r.t);
        stepTargets(run, scene, r.t);
    }
    if (console.requests.acknowledge) {
        for (Alarm& alarm : alarms_) {
            alarm.acknowledged = true;
        }
        console.requests.acknowledge = false;
    }
    std::erase_if(alarms_, [](const Alarm& a) { return !a.active && a.acknowledged; });
}

} // namespace fathom::operate
