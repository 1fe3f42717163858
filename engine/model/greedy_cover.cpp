// SPDX-License-Identifier: Apache-2.0
#include "engine/model/greedy_cover.h"
#include <algorithm>
#include <bit>
#include <queue>

namespace fathom {

namespace {

using Bits = std::vector<uint64_t>; // one word per group of pieces

bool holds(const Sphere& s, const CoverPiece& piece) {
    const dvec3 d = piece.middle - s.centre;
    const double square = glm::dot(d, d);
    const double sure = s.radius - piece.reach, never = s.radius + piece.reach;
    if (sure > 0.0 && square <= sure * sure) {
        return true;
    }
    return square <= never * never && piece.radiusFrom(s.centre) <= s.radius;
}

enum class Share { None, Some, All };

// Conservative test whether a sphere contains the content of another sphere.
Share shareOf(const Sphere& s, const Sphere& about) {
    const double slack = 1e-9 * (s.radius + glm::length(s.centre));
    const double d = glm::distance(about.centre, s.centre);
    return d > s.radius + about.radius + slack    ? Share::None
           : d + about.radius + slack <= s.radius ? Share::All
                                                  : Share::Some;
}

size_t mostHeldBy(const Sphere& s, const PieceGroups& groups) {
    size_t most = 0;
    for (size_t g = 0; g < groups.count(); ++g) {
        most += shareOf(s, groups.boundOf(g)) == Share::None ? 0 : groups.pieces(g).size();
    }
    return most;
}

// Of the pieces in `wanted`.
Bits heldBy(const Sphere& s, const PieceGroups& groups, const Bits& wanted) {
    Bits bits(groups.count(), 0);
    for (size_t g = 0; g < groups.count(); ++g) {
        const Share share = wanted[g] == 0 ? Share::None : shareOf(s, groups.boundOf(g));
        bits[g] = share == Share::All ? wanted[g] : 0;
        if (share != Share::Some) {
            continue;
        }
        const std::span<const CoverPiece> group = groups.pieces(g);
        for (uint64_t ask = wanted[g]; ask != 0; ask &= ask - 1) {
            const int i = std::countr_zero(ask);
            bits[g] |= static_cast<uint64_t>(holds(s, group[static_cast<size_t>(i)])) << i;
        }
    }
    return bits;
}

size_t gainOf(const Bits& bits, const Bits& left) {
    size_t gain = 0;
    for (size_t w = 0; w < bits.size(); ++w) {
        gain += static_cast<size_t>(std::popcount(bits[w] & left[w]));
    }
    return gain;
}

struct Pick {
    size_t gain, centre;
    bool operator<(const Pick& o) const { return gain < o.gain || (gain == o.gain && centre > o.centre); }
};

class Greedy {
public:
    Greedy(const PieceGroups& groups, double protrusion, size_t most)
        : groups_(groups)
        , protrusion_(protrusion)
        , most_(most)
        , remaining_(groups.size()) {
        for (size_t g = 0; g < groups_.count(); ++g) {
            left_.push_back(~uint64_t{0} >> (64 - groups_.pieces(g).size()));
        }
    }

    // False when more than `most` are needed.
    bool pickCentres(const std::vector<CoverCentre>& centres) {
        std::vector<Sphere> balls;
        std::priority_queue<Pick> queue;
        for (const CoverCentre& one : centres) {
            const Sphere ball{one.centre, one.depth + protrusion_};
            if (ball.radius > 0.0) {
                queue.push({mostHeldBy(ball, groups_), balls.size()});
                balls.push_back(ball);
            }
        }
        std::vector<Bits> held(balls.size()); // empty until the ball is evaluated
        while (remaining_ > 0 && !queue.empty()) {
            Pick top = queue.top();
            queue.pop();
            Bits& bits = held[top.centre];
            if (bits.empty()) {
                bits = heldBy(balls[top.centre], groups_, left_); // fewer pieces remain later
            }
            top.gain = gainOf(bits, left_); // gains only decrease, so a ball that is still best is the best
            if (top.gain == 0) {
                continue;
            }
            if (!queue.empty() && top < queue.top()) {
                queue.push(top);
                continue;
            }
            if (!take(balls[top.centre], bits)) {
                return false;
            }
        }
        return true;
    }

    // A piece that no candidate contains gets its own ball.
    bool rescue() {
        for (const uint32_t place : groups_.places()) {
            if ((left_[place / 64] >> (place % 64) & 1) == 0) {
                continue;
            }
            const CoverPiece& piece = groups_.pieces(place / 64)[place % 64];
            const Sphere ball{piece.middle, piece.depth + protrusion_};
            if (!holds(ball, piece) || !take(ball, heldBy(ball, groups_, left_))) {
                return false;
            }
        }
        return remaining_ == 0;
    }

    std::vector<Sphere>& chosen() { return chosen_; }

private:
    bool take(const Sphere& ball, const Bits& held) {
        if (chosen_.size() == most_) {
            return false;
        }
        for (size_t w = 0; w < left_.size(); ++w) { // `held` was computed when more pieces remained
            remaining_ -= static_cast<size_t>(std::popcount(held[w] & left_[w]));
            left_[w] &= ~held[w];
        }
        chosen_.push_back(ball);
        return true;
    }

    const PieceGroups& groups_;
    double protrusion_;
    size_t most_;
    Bits left_; // not held yet
    size_t remaining_;
    std::vector<Sphere> chosen_;
};

} // namespace

std::vector<Sphere> greedyCover(const PieceGroups& groups, const std::vector<CoverCentre>& centres,
                                double protrusion, size_t most) {
    Greedy greedy(groups, protrusion, most);
    if (!greedy.pickCentres(centres) || !greedy.rescue()) {
        return {};
    }
    return std::move(greedy.chosen());
}

} // namespace fathom
