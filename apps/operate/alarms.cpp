// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/alarms.h"

#include "apps/binding/scene_edits.h"
#include "apps/operate/hud.h"
#include "apps/operate/theme.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <tuple>

namespace fathom::operate {

namespace {

constexpr double kPatience = 1.0; // [s]

template <class Value>
std::string print(const char* form, Value value) {
    char text[128];
    std::snprintf(text, sizeof text, form, value);
    return text;
}

} // namespace

const char* levelName(Level level) {
    constexpr const char* kNames[] = {"ADVISORY", "CAUTION", "WARNING"};
    return kNames[static_cast<int>(level)];
}

const char* levelSign(Level level) {
    constexpr const char* kSigns[] = {"i", "!", "\xe2\x9a\xa0"};
    return kSigns[static_cast<int>(level)];
}

ImU32 levelColour(Level level) {
    constexpr ImU32 kColours[] = {colour::kAdvisory, colour::kCaution, colour::kWarning};
    return kColours[static_cast<int>(level)];
}

void Alarms::set(bool on, Level level, const char* key, const std::string& words, double t) {
    const auto at =
        std::find_if(alarms_.begin(), alarms_.end(), [&](const Alarm& a) { return a.key == key; });
    if (at == alarms_.end()) {
        if (on) {
            alarms_.push_back({level, key, words, t, true, false});
        }
        return;
    }
    if (on && !at->active) { // latched again
        at->since = t;
        at->acknowledged = false;
    }
    at->words = on ? words : at->words;
    at->active = on;
}

void Alarms::raise(Level level, const std::string& key, const std::string& words, double t) {
    set(false, level, key.c_str(), words, t);
    set(true, level, key.c_str(), words, t);
    set(false, level, key.c_str(), words, t); // an event: latched but not active
}

// Names the cause when frames stop: the GPU until it has processed a frame again, otherwise the camera.
void Alarms::stepScene(const StepRecord& tick, const HapticOptions& haptics, bool deviceGone) {
    const bool stale = tick.sceneAge > haptics.staleAfter;
    lostFrame_ = deviceGone ? tick.frame : lostFrame_;
    waits_ = deviceGone || (waits_ && stale && tick.frame == lostFrame_);
    set(waits_, Level::Warning, "gpu", "GPU lost: no frames, forces fade; reopening", tick.t);
    set(!waits_ && tick.sceneAge > 5.0 * haptics.staleAfter, Level::Warning, "camera",
        print("Camera silent: scene %.1f s old", tick.sceneAge), tick.t);
    set(stale, Level::Caution, "stale",
        print("Scene stale: over %.0f ms, forces fade", haptics.staleAfter * 1e3), tick.t);
}

// What replay lists as warnings (apps/session/run_watch.h), from what the window holds of the run.
void Alarms::stepProtection(const RunView& run, const Scene& scene, const StepRecord& tick) {
    const Fixtures& shown = run.scene().set;
    regionSeen_.resize(scene.fixtures.size(), tick.t);
    for (size_t row = 0; row < scene.fixtures.size(); ++row) {
        const FixtureClass& f = scene.fixtures[row];
        const bool counts =
            f.isPoints() && f.role == Role::Forbidden && !isSpare(f) && !f.frozen && shown.frame >= 0;
        const std::vector<uint8_t>& of = shown.spheres.fixture;
        const bool some = !counts || std::find(of.begin(), of.end(), static_cast<uint8_t>(row)) != of.end();
        regionSeen_[row] = some ? tick.t : std::min(regionSeen_[row], tick.t); // time goes back in playback
        set(tick.t - regionSeen_[row] > kPatience, Level::Caution, ("region " + f.name).c_str(),
            "No region: no point of '" + f.name + "' for over a second", tick.t);
    }
    forcesSeen_ = tick.state != StepState::Off || tick.frame >= 0 ? tick.t : std::min(forcesSeen_, tick.t);
    set(tick.t - forcesSeen_ > kPatience, Level::Caution, "off",
        shown.frame < 0 ? "No forces: no frame has become a set of regions"
                        : "No forces: no contact answer covers the tool",
        tick.t);
}

void Alarms::step(Console& console, const RunView& run, const HapticOptions& haptics, const Scene& scene,
                  const Health& health) {
    const double now = run.anyTick() ? run.step().record.t : 0.0;
    set(health.handGone, Level::Warning, "hand",
        "Haptic device lost: forces off, the tool stays; reconnecting", now);
    set(!health.recorderFailed.empty(), Level::Caution, "recorder",
        "Recording stopped: " + health.recorderFailed, now);
    if (run.anyTick()) {
        const StepRecord& r = run.step().record;
        const Rates rates = run.rates();
        const double force = glm::length(r.wrench.force), torque = glm::length(r.wrench.torque);
        set(!r.finite, Level::Warning, "finite", "Non-finite value: zero wrench", r.t);
        set(r.state == StepState::Trapped, Level::Warning, "trapped",
            "Tool trapped: no motion satisfies every region", r.t);
        stepScene(r, haptics, health.gpuGone);
        stepProtection(run, scene, r);
        set(force > 0.98 * haptics.forceLimit, Level::Caution, "force",
            print("Force at its limit of %.1f N", haptics.forceLimit), r.t);
        set(torque > 0.98 * haptics.torqueLimit, Level::Caution, "torque",
            print("Torque at its limit of %.2f N m", haptics.torqueLimit), r.t);
        set(rates.worstPeriodMs > 1e4 * haptics.period, Level::Caution, "overrun",
            print("Haptic overrun: a period of %.1f ms", rates.worstPeriodMs), r.t);
        set(r.state == StepState::Escape, Level::Caution, "escape", "New data covers the tool: it moves out",
            r.t);
        set(r.marginPassive < kMarginNoise, Level::Caution, "passive", "Springs exceed the passivity bound",
            r.t);
        const ArmState arm = run.step().driven ? run.step().armStatus.state : ArmState::Follows;
        set(isFault(arm), Level::Warning, "arm", print("Arm %s: arm and tool are stopped", armStateName(arm)),
            r.t);
        set(glm::distance(r.tool.position, r.device.position) > 0.10, Level::Advisory, "apart",
            "Hand and tool are more than 100 mm apart", r.t);
        set(console.frozen, Level::Advisory, "frozen", "Fixtures frozen: camera frames do not change them",
            r.t);
        for (const GuidancePose& g : run.scene().set.guidance) {
            const bool named = g.fixture < scene.fixtures.size() && !isSpare(scene.fixtures[g.fixture]);
            if (named) {
                const std::string& name = scene.fixtures[g.fixture].name;
                set(!g.present, Level::Advisory, ("target " + name).c_str(),
                    "No target: too few points in '" + name + "'", r.t);
            }
        }
    }
    if (console.acknowledge) {
        for (Alarm& alarm : alarms_) {
            alarm.acknowledged = true;
        }
        console.acknowledge = false;
    }
    std::erase_if(alarms_, [](const Alarm& a) { return !a.active && a.acknowledged; });
}

std::vector<const Alarm*> Alarms::shown() const {
    std::vector<const Alarm*> list;
    for (const Alarm& alarm : alarms_) {
        list.push_back(&alarm);
    }
    std::stable_sort(list.begin(), list.end(), [](const Alarm* a, const Alarm* b) {
        return std::tuple(a->level, !a->acknowledged, a->active) >
               std::tuple(b->level, !b->acknowledged, b->active);
    });
    return list;
}

const Alarm* Alarms::worst() const {
    for (const Alarm* alarm : shown()) {
        if (!alarm->acknowledged) {
            return alarm;
        }
    }
    return nullptr;
}

std::vector<std::string> Alarms::inWords() const {
    std::vector<std::string> words;
    for (const Alarm* alarm : shown()) {
        words.push_back(std::string(levelName(alarm->level)) + (alarm->active ? " active " : " latched ") +
                        (alarm->acknowledged ? "acknowledged " : "") + alarm->key);
    }
    return words;
}

void drawAlarms(Console& console, const Alarms& alarms) {
    if (ImGui::Button("Acknowledge all  (Q)")) {
        console.acknowledge = true;
    }
    markPlace(console, "acknowledge");
    const auto list = alarms.shown();
    if (list.empty()) {
        ImGui::TextDisabled("No alarm.");
    }
    for (const Alarm* alarm : list) {
        char since[32];
        std::snprintf(since, sizeof since, "  %.1f s  ", alarm->since);
        colouredText(alarm->acknowledged ? colour::kQuiet : levelColour(alarm->level),
                     (levelSign(alarm->level) + std::string(" ") + levelName(alarm->level) + since +
                      alarm->words + (alarm->active ? "" : " (over)"))
                         .c_str());
    }
}

} // namespace fathom::operate
