// SPDX-License-Identifier: Apache-2.0
#include "engine/model/cover_refine.h"

#include <algorithm>
#include <iterator>

namespace fathom {

namespace {

constexpr double kGain = 0.99; // of the proven protrusion, which samples of the spheres may not reach

// A sphere of a cover, and the pieces that it alone must contain.
struct CoverPart {
    CoverShare share;
    Sphere sphere;
    double out; // [m] protrusion
};

CoverPart partOf(const CoverFitting& f, CoverShare share) {
    const Sphere s = sphereAround(f, share);
    return {std::move(share), s, protrusionOf(f.distance, s)};
}

// The two parts that one sphere would contain with the least protrusion, estimated from their spheres.
std::pair<size_t, size_t> cheapestPair(const CoverFitting& f, const std::vector<CoverPart>& parts,
                                       size_t without) {
    std::pair<size_t, size_t> best{parts.size(), parts.size()};
    double least = 1e300;
    for (size_t i = 0; i < parts.size(); ++i) {
        size_t near = parts.size();
        double apart = 1e300;
        for (size_t j = 0; j < parts.size(); ++j) {
            const double d = glm::distance(parts[i].sphere.centre, parts[j].sphere.centre);
            if (j != i && j != without && d < apart) {
                apart = d;
                near = j;
            }
        }
        if (i == without || near == parts.size()) {
            continue;
        }
        const Sphere &a = parts[i].sphere, &b = parts[near].sphere;
        const double radius = std::max({a.radius, b.radius, 0.5 * (apart + a.radius + b.radius)});
        const double along = apart > 0.0 ? std::clamp((radius - a.radius) / apart, 0.0, 1.0) : 0.0;
        const double out = protrusionOf(f.distance, {glm::mix(a.centre, b.centre, along), radius});
        if (out < least) {
            least = out;
            best = {i, near};
        }
    }
    return best;
}

// Merges two parts other than `worst`; false if their sphere would protrude as far as that one's.
bool mergeCheapest(const CoverFitting& f, std::vector<CoverPart>& parts, size_t worst) {
    const auto [a, b] = cheapestPair(f, parts, worst);
    if (a == parts.size()) {
        return false;
    }
    CoverShare share = parts[a].share;
    share.insert(share.end(), parts[b].share.begin(), parts[b].share.end());
    CoverPart merged = partOf(f, std::move(share));
    if (merged.out >= parts[worst].out) {
        return false;
    }
    parts[a] = std::move(merged);
    parts[b].share.clear(); // the next half takes its place
    return true;
}

} // namespace

std::vector<Sphere> refinedCover(const CoverFitting& f, const std::vector<Sphere>& spheres, uint32_t leaves) {
    std::vector<CoverPart> parts;
    for (CoverShare& share : sharesOfCover(f, spheres)) {
        if (!share.empty()) {
            parts.push_back(partOf(f, std::move(share)));
        }
    }
    for (uint32_t round = 0; round < 4 * leaves && !parts.empty(); ++round) {
        const auto worst =
            static_cast<size_t>(std::ranges::max_element(parts, {}, &CoverPart::out) - parts.begin());
        auto [first, second] = halvesOf(f.pieces, parts[worst].share);
        if (first.empty() || second.empty()) {
            break;
        }
        CoverPart a = partOf(f, std::move(first)), b = partOf(f, std::move(second));
        const bool gains = std::max(a.out, b.out) < parts[worst].out;
        if (!gains || (parts.size() >= leaves && !mergeCheapest(f, parts, worst))) {
            break;
        }
        parts[worst] = std::move(a);
        const auto free = std::ranges::find_if(parts, [](const CoverPart& p) { return p.share.empty(); });
        free != parts.end() ? void(*free = std::move(b)) : parts.push_back(std::move(b));
    }
    std::vector<Sphere> result;
    std::ranges::transform(parts, std::back_inserter(result), &CoverPart::sphere);
    return worstOf(f, result) < kGain * worstOf(f, spheres) ? result : spheres;
}

} // namespace fathom
