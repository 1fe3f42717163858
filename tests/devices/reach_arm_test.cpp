// SPDX-License-Identifier: Apache-2.0
// The driver of Reach arms against a simulated arm on a pseudo-terminal, on good lines and bad ones.
#include "devices/serial/reach_arm.h"
#include "tests/devices/driver_rig.h"
#include "tests/support/refusal.h"

#include <cmath>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

struct Rig : DriverRig<ReachSimulator, ReachArm> {
    ReachKind kind;

    explicit Rig(const ReachOptions& options = {}, ReachKind is = ReachKind::Alpha5)
        : DriverRig(0.01, ReachSimulator(is), options, is)
        , kind(is) {}

    // Of what was commanded, in the line's units [rad], jaws [mm].
    double error(const ArmCommand& command) const {
        const size_t axes = kind == ReachKind::Alpha5 ? 5 : 7;
        double worst = 0.0;
        for (size_t k = 0; k < axes; ++k) {
            const double wanted = command.position[k] * (k + 1 == axes ? 1e3 : 1.0);
            worst = std::max(worst, std::abs(arm.position[axes - k] - wanted));
        }
        return worst;
    }
};

const ArmCommand kGo{{0.3, -0.2, 0.4, 0.1, 0.01}, false};
const ArmCommand kBravoGo{{0.3, -0.2, 0.4, 0.1, -0.3, 0.2, 0.01}, false};
const ArmCommand kHold{{9.0, 9.0, 9.0, 9.0, 9.0}, true};

} // namespace

TEST_CASE("A Reach arm follows setpoints and reports its position") {
    Rig rig;
    CHECK(rig.driver.feedback().stale);
    rig.run(2.0, kGo);
    CHECK(rig.error(kGo) < 1e-5);
    const ArmFeedback& f = rig.driver.feedback();
    CHECK_FALSE(f.stale);
    CHECK_FALSE(f.holding);
    CHECK(f.homed);
    CHECK(f.damaged == 0);
    for (size_t k = 0; k < 5; ++k) {
        CHECK(f.position[k] == doctest::Approx(kGo.position[k]).epsilon(1e-4));
    }
}

TEST_CASE("A Bravo 7 follows its seven axes, on bad lines, too, and an Alpha 5 does not answer for one") {
    for (const LineFaults& faults : {LineFaults{}, LineFaults{0.003, 0.003, true, 0.02, false}}) {
        Rig rig({}, ReachKind::Bravo7);
        rig.line.faults = faults;
        rig.run(faults.echo ? 4.0 : 2.0, kBravoGo);
        CHECK(rig.error(kBravoGo) < 1e-4);
        const ArmFeedback& f = rig.driver.feedback();
        for (size_t k = 0; k < 7; ++k) {
            CHECK(f.position[k] == doctest::Approx(kBravoGo.position[k]).epsilon(1e-3));
        }
    }
    Rig mixed({}, ReachKind::Bravo7);
    mixed.arm = ReachSimulator(ReachKind::Alpha5);
    mixed.run(1.0, kBravoGo);
    CHECK(mixed.driver.feedback().stale); // axes f and g never answer
    CHECK(mixed.driver.feedback().holding);
    CHECK(mixed.arm.position == ReachSimulator().position);
}

TEST_CASE("Commands and answers of a Reach arm fit on a half-duplex line of 115200 baud") {
    for (const ReachKind kind : {ReachKind::Alpha5, ReachKind::Bravo7}) {
        Rig rig({}, kind);
        rig.run(2.0, kind == ReachKind::Alpha5 ? kGo : kBravoGo);
        CAPTURE(rig.line.carried);
        CHECK(static_cast<double>(rig.line.carried) / 2.0 < 0.85 * 11520.0); // bytes/s, ten bits each
    }
}

TEST_CASE("Noise, lost bytes, echo and late answers slow a Reach arm but never misdirect it") {
    for (const LineFaults& faults :
         {LineFaults{0.004, 0.0, false, 0.0, false}, LineFaults{0.0, 0.004, false, 0.0, false},
          LineFaults{0.0, 0.0, true, 0.0, false}, LineFaults{0.0, 0.0, false, 0.03, false},
          LineFaults{0.003, 0.003, true, 0.02, false}}) {
        Rig rig;
        rig.line.faults = faults;
        double farthest = 0.0;
        for (int i = 0; i < 40; ++i) {
            rig.run(0.1, kGo);
            for (double q : rig.arm.position) {
                farthest = std::max(farthest, std::abs(q));
            }
        }
        CAPTURE(faults.noise);
        CAPTURE(faults.loss);
        CAPTURE(faults.echo);
        CHECK(rig.error(kGo) < 1e-4);
        CHECK(farthest < 10.0 + 1e-3); // the jaws' 10 mm are the farthest of all
        CHECK((rig.driver.feedback().damaged > 0) == (faults.noise > 0.0 || faults.loss > 0.0));
    }
}

TEST_CASE("Feedback of a Reach arm at rest on its setpoint is never mistaken for echo") {
    for (const bool echo : {false, true}) {
        CAPTURE(echo);
        Rig rig;
        rig.line.faults.echo = echo;
        rig.run(0.5, kGo);
        int stale = 0, held = 0;
        double oldest = 0.0;
        for (int i = 0; i < 200; ++i) {
            rig.run(0.01, kGo);
            const ArmFeedback& f = rig.driver.feedback();
            stale += f.stale ? 1 : 0;
            held += f.holding ? 1 : 0;
            oldest = std::max(oldest, f.age);
        }
        CHECK(rig.error(kGo) < 1e-5); // it did rest
        CHECK(stale == 0);
        CHECK(held == 0);
        CHECK(oldest < 0.045); // two periods of 20 ms and a step
    }
}

TEST_CASE("On hold a Reach arm does not move, and its echo is not taken for feedback") {
    Rig rig;
    rig.line.faults.echo = true;
    rig.run(0.5, kGo);
    const auto held = rig.arm.position;
    rig.run(0.05, kHold);
    const auto there = rig.arm.position;
    rig.run(0.5, kHold);
    CHECK(rig.arm.position == there);
    for (size_t d = 1; d < 6; ++d) {
        CHECK(std::abs(there[d] - held[d]) < (d == 1 ? 1.0 : 0.06)); // it stopped within its lead
    }
    CHECK(rig.driver.feedback().holding);

    Rig deaf; // nothing but its own positions comes back
    deaf.line.faults.echo = true;
    deaf.run(0.1, kGo);
    REQUIRE_FALSE(deaf.driver.feedback().stale);
    deaf.line.faults.deaf = true;
    deaf.run(0.3, kGo);
    CHECK(deaf.driver.feedback().stale);
    CHECK(deaf.driver.feedback().holding);
}

TEST_CASE(
    "A cut line makes feedback stale; the arm stops within its lead and resumes when the line is back") {
    Rig rig;
    rig.run(0.2, kGo);
    REQUIRE_FALSE(rig.driver.feedback().stale);
    const double before = rig.arm.position[5];
    rig.line.faults.cut = true;
    rig.run(0.25, kGo);
    CHECK(rig.driver.feedback().stale);
    CHECK(rig.driver.feedback().holding);
    CHECK(rig.driver.feedback().age > 0.1);
    const double stopped = rig.arm.position[5];
    CHECK(stopped - before < 0.05 + 0.02);
    rig.run(1.0, kGo);
    CHECK(rig.arm.position[5] == stopped);
    rig.line.faults.cut = false;
    rig.run(2.0, kGo);
    CHECK_FALSE(rig.driver.feedback().stale);
    CHECK(rig.error(kGo) < 1e-4);
}

TEST_CASE("Sustained overcurrent holds the arm until it is reset") {
    Rig rig;
    rig.run(0.2, kGo);
    rig.arm.current[3] = 2000.0; // [mA] of 1500
    rig.run(0.05, kGo);
    CHECK_FALSE(rig.driver.feedback().overloaded); // a peak is none
    rig.run(0.3, kGo);
    CHECK(rig.driver.feedback().overloaded);
    CHECK(rig.driver.feedback().current[2] == doctest::Approx(2.0));
    const auto there = rig.arm.position;
    rig.arm.current[3] = 100.0;
    rig.run(0.3, kGo);
    CHECK(rig.driver.feedback().overloaded);
    CHECK(rig.arm.position == there);
    rig.driver.reset();
    rig.run(2.0, kGo);
    CHECK(rig.error(kGo) < 1e-4);
}

TEST_CASE("A Reach arm that does not report the current of each motor is held") {
    Rig never;
    never.arm.current.fill(std::nan(""));
    never.run(1.0, kGo);
    CHECK(never.driver.feedback().holding);
    CHECK(never.driver.feedback().lacksCurrent == 0);
    CHECK(never.arm.position == ReachSimulator().position); // it never moved
    Rig rig;
    rig.run(0.2, kGo);
    REQUIRE_FALSE(rig.driver.feedback().holding);
    rig.arm.current[3] = std::nan(""); // the elbow's answer gets lost from now on
    rig.run(1.1, kGo);
    CHECK(rig.driver.feedback().holding);
    CHECK(rig.driver.feedback().lacksCurrent == 2);
    CHECK(rig.driver.feedback().age < 0.1); // its position comes
    rig.arm.current[3] = 100.0;
    rig.run(2.0, kGo);
    CHECK(rig.driver.feedback().lacksCurrent == -1);
    CHECK(rig.error(kGo) < 1e-4);
}

TEST_CASE("A file that is not a serial port is rejected in one line") {
    const auto refusal = [](const std::string& name, uint32_t baud) -> std::string {
        return refusalOf([&] { SerialPort port(name, baud); });
    };
    CHECK(refusal("/dev/no_such_line", 115200).find("No such file") != std::string::npos);
    CHECK(refusal("/dev/null", 115200).find("a terminal device") != std::string::npos);
    CHECK(refusal("/dev/null", 1234).find("115200") != std::string::npos);
    Rig rig;
    CHECK_NOTHROW(
        SerialPort(rig.line.name(), 115200, true)); // no direction control there: logged, and no error
}
