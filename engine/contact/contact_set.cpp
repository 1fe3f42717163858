// SPDX-License-Identifier: Apache-2.0
#include "engine/contact/contact_set.h"

namespace fathom {

void ContactSet::reserve(size_t leaves, size_t spheres, size_t pairs) {
    for (std::vector<double>* column : {&x, &y, &z, &radius}) {
        column->reserve(spheres);
    }
    source.reserve(spheres);
    fixture.reserve(spheres);
    pairBegin.reserve(leaves + 1);
    pairBandEnd.reserve(leaves * kGapBands);
    leafAtQuery.reserve(leaves);
    behind.reserve(leaves);
    pairSphere.reserve(pairs);
    for (std::vector<float>* column : {&pairX, &pairY, &pairZ, &pairRadius}) {
        column->reserve(pairs);
    }
}

void ContactSet::clear() noexcept {
    for (std::vector<double>* column : {&x, &y, &z, &radius}) {
        column->clear();
    }
    source.clear();
    fixture.clear();
    pairBegin.clear();
    pairBandEnd.clear();
    leafAtQuery.clear();
    behind.clear();
    pairSphere.clear();
    for (std::vector<float>* column : {&pairX, &pairY, &pairZ, &pairRadius}) {
        column->clear();
    }
}

} // namespace fathom
