// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/contact/contact_set.h"

#include <doctest/doctest.h>

namespace fathom::testing {

// Two answers to one question are equal to the last bit: every field except `query` and `askedAt`, which
// identify the question.
inline void checkSameContacts(const ContactSet& a, const ContactSet& b) {
    CHECK(a.frame == b.frame);
    CHECK(a.generation == b.generation);
    CHECK(a.captureTime == b.captureTime);
    CHECK(a.reach == b.reach);
    CHECK(a.origin == b.origin);
    CHECK(a.camera == b.camera);
    CHECK(a.x == b.x);
    CHECK(a.y == b.y);
    CHECK(a.z == b.z);
    CHECK(a.radius == b.radius);
    CHECK(a.source == b.source);
    CHECK(a.fixture == b.fixture);
    CHECK(a.pairBegin == b.pairBegin);
    CHECK(a.pairSphere == b.pairSphere);
    CHECK(a.pairBandEnd == b.pairBandEnd);
    CHECK(a.leafAtQuery.x == b.leafAtQuery.x);
    CHECK(a.leafAtQuery.y == b.leafAtQuery.y);
    CHECK(a.leafAtQuery.z == b.leafAtQuery.z);
    CHECK(a.pairX == b.pairX);
    CHECK(a.pairY == b.pairY);
    CHECK(a.pairZ == b.pairZ);
    CHECK(a.pairRadius == b.pairRadius);
    REQUIRE(a.behind.size() == b.behind.size());
    for (size_t i = 0; i < a.behind.size(); ++i) {
        CHECK(a.behind[i].leaf == b.behind[i].leaf);
        CHECK(a.behind[i].towardsCamera == b.behind[i].towardsCamera);
        CHECK(a.behind[i].distance == b.behind[i].distance);
    }
}

} // namespace fathom::testing
