// SPDX-License-Identifier: Apache-2.0
// A hand with non-finite samples.

#include <doctest/doctest.h>
#include <limits>

#include "tests/realtime/fake_scene.h"
#include "tests/realtime/listening.h"

using namespace fathom;
using namespace fathom::testing;

TEST_CASE("A hand with non-finite samples gets no force in those ticks, the log reports it once, and the "
          "force returns") {
    enum class Broken { Nothing, Position, Rotation };
    for (const Broken broken : {Broken::Position, Broken::Rotation, Broken::Nothing}) {
        CAPTURE(static_cast<int>(broken));
        FakeRun fake(45, pressingPath(1.5));
        fake.hand.spoil = [broken](double t, HandSample& sample) {
            if (t > 0.4 && t < 1.0 && broken != Broken::Nothing) {
                double& number = broken == Broken::Position ? sample.deviceThandle.position.x
                                                            : sample.deviceThandle.rotation.y;
                number = std::numeric_limits<double>::quiet_NaN();
            }
        };
        const Listening log;
        fake.go();
        size_t ticks = 0;
        double before = 0.0, after = 0.0;
        for (const TickRow& row : fake.sink.rows) {
            if (!row.record.finite) {
                ++ticks;
                CHECK(forceOf(row.record) == 0.0);
            }
            (row.record.t < 0.4 ? before : after) = forceOf(row.record);
        }
        CHECK((ticks > 0) == (broken != Broken::Nothing));
        CHECK(log.count("the hand's sample is not finite: no force in such ticks") ==
              (broken != Broken::Nothing ? 1 : 0));
        CHECK(before > 5.0);
        CHECK(after == doctest::Approx(before).epsilon(0.2)); // the wall moves by 0.5 mm
        CHECK(fake.sink.audit.maxPenetration() <= 1e-5);
    }
}
