// SPDX-License-Identifier: Apache-2.0
#include "engine/types/retry_pause.h"

#include <doctest/doctest.h>

namespace fathom {
namespace {

TEST_CASE("Pauses between attempts double up to two seconds, and begin again after a reset") {
    RetryPause pause;
    for (const double expected : {0.1, 0.2, 0.4, 0.8, 1.6, 2.0, 2.0}) {
        CHECK(pause.next() == expected);
    }
    pause.reset();
    CHECK(pause.next() == 0.1);
}

} // namespace
} // namespace fathom
