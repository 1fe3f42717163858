// SPDX-License-Identifier: Apache-2.0
// The parts of the precision study: data stored or computed in half, single and double. Each returns rows
// with the largest error [mm] and the CPU time of the same loop. The first row per source is the double
// result with error 0. Each throws Error when an error is larger than the format explains.
#pragma once

#include "apps/profile/study.h"

#include <functional>
#include <vector>

namespace fathom::profile {

// A row without times, and the loop to time, which owns its data.
struct PrecisionLoop {
    StudyRow row;
    std::function<void()> run;
};

// Distances of leaves to the nearest of many region spheres, for each format of the sphere centres.
std::vector<PrecisionLoop> centreRows(const StudyContext& context);
// Culls the nodes of the region tree with the leaves. Error: growth of a node in each format; radii round up,
// so that no sphere ever leaves its node.
std::vector<PrecisionLoop> nodeRows(const StudyContext& context);
// Converts depth pixels to points. Error: offset of a point in each pixel format.
std::vector<PrecisionLoop> depthRows(const StudyContext& context);
// The 5x5 bilateral filter: error of the filtered depth for each format of its weights and sums.
std::vector<PrecisionLoop> weightRows(const StudyContext& context);
// Gaps of leaf-sphere pairs as in the haptic tick, computed in each format.
std::vector<PrecisionLoop> gapRows(const StudyContext& context);

// One row of the study. bytes: size of an element; elements: number in the loop; found: NaN for a loop that
// finds nothing.
StudyRow precisionRow(const std::string& source, const std::string& setting, bool isDefault, double errorMm,
                      double bytes, double elements, double found);

// Smallest squared distance [m^2] of a point to `count` others; only whole blocks of 16 are tested. The same
// loop for each number type, compiled for several instruction sets.
float nearestSquared(const float* x, const float* y, const float* z, size_t count, float cx, float cy,
                     float cz) noexcept;
double nearestSquared(const double* x, const double* y, const double* z, size_t count, double cx, double cy,
                      double cz) noexcept;

} // namespace fathom::profile
