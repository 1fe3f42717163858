// SPDX-License-Identifier: Apache-2.0
#include "engine/contact/contact_set.h"

namespace fathom {

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

void ContactSet::leavesBehind(std::vector<uint32_t>& out) const {
    out.clear();
    for (const Behind& b : behind) {
        out.push_back(b.leaf);
    }
}

} // namespace fathom
