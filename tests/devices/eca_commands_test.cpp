// SPDX-License-Identifier: Apache-2.0
// What the driver of the ECA 5E Micro commands when something is wrong.
#include "devices/serial/eca_arm.h"
#include "tests/devices/driver_rig.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

// Keeps the newest commands that it received, and answers only while not mute.
struct ListeningArm : EcaSimulator {
    EcaReader frames;
    std::array<EcaDemand, kEcaJoints> demands{};
    bool mute = false;

    void receive(std::span<const uint8_t> bytes, std::vector<uint8_t>& out) override {
        for (const uint8_t byte : bytes) {
            if (const auto frame = frames.take(byte)) {
                demands = demandsOf(*frame);
            }
        }
        std::vector<uint8_t> answers;
        EcaSimulator::receive(bytes, answers);
        if (!mute) {
            out.insert(out.end(), answers.begin(), answers.end());
        }
    }
    bool standsStill() const {
        return std::all_of(demands.begin(), demands.end(), [](const EcaDemand& d) { return d.speed == 0; });
    }
};

struct CommandRig : DriverRig<ListeningArm, EcaArm> {
    static EcaOptions options() {
        EcaOptions o;
        o.stop = {-0.5, -0.4, -0.3, -0.6, -0.1};
        o.homingSpeed = 0.4;
        o.currentLimit = 1234;
        return o;
    }
    CommandRig()
        : DriverRig(0.025, {}, options()) {
        arm.lower = options().stop;
        arm.upper.fill(1.0);
    }
};

const ArmCommand kThere{{0.4, 0.3, -0.1, 0.5, 0.2}, false};
const ArmCommand kStay{{}, true};

} // namespace

TEST_CASE("An ECA arm that does not answer is commanded to stand still, also while it is homed") {
    for (const double before : {0.5, 12.0}) {
        CommandRig rig;
        rig.run(before, kThere);
        ArmCommand farther = kThere;
        farther.position[0] = 0.9;
        rig.run(0.2, farther);
        CHECK_FALSE(rig.arm.standsStill());
        rig.arm.mute = true;
        rig.run(0.4, farther);
        CHECK(rig.arm.standsStill());
        rig.arm.mute = false;
        rig.run(0.2, farther);
        CHECK_FALSE(rig.arm.standsStill());
    }
}

TEST_CASE("Every command of an ECA arm carries the current limit of the options") {
    CommandRig rig;
    for (const double seconds : {0.2, 12.0}) {
        rig.run(seconds, kThere);
        for (const EcaDemand& demand : rig.arm.demands) {
            CHECK(demand.currentLimit == 1234);
        }
    }
}

TEST_CASE("A joint of an ECA arm whose setpoint is not a number stands still, and the others follow") {
    CommandRig rig;
    rig.run(12.0, kThere);
    REQUIRE(rig.driver.feedback().homed);
    ArmCommand broken{{0.0, std::nan(""), 0.0, HUGE_VAL, 0.0}, false};
    const auto before = rig.arm.angle;
    rig.run(2.0, broken);
    CHECK(rig.arm.angle[0] == doctest::Approx(0.0).epsilon(2e-3));
    CHECK(rig.arm.angle[1] == doctest::Approx(before[1]).epsilon(2e-3));
    CHECK(rig.arm.angle[3] == doctest::Approx(before[3]).epsilon(2e-3));
}

TEST_CASE("A single reading of a high current is no stop while an ECA arm is homed") {
    CommandRig rig;
    rig.run(0.5, kThere);
    rig.arm.running = rig.arm.pressing;
    rig.run(0.05, kThere);
    rig.arm.running = 30;
    rig.run(14.0, kThere);
    REQUIRE(rig.driver.feedback().homed);
    for (size_t j = 0; j < kEcaJoints; ++j) {
        CHECK(std::abs(rig.arm.angle[j] - kThere.position[j]) < 2e-3);
    }
}

TEST_CASE("Each joint of an ECA arm loses its home when it alone moved a little during a silence") {
    for (size_t j = 0; j < kEcaJoints; ++j) {
        CAPTURE(j);
        CommandRig rig;
        rig.run(12.0, kThere);
        REQUIRE(rig.driver.feedback().homed);
        rig.arm.mute = true;
        rig.run(1.0, kStay);
        rig.arm.firstCount[j] =
            static_cast<uint16_t>(rig.arm.firstCount[j] + std::lround(0.05 / EcaArm::radiansPerCount(j)));
        rig.arm.mute = false;
        rig.run(0.2, kStay);
        CHECK_FALSE(rig.driver.feedback().homed);
    }
}
