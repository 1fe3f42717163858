// SPDX-License-Identifier: Apache-2.0
#include "apps/tune/tune_words.h"

#include "engine/types/number_text.h"
#include "engine/types/printed.h"

#include <algorithm>

namespace fathom::tune {

namespace {

using profile::digits;

std::string listed(const std::string& list, const std::string& more) {
    return list.empty() ? more : list + ", " + more;
}

// In what the point at `at` is better than all others of a trial.
std::string advantages(const std::vector<Score>& scores, const std::vector<size_t>& points, size_t at) {
    const auto best = [&](double Score::*value) {
        return std::all_of(points.begin(), points.end(), [&](size_t i) {
            return i == at || scores[at].*value < scores[i].*value || !scores[i].valid();
        });
    };
    std::string words = best(&Score::time) ? "fastest" : "";
    words = best(&Score::error) ? listed(words, "least error") : words;
    return best(&Score::ripple) ? listed(words, "least vibration") : words;
}

} // namespace

std::string valueIn(const TunePoint& point, Vary vary) {
    return vary == Vary::Size ? sizeText(point.width, point.height) : valueOf(point.setting, vary);
}

std::string settingNameOf(const TunePoint& point) {
    for (const Vary vary : kVaried) {
        if (point.varied == nameOf(vary)) {
            return point.varied + " " + valueIn(point, vary);
        }
    }
    return point.varied;
}

std::string valuesOf(const Score& score) {
    return "error " + digits(score.error) + " mm, vibration " + digits(score.ripple) + " N, " +
           digits(score.time) + " ms";
}

std::string lineOf(size_t number, const TunePoint& point) {
    return printed("%3zu  %-24s  ", number, settingNameOf(point).c_str()) + valuesOf(point.score);
}

std::string reasonOf(const TuneResult& result, const Trial& trial, const TunePoint& chosen) {
    const std::string value = valueIn(chosen, trial.vary),
                      before = valueIn(result.points.front(), trial.vary);
    std::string words =
        std::string(nameOf(trial.vary)) + " " + value + (value == before ? ", as before" : ", was " + before);
    if (trial.points.empty()) {
        return words + ": " + (trial.skipped.empty() ? "it has no effect here" : trial.skipped);
    }
    const std::vector<Score> scores = result.scores();
    std::string measured;
    std::string why;
    for (const size_t i : trial.points) {
        const TunePoint& point = result.points[i];
        const std::string own = valueIn(point, trial.vary);
        if (own == value) {
            why = advantages(scores, trial.points, i);
        }
        measured += (measured.empty() ? "" : "; ") + own + ": " + valuesOf(point.score) +
                    (point.score.why.empty() ? "" : " (" + point.score.why + ")");
    }
    if (trial.vary == Vary::Size && chosen.setting.decimation > 1) {
        why += ", but misses things narrower than " + std::to_string(chosen.setting.decimation) +
               " pixels of the camera";
    }
    words += ": " + (why.empty() ? "no other value serves the request better" : why);
    return words + (trial.skipped.empty() ? "" : "; not all were measured, because " + trial.skipped) + "\n" +
           measured;
}

std::string stabilityOf(const TunePoint& point) {
    const double margin = point.felt.passive;
    return std::isnan(margin) ? "not proven, because the damping of this device is unknown"
           : margin >= 0.0    ? "passive, with " + digits(margin) + " N s/m to spare"
                              : "not passive: the springs need " + digits(-margin) +
                                 " N s/m more damping; lower haptics.stiffness or haptics.delay";
}

std::string noneMeets(const TuneResult& result, const Request& request) {
    std::string text = "no point meets the request (" + request.text() + ")";
    if (!result.choice.nearest) {
        return text;
    }
    const TunePoint& near = result.points[*result.choice.nearest];
    text += "; nearest: " + valuesOf(near.score) + " with " + wordsOf(near.setting);
    return text + (result.choice.nearestOpen ? "" : ", which cannot be chosen: " + near.score.why);
}

} // namespace fathom::tune
