// SPDX-License-Identifier: Apache-2.0
#include "engine/reference/spheres.h"

#include <algorithm>
#include <cmath>

namespace fathom::reference {

int forbiddenClass(const Scene& scene, uint32_t mask) {
    const std::vector<const FixtureClass*> classes = pointClasses(scene);
    int best = -1;
    for (size_t c = 0; c < classes.size(); ++c) {
        const bool mine = (mask >> c & 1) != 0 && classes[c]->role == Role::Forbidden;
        if (mine && (best < 0 || classes[c]->radius > classes[static_cast<size_t>(best)]->radius)) {
            best = static_cast<int>(c);
        }
    }
    return best;
}

std::vector<int> forbiddenClasses(const Scene& scene, std::span<const uint32_t> masks,
                                  const PointImage& points) {
    std::array<int, 256> ofMask{}; // at most 8 classes
    for (uint32_t mask = 0; mask < 256; ++mask) {
        ofMask[mask] = forbiddenClass(scene, mask);
    }
    std::vector<int> classes(masks.size(), -1);
    for (size_t i = 0; i < masks.size(); ++i) {
        classes[i] = points.z[i] != 0.0 ? ofMask[masks[i]] : -1;
    }
    return classes;
}

double regionRadius(const Scene& scene, int cls) {
    return pointClasses(scene)[static_cast<size_t>(cls)]->radius + 3.0 * scene.registrationSigma;
}

std::vector<double> beamGrowth(const FrameView& view, const PointImage& points) {
    std::vector<double> growth(points.z.size(), 0.0);
    for (size_t i = 0; view.camera().beam && i < growth.size(); ++i) {
        growth[i] = 3.0 * view.camera().beam->at(glm::distance(points.at[i], view.baseTcamera().position));
    }
    return growth;
}

std::vector<RegionSphere> spheres(const Scene& scene, std::span<const int> classes, const PointImage& points,
                                  std::span<const double> growth) {
    std::vector<double> radii;
    for (const FixtureClass* f : pointClasses(scene)) {
        radii.push_back(f->radius + 3.0 * scene.registrationSigma);
    }
    std::vector<RegionSphere> out(classes.size());
    for (size_t i = 0; i < classes.size(); ++i) {
        const double grown = growth.empty() ? 0.0 : growth[i];
        if (classes[i] >= 0 && grown >= 0.0) {
            out[i] = {points.at[i], radii[static_cast<size_t>(classes[i])] + grown, classes[i]};
        }
    }
    return out;
}

Leaks leaks(const Scene& scene, int width, int height, std::span<const int> classes,
            const PointImage& points) {
    Leaks out;
    for (int v = 0; v < height; ++v) {
        for (int u = 0; u < width; ++u) {
            const size_t i = static_cast<size_t>(v) * static_cast<size_t>(width) + static_cast<size_t>(u);
            if (classes[i] < 0) {
                continue;
            }
            const auto c = static_cast<size_t>(classes[i]);
            const auto compare = [&](size_t j) {
                const double apart = glm::distance(points.at[i], points.at[j]);
                const bool surface = std::abs(points.z[j] - points.z[i]) <= 0.7 * apart;
                if (classes[j] == classes[i] && surface && apart >= regionRadius(scene, classes[i])) {
                    out.spacing[c] = std::max(out.spacing[c], apart);
                    out.range[c] = std::max(out.range[c], points.z[i]);
                }
            };
            if (u + 1 < width) {
                compare(i + 1);
            }
            if (v + 1 < height) {
                compare(i + static_cast<size_t>(width));
            }
        }
    }
    return out;
}

Bound boundOf(std::span<const RegionSphere> spheres) {
    Bound b;
    dvec3 sum(0.0);
    for (const RegionSphere& s : spheres) {
        sum += s.radius >= 0.0 ? s.centre : dvec3(0.0);
        b.count += s.radius >= 0.0 ? 1 : 0;
    }
    if (b.count == 0) {
        return b;
    }
    b.centre = sum / static_cast<double>(b.count);
    for (const RegionSphere& s : spheres) {
        if (s.radius >= 0.0) {
            b.radius = std::max(b.radius, glm::distance(s.centre, b.centre) + s.radius);
        }
    }
    return b;
}

} // namespace fathom::reference
