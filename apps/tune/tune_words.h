// SPDX-License-Identifier: Apache-2.0
// A result of `fathom tune` in words.
#pragma once

#include "apps/tune/tuner.h"

#include <string>

namespace fathom::tune {

// "filter radius 2 pixels", "image size 320x240", "as written".
std::string settingNameOf(const TunePoint& point);
std::string valueIn(const TunePoint& point, Vary vary); // "2 pixels", "320x240"

// "error 0.0765 mm, vibration 0.035 N, 0.294 ms".
std::string valuesOf(const Score& score);

// One point in one line, for progress.
std::string lineOf(size_t number, const TunePoint& point);

// Why `chosen` has its value of one setting: what the values of the trial measured. Two lines.
std::string reasonOf(const TuneResult& result, const Trial& trial, const TunePoint& chosen);

// Whether the springs of a point are proven stable.
std::string stabilityOf(const TunePoint& point);

// Why no point is chosen, and the nearest one.
std::string noneMeets(const TuneResult& result, const Request& request);

} // namespace fathom::tune
