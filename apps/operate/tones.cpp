// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/tones.h"

#include "engine/types/angle.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace fathom::operate {

namespace {

struct Note {
    double hertz, seconds; // 0 Hz: silence
};

std::span<const Note> notesOf(Tone tone) {
    static constexpr Note kContact[] = {{880.0, 0.07}};
    static constexpr Note kLimit[] = {{587.0, 0.09}, {0.0, 0.05}, {587.0, 0.09}};
    static constexpr Note kStale[] = {{392.0, 0.3}};
    static constexpr Note kLost[] = {{784.0, 0.14}, {523.0, 0.14}, {0.0, 0.06}, {784.0, 0.14}, {523.0, 0.2}};
    switch (tone) {
    case Tone::Contact:
        return kContact;
    case Tone::Limit:
        return kLimit;
    case Tone::Stale:
        return kStale;
    case Tone::Lost:
        break;
    }
    return kLost;
}

std::optional<Tone> toneOf(const std::string& alarm) {
    if (alarm == "hand" || alarm == "gpu" || alarm == "arm" || alarm == "camera") {
        return Tone::Lost;
    }
    return alarm == "stale"                        ? std::optional(Tone::Stale)
           : alarm == "force" || alarm == "torque" ? std::optional(Tone::Limit)
                                                   : std::nullopt;
}

} // namespace

const char* toneName(Tone tone) {
    constexpr const char* kNames[] = {"contact", "limit", "stale", "lost"};
    return kNames[static_cast<size_t>(tone)];
}

std::vector<int16_t> samplesOf(Tone tone) {
    constexpr double kLoud = 0.35 * 32767.0;
    constexpr double kEdge = 0.006; // [s] of rise and fall, without which a note clicks
    std::vector<int16_t> samples;
    for (const Note& note : notesOf(tone)) {
        const auto count = static_cast<size_t>(note.seconds * kToneRate);
        for (size_t i = 0; i < count; ++i) {
            const double t = static_cast<double>(i) / kToneRate, left = note.seconds - t;
            const double loud = kLoud * std::clamp(std::min(t, left) / kEdge, 0.0, 1.0);
            samples.push_back(static_cast<int16_t>(loud * std::sin(kTurn * note.hertz * t)));
        }
    }
    return samples;
}

std::optional<Tone> ToneRules::step(const Console& console, const RunView& run, const Alarms& alarms) {
    constexpr double kFirst = 1.0; // [s] without contact
    std::optional<Tone> most;
    const auto raise = [&](Tone tone) { most = most ? std::max(*most, tone) : tone; };
    std::set<std::string> now;
    for (const Alarm* alarm : alarms.shown()) {
        if (!alarm->active) {
            continue;
        }
        now.insert(alarm->key);
        const std::optional<Tone> tone = toneOf(alarm->key);
        if (tone && before_.count(alarm->key) == 0) {
            raise(*tone);
        }
    }
    before_ = std::move(now);
    const StepRecord& record = run.step().record;
    if (console.switches.forces && record.contactCount > 0) {
        const bool newRun = record.t < contact_; // each run begins at 0
        if (newRun || record.t - contact_ > kFirst) {
            raise(Tone::Contact);
        }
        contact_ = record.t;
    }
    return most;
}

} // namespace fathom::operate
