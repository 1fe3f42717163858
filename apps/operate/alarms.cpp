// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/alarms.h"

#include "apps/operate/theme.h"

#include <algorithm>
#include <tuple>

namespace fathom::operate {

namespace {

constexpr size_t kMaxEnded = 100; // alarms in the history

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
    constexpr ImU32 kColours[] = {colour::kAdvisory, colour::kCaution, colour::kWarningWord};
    return kColours[static_cast<int>(level)];
}

// True when a cause has lasted long enough to be an alarm.
bool Alarms::lasts(bool on, const std::string& key, double t, double after) {
    if (!on) {
        pendingSince_.erase(key);
        return false;
    }
    double& since = pendingSince_.try_emplace(key, t).first->second;
    since = std::min(since, t); // time goes back in playback
    return t - since >= settle_ * after;
}

void Alarms::set(bool on, Level level, const std::string& key, const Text& text, double t, Filter filter) {
    const auto at = std::ranges::find(alarms_, key, &Alarm::key);
    const bool now = lasts(on, key, t, filter.after);
    if (at != alarms_.end()) {
        update(*at, now || (on && at->active), text, t, filter);
    } else if (now) {
        alarms_.push_back({level, key, text.what, text.todo, t, t, true, false});
    }
}

void Alarms::update(Alarm& alarm, bool on, const Text& text, double t, Filter filter) {
    alarm.since = std::min(alarm.since, t); // a new run, such as after a change of pilot, begins at 0
    alarm.last = std::min(alarm.last, t);
    if (on) {
        if (!alarm.active) { // latched again
            alarm.since = t;
            alarm.acknowledged = false;
        }
        alarm.what = text.what;
        alarm.todo = text.todo;
        alarm.last = t;
        alarm.active = true;
    } else if (alarm.active && t - alarm.last >= settle_ * filter.hold) {
        alarm.active = false;
        history_.push_front({alarm.level, alarm.what, alarm.since, alarm.last});
        history_.resize(std::min(history_.size(), kMaxEnded));
    }
}

// An event: latched but not active.
void Alarms::raise(Level level, const std::string& key, const std::string& what, double t) {
    for (const bool on : {false, true, false}) {
        set(on, level, key, {what, ""}, t);
    }
}

std::vector<const Alarm*> Alarms::shown() const {
    std::vector<const Alarm*> list;
    for (const Alarm& alarm : alarms_) {
        list.push_back(&alarm);
    }
    std::ranges::stable_sort(list, [](const Alarm* a, const Alarm* b) {
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

} // namespace fathom::operate
