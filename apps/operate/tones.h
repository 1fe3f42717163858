// SPDX-License-Identifier: Apache-2.0
// Which tone a pilot hears, and what it sounds like.
#pragma once

#include "apps/operate/alarms.h"

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace fathom::operate {

// From the least to the most urgent.
enum class Tone { Contact, Limit, Stale, Lost };
const char* toneName(Tone tone); // contact, limit, stale, lost

inline constexpr uint32_t kToneRate = 48000; // [samples/s]
// Mono. Tones differ in pitch and in number of notes, and are shorter than a second.
std::vector<int16_t> samplesOf(Tone tone);

// Window thread, once per frame of a live run.
class ToneRules {
public:
    // The most urgent of: a first contact after a second without one; force or torque that reaches its limit;
    // regions that have become too old; a device, camera, GPU or arm that is lost.
    std::optional<Tone> step(const Console& console, const RunView& run, const Alarms& alarms);

private:
    std::set<std::string> before_; // keys of active alarms
    double contact_ = -1e9;        // [s] of the last tick in contact
};

} // namespace fathom::operate
