// SPDX-License-Identifier: Apache-2.0
// Frames and driver of the ECA 5E Micro against a simulated arm on a pseudo-terminal.
#include "devices/serial/eca_arm.h"
#include "tests/devices/driver_rig.h"

#include <cmath>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

struct Rig : DriverRig<EcaSimulator, EcaArm> {
    static EcaOptions options() {
        EcaOptions o;
        o.stop = {-0.5, -0.4, -0.3, -0.6, -0.1};
        o.homingSpeed = 0.4;
        return o;
    }
    Rig()
        : DriverRig(0.025, {}, options()) {
        arm.lower = options().stop;
        arm.upper = {1.0, 1.0, 1.0, 1.0, 1.0};
        arm.angle = {0.0, 0.1, 0.05, -0.1, 0.02};
        arm.firstCount = {65000, 5, 32768, 0, 65535}; // they wrap on the way
    }
    double error(const ArmCommand& command) const {
        double worst = 0.0;
        for (size_t j = 0; j < kEcaJoints; ++j) {
            worst = std::max(worst, std::abs(arm.angle[j] - command.position[j]));
        }
        return worst;
    }
};

const ArmCommand kGo{{0.4, 0.3, -0.1, 0.5, 0.2}, false};
const ArmCommand kHold{{}, true};

} // namespace

TEST_CASE("An ECA hold frame has the published checksum, and frames survive a round trip") {
    std::array<EcaDemand, kEcaJoints> demands;
    const EcaBytes hold = encodeEca(demands);
    CHECK(hold[0] == 0xE7);
    CHECK(hold[49] == 0x73);
    CHECK(hold[50] == 0xE5);
    demands[3] = {EcaDemand::Kind::SpeedCcw, 0x0123, 0x0456, 0x0789};
    const EcaBytes frame = encodeEca(demands);
    CHECK(frame[4 + 27 + 2] == 0x01); // big-endian
    CHECK(frame[4 + 27 + 3] == 0x23);
    CHECK(demandsOf(frame)[3].currentLimit == 0x0789);
    std::array<EcaStatus, kEcaJoints> status;
    status[4] = {0xABCD, 0x0102, 77, 12};
    const EcaBytes answer = encodeEca(status);
    CHECK(answer[4 + 36 + 1] == 0xCD); // little-endian
    CHECK(statusOf(answer)[4].encoder == 0xABCD);
    CHECK(statusOf(answer)[4].current == 77);
}

TEST_CASE("A reader finds every complete frame after noise, partial frames and false starts") {
    std::mt19937_64 random(4);
    EcaReader reader;
    size_t found = 0;
    for (int i = 0; i < 200; ++i) {
        std::array<EcaDemand, kEcaJoints> demands;
        demands[0].speed = static_cast<uint16_t>(i);
        const EcaBytes frame = encodeEca(demands);
        std::vector<uint8_t> bytes(frame.begin(),
                                   frame.begin() + static_cast<std::ptrdiff_t>(random() % 30)); // broken off
        bytes.push_back(0xE7);
        bytes.insert(bytes.end(), frame.begin(), frame.end());
        for (uint8_t byte : bytes) {
            if (const auto got = reader.take(byte)) {
                CHECK(*got == frame);
                ++found;
            }
        }
    }
    CHECK(found == 200);
    CHECK(reader.damaged() > 100);
    EcaBytes wrong = encodeEca(std::array<EcaDemand, kEcaJoints>{});
    wrong[20] ^= 1;
    for (uint8_t byte : wrong) {
        CHECK_FALSE(reader.take(byte).has_value());
    }
}

TEST_CASE("Joints with relative encoders are homed against their stops and then follow commands") {
    Rig rig;
    rig.run(1.0, kHold);
    CHECK_FALSE(rig.driver.feedback().homed);
    CHECK(rig.arm.angle[0] == 0.0); // nothing moves on hold
    rig.run(12.0, kGo);
    CHECK(rig.driver.feedback().homed);
    CHECK_FALSE(rig.driver.feedback().holding);
    CHECK(rig.error(kGo) < 2e-3); // one count of the wrist
    for (size_t j = 0; j < kEcaJoints; ++j) {
        CHECK(rig.driver.feedback().position[j] == doctest::Approx(rig.arm.angle[j]).epsilon(0.01));
    }
}

TEST_CASE(
    "Noise, lost bytes, echo and late answers are tolerated; a cut line is reported and the driver holds") {
    Rig rig;
    rig.line.faults = {0.0005, 0.0005, true, 0.02, false};
    rig.run(20.0, kGo);
    CHECK(rig.driver.feedback().homed);
    CHECK(rig.driver.feedback().damaged > 0);
    CHECK(rig.error(kGo) < 1e-2);
    rig.line.faults.cut = true;
    rig.run(1.0, kGo);
    CHECK(rig.driver.feedback().stale);
    CHECK(rig.driver.feedback().holding);
}

TEST_CASE("An encoder jump means a restart: the arm is homed again") {
    Rig rig;
    rig.run(12.0, kGo);
    REQUIRE(rig.driver.feedback().homed);
    rig.arm.firstCount[1] = static_cast<uint16_t>(rig.arm.firstCount[1] + 20000);
    rig.run(0.2, kGo);
    CHECK_FALSE(rig.driver.feedback().homed);
    rig.run(20.0, kGo);
    CHECK(rig.driver.feedback().homed);
    CHECK(rig.error(kGo) < 2e-3);
}

TEST_CASE("An ECA arm that restarts during a silence is homed again, however near its counters begin") {
    Rig rig;
    rig.run(12.0, kGo);
    REQUIRE(rig.driver.feedback().homed);
    rig.line.faults.cut = true;
    rig.run(1.0, kHold);
    rig.line.faults.cut = false;
    rig.run(0.2, kHold);
    CHECK(rig.driver.feedback().homed); // it stood still
    rig.line.faults.cut = true;
    rig.run(1.0, kHold);
    const std::array<int, kEcaJoints> since{3000, -5000, 2000, 2500, 4000}; // counts since it was switched on
    for (size_t j = 0; j < kEcaJoints; ++j) {
        rig.arm.firstCount[j] = static_cast<uint16_t>(rig.arm.firstCount[j] - since[j]);
    }
    rig.line.faults.cut = false;
    rig.run(0.2, kHold);
    CHECK_FALSE(rig.driver.feedback().homed);
    rig.run(20.0, kGo);
    CHECK(rig.driver.feedback().homed);
    CHECK(rig.error(kGo) < 2e-3);
}

TEST_CASE("A joint of an ECA arm with few counts per turn loses its home by a jump, too") {
    for (const auto& [which, counts] :
         {std::pair(3, 60), std::pair(4, 400)}) { // wrist, gripper: 7 and 6 degrees
        const int joint = which;                  // CAPTURE needs a variable
        CAPTURE(joint);
        Rig rig;
        rig.run(12.0, kGo);
        REQUIRE(rig.driver.feedback().homed);
        rig.arm.firstCount[joint] = static_cast<uint16_t>(rig.arm.firstCount[joint] + counts);
        rig.run(0.1, kGo);
        CHECK_FALSE(rig.driver.feedback().homed);
    }
}

TEST_CASE("A blocked joint of an ECA arm is held before its motor overheats") {
    Rig rig;
    rig.run(12.0, kGo);
    rig.arm.pressing = 230;
    rig.arm.upper[0] = rig.arm.angle[0]; // something is in the way
    ArmCommand farther = kGo;
    farther.position[0] += 0.2;
    rig.run(1.0, farther);
    CHECK(rig.driver.feedback().overloaded);
    CHECK(rig.driver.feedback().holding);
}
