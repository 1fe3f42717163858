// SPDX-License-Identifier: Apache-2.0
#include "engine/model/greedy_cover.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <queue>

namespace fathom {

namespace {

using Bits = std::vector<uint64_t>;

bool holds(const Sphere& s, const CoverPiece& piece) {
    const dvec3 d = piece.middle - s.centre;
    const double square = glm::dot(d, d);
    const double sure = s.radius - piece.reach, never = s.radius + piece.reach;
    if (sure > 0.0 && square <= sure * sure) {
        return true;
    }
    return square <= never * never && piece.radiusFrom(s.centre) <= s.radius;
}

// Middles and reaches once more as columns: nearly every question is answered by them alone.
struct Columns {
    std::vector<float> x, y, z, reach;
    std::vector<float> distance; // scratch

    explicit Columns(const std::vector<CoverPiece>& pieces)
        : distance(pieces.size()) {
        for (const CoverPiece& piece : pieces) {
            x.push_back(static_cast<float>(piece.middle.x));
            y.push_back(static_cast<float>(piece.middle.y));
            z.push_back(static_cast<float>(piece.middle.z));
            reach.push_back(static_cast<float>(piece.reach));
        }
    }

    // Distances of all middles from c, right to some 1e-6 of their size.
    void measure(const dvec3& c) {
        const auto cx = static_cast<float>(c.x), cy = static_cast<float>(c.y), cz = static_cast<float>(c.z);
        for (size_t p = 0; p < x.size(); ++p) {
            const float dx = x[p] - cx, dy = y[p] - cy, dz = z[p] - cz;
            distance[p] = std::sqrt(dx * dx + dy * dy + dz * dz);
        }
    }
};

Bits heldBy(const Sphere& s, const std::vector<CoverPiece>& pieces, Columns& columns) {
    Bits bits((pieces.size() + 63) / 64, 0);
    columns.measure(s.centre);
    const auto radius = static_cast<float>(s.radius);
    const auto slack = static_cast<float>(1e-5 * (s.radius + glm::length(s.centre)));
    for (size_t p = 0; p < pieces.size(); ++p) {
        const float d = columns.distance[p], reach = columns.reach[p];
        if (d > radius + reach + slack) {
            continue;
        }
        const bool held = d + reach + slack <= radius || holds(s, pieces[p]);
        bits[p / 64] |= static_cast<uint64_t>(held) << (p % 64);
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
    size_t gain, seat;
    bool operator<(const Pick& o) const { return gain < o.gain || (gain == o.gain && seat > o.seat); }
};

class Greedy {
public:
    Greedy(const std::vector<CoverPiece>& pieces, double protrusion, size_t most)
        : pieces_(pieces)
        , columns_(pieces)
        , protrusion_(protrusion)
        , most_(most)
        , left_((pieces.size() + 63) / 64, 0) {
        for (size_t p = 0; p < pieces.size(); ++p) {
            left_[p / 64] |= uint64_t{1} << (p % 64);
        }
        remaining_ = pieces.size();
    }

    // False when more than `most` are needed.
    bool pickSeats(const std::vector<CoverSeat>& seats) {
        std::vector<Sphere> balls;
        std::vector<Bits> held;
        std::priority_queue<Pick> queue;
        for (const CoverSeat& seat : seats) {
            const Sphere ball{seat.centre, seat.depth + protrusion_};
            if (ball.radius > 0.0) {
                held.push_back(heldBy(ball, pieces_, columns_));
                queue.push({gainOf(held.back(), left_), balls.size()});
                balls.push_back(ball);
            }
        }
        while (remaining_ > 0 && !queue.empty()) {
            Pick top = queue.top();
            queue.pop();
            top.gain = gainOf(held[top.seat], left_); // gains only fall: what is still best now is best
            if (top.gain == 0) {
                continue;
            }
            if (!queue.empty() && top < queue.top()) {
                queue.push(top);
                continue;
            }
            if (!take(balls[top.seat], held[top.seat])) {
                return false;
            }
        }
        return true;
    }

    // What no seat holds gets a ball about itself.
    bool rescue(const std::vector<CoverPiece>& pieces) {
        for (size_t p = 0; p < pieces.size() && remaining_ > 0; ++p) {
            if ((left_[p / 64] >> (p % 64) & 1) == 0) {
                continue;
            }
            const Sphere ball{pieces[p].middle, pieces[p].depth + protrusion_};
            if (!holds(ball, pieces[p]) || !take(ball, heldBy(ball, pieces, columns_))) {
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
        for (size_t w = 0; w < left_.size(); ++w) {
            remaining_ -= static_cast<size_t>(std::popcount(held[w] & left_[w]));
            left_[w] &= ~held[w];
        }
        chosen_.push_back(ball);
        return true;
    }

    const std::vector<CoverPiece>& pieces_;
    Columns columns_;
    double protrusion_;
    size_t most_;
    Bits left_; // not held yet
    size_t remaining_ = 0;
    std::vector<Sphere> chosen_;
};

} // namespace

std::vector<Sphere> greedyCover(const std::vector<CoverPiece>& pieces, const std::vector<CoverSeat>& seats,
                                double protrusion, size_t most) {
    Greedy greedy(pieces, protrusion, most);
    if (!greedy.pickSeats(seats) || !greedy.rescue(pieces)) {
        return {};
    }
    return std::move(greedy.chosen());
}

} // namespace fathom
