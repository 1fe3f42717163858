// SPDX-License-Identifier: Apache-2.0
// What is said of a hand that gives numbers that are none.
#include "apps/binding/realtime_run.h"

#include <doctest/doctest.h>
#include <limits>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>
#include <sstream>

#include "tests/realtime/fake_scene.h"

using namespace fathom;
using namespace fathom::testing;

namespace {

// What is logged while this lives.
class Listening {
public:
    Listening()
        : before_(spdlog::default_logger()) {
        auto sink = std::make_shared<spdlog::sinks::ostream_sink_mt>(text_);
        spdlog::set_default_logger(std::make_shared<spdlog::logger>("test", sink));
    }
    Listening(const Listening&) = delete;
    Listening& operator=(const Listening&) = delete;
    ~Listening() { spdlog::set_default_logger(before_); }

    size_t count(const std::string& part) const {
        size_t found = 0;
        const std::string text = text_.str();
        for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
            ++found;
        }
        return found;
    }

private:
    std::ostringstream text_;
    std::shared_ptr<spdlog::logger> before_;
};

} // namespace

TEST_CASE(
    "A hand whose numbers are none has no force in those turns, and that is said once, when it begins") {
    for (const bool broken : {true, false}) {
        FakeRun fake(45, pressingPath(1.5));
        if (broken) {
            fake.hand.spoil = [](double t, HandSample& sample) {
                if (t > 0.4 && t < 1.0) {
                    sample.deviceThandle.position.x = std::numeric_limits<double>::quiet_NaN();
                }
            };
        }
        const Listening log;
        fake.go();
        size_t turns = 0;
        for (const TurnRow& row : fake.sink.rows) {
            if (!row.record.finite) {
                ++turns;
                CHECK(forceOf(row.record) == 0.0);
            }
        }
        CHECK((turns > 0) == broken);
        CHECK(log.count("the hand's sample is not finite: no force in such turns") == (broken ? 1 : 0));
    }
}
