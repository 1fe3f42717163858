// SPDX-License-Identifier: Apache-2.0
#include "apps/tune/tune_choice.h"

#include "apps/profile/study.h"

#include <algorithm>

namespace fathom::tune {

namespace {

using profile::digits;

bool dominates(const Score& a, const Score& b) {
    return a.valid() && b.valid() && a.time <= b.time && a.error <= b.error &&
           (a.time < b.time || a.error < b.error);
}

bool open(const Score& score) {
    return score.valid() && score.why.empty();
}

// The factor by which a point misses the request, at most 1 when it meets it.
double missOf(const Score& score, const Request& request) {
    return request.error ? score.error / *request.error : score.time / *request.time;
}

// Keeps the indices whose value is within `ratio` of the least.
template <class Value>
void keepLeast(const std::vector<Score>& scores, std::vector<size_t>& indices, double ratio, Value&& value) {
    double least = HUGE_VAL;
    for (const size_t i : indices) {
        least = std::min(least, value(scores[i]));
    }
    std::erase_if(indices, [&](size_t i) { return value(scores[i]) > ratio * least; });
}

std::optional<size_t> nearestOf(const std::vector<Score>& scores, const Request& request, bool onlyOpen) {
    std::optional<size_t> nearest;
    for (size_t i = 0; i < scores.size(); ++i) {
        if ((onlyOpen ? open(scores[i]) : scores[i].valid()) &&
            (!nearest || missOf(scores[i], request) < missOf(scores[*nearest], request))) {
            nearest = i;
        }
    }
    return nearest;
}

} // namespace

std::string Request::text() const {
    return error ? "error at most " + digits(*error) + " mm" : "time at most " + digits(*time) + " ms";
}

bool meets(const Score& score, const Request& request) {
    return open(score) && missOf(score, request) <= 1.0;
}

std::vector<bool> frontOf(const std::vector<Score>& scores) {
    std::vector<bool> front;
    for (const Score& score : scores) {
        front.push_back(score.valid() && std::none_of(scores.begin(), scores.end(), [&](const Score& other) {
                            return dominates(other, score);
                        }));
    }
    return front;
}

std::optional<size_t> dominatorOf(const std::vector<Score>& scores, size_t at) {
    std::optional<size_t> best;
    for (size_t i = 0; i < scores.size(); ++i) {
        if (dominates(scores[i], scores[at]) && (!best || scores[i].time < scores[*best].time)) {
            best = i;
        }
    }
    return best;
}

Choice choose(const std::vector<Score>& scores, const Request& request) {
    std::vector<size_t> good;
    for (size_t i = 0; i < scores.size(); ++i) {
        if (meets(scores[i], request)) {
            good.push_back(i);
        }
    }
    Choice choice;
    if (good.empty()) {
        choice.nearest = nearestOf(scores, request, true);
        choice.nearestOpen = choice.nearest.has_value();
        if (!choice.nearest) {
            choice.nearest = nearestOf(scores, request, false);
        }
        return choice;
    }
    keepLeast(scores, good, kSameValue, [&](const Score& s) { return request.error ? s.time : s.error; });
    keepLeast(scores, good, kSameRipple, [](const Score& s) { return s.ripple; });
    choice.point = choice.nearest = good.front();
    return choice;
}

} // namespace fathom::tune
