// SPDX-License-Identifier: Apache-2.0
// The parts of the precision study: what is stored or computed in half, single and double. Each gives rows of
// largest error [mm] against CPU time of the same loop; the first of each source is the double result, whose
// error is 0. Each throws Error when an error is larger than the format explains.
#pragma once

#include "apps/profile/study.h"

#include <functional>
#include <vector>

namespace fathom::profile {

// A row whose times are not taken yet, and its loop, which owns what it works on.
struct PrecisionLoop {
    StudyRow row;
    std::function<void()> run;
};

// Distances of leaves to the nearest of many region spheres, over the format of the spheres' centres.
std::vector<PrecisionLoop> centreRows(const StudyContext& context);
// Nodes of the region tree, culled by the leaves: how much a node grows, over its format. Rounded outwards,
// so that no sphere ever leaves its node.
std::vector<PrecisionLoop> nodeRows(const StudyContext& context);
// Depth pixels, made into points: how far a point lies off, over what the pixel is stored in.
std::vector<PrecisionLoop> depthRows(const StudyContext& context);
// The bilateral filter, 5x5: error of the filtered depth, over what its weights and sums are computed in.
std::vector<PrecisionLoop> weightRows(const StudyContext& context);
// Gaps of leaf-sphere pairs as the haptic tick takes them, over what they are computed in.
std::vector<PrecisionLoop> gapRows(const StudyContext& context);

// One row of them. bytes: of an element; elements: how many the loop goes over; found NaN when nothing is
// looked for.
StudyRow precisionRow(const std::string& source, const std::string& setting, bool isDefault, double errorMm,
                      double bytes, double elements, double found);

// Smallest squared distance [m^2] of a point to `count` others, of which only whole runs of 16 are looked at:
// the same loop for each kind of number, compiled for several instruction sets.
float nearestSquared(const float* x, const float* y, const float* z, size_t count, float cx, float cy,
                     float cz) noexcept;
double nearestSquared(const double* x, const double* y, const double* z, size_t count, double cx, double cy,
                      double cz) noexcept;

} // namespace fathom::profile
