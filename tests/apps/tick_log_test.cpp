// SPDX-License-Identifier: Apache-2.0
// The ticks of a recording, written and read.
#include "apps/operate/tick_log.h"

#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

#include <cmath>
#include <doctest/doctest.h>
#include <iomanip>

using namespace fathom;
using namespace fathom::operate;
using namespace fathom::testing;

namespace {

StepRecord step(double seed, uint32_t touches) {
    StepRecord r;
    r.wrench = {dvec3(seed, -seed, 0.1), dvec3(0.01 * seed, 0.0, -1e-9)};
    r.residual = {dvec3(0.0), dvec3(0.01 * seed, 0.0, -1e-9)};
    r.contactCount = touches;
    r.state = touches > 0 ? StepState::Contact : StepState::Free;
    r.guidance = 0.25;
    r.guidanceClass = touches > 1 ? 1 : -1;
    r.sceneAge = 0.033;
    r.device = {dvec3(1e3 + seed, 0.2, 0.3), glm::normalize(dquat(1.0, seed, 0.2, -0.1))};
    r.tool = {dvec3(1e3 + seed, 0.2, 0.29), dquat(1.0, 0.0, 0.0, 0.0)};
    r.arm.posture.q = {0.1, -seed, 0, 0, 0, 0, 7};
    r.arm.posture.grasp = 0.5;
    r.touchCount = touches;
    for (uint32_t i = 0; i < touches; ++i) {
        r.touches[i].kind = ContactRow::Kind::Behind;
        r.touches[i].point = dvec3(seed, i, 0.0);
        r.touches[i].normal = dvec3(0, 0, -1);
        r.touches[i].leaf = i;
        r.touches[i].source = 4000000000u + i;
        r.touches[i].fixture = 2;
        r.touches[i].multiplier = 3.5;
    }
    return r;
}

void write(const std::filesystem::path& folder, const std::vector<uint32_t>& touches) {
    std::ofstream wrench(folder / kWrenchFile), touched(folder / kTouchesFile);
    wrench << std::setprecision(17) << wrenchHeader() << "\n";
    touched << std::setprecision(17) << touchesHeader() << "\n";
    for (size_t i = 0; i < touches.size(); ++i) {
        writeTick(wrench, touched, 0.1 * static_cast<double>(i), static_cast<int64_t>(i) - 1,
                  step(0.3 + static_cast<double>(i), touches[i]));
    }
}

std::string refusal(const std::filesystem::path& folder) {
    return refusalOf([&] { readTickLog(folder); });
}

} // namespace

TEST_CASE("Ticks are read back exactly, with no touch, one or eight") {
    const ScratchFolder folder;
    const std::vector<uint32_t> touches{0, 1, 8, 0, 2, 8, 0};
    write(folder.path(), touches);
    const TickLog log = readTickLog(folder.path());
    REQUIRE(log.ticks.size() == touches.size());
    CHECK(log.poses);
    for (size_t i = 0; i < touches.size(); ++i) {
        CAPTURE(i);
        const StepRecord wrote = step(0.3 + static_cast<double>(i), touches[i]), read = log.recordAt(i);
        CHECK(read.t == 0.1 * static_cast<double>(i));
        CHECK(read.frame == static_cast<int64_t>(i) - 1);
        CHECK(read.wrench.force == wrote.wrench.force);
        CHECK(read.wrench.torque == wrote.wrench.torque);
        CHECK(read.residual.force == wrote.residual.force);
        CHECK(read.residual.torque == wrote.residual.torque);
        CHECK(read.contactCount == wrote.contactCount);
        CHECK(read.state == wrote.state);
        CHECK(read.guidanceClass == wrote.guidanceClass);
        CHECK(read.sceneAge == wrote.sceneAge);
        CHECK(std::isnan(read.marginPassive));
        CHECK(read.device.position == wrote.device.position);
        CHECK(std::abs(glm::dot(read.device.rotation, wrote.device.rotation)) == doctest::Approx(1.0));
        CHECK(read.tool.position == wrote.tool.position);
        CHECK(read.arm.posture.q == wrote.arm.posture.q);
        CHECK(read.arm.posture.grasp == 0.5);
        REQUIRE(read.touchCount == touches[i]);
        for (uint32_t k = 0; k < read.touchCount; ++k) {
            CHECK(read.touches[k].point == wrote.touches[k].point);
            CHECK(read.touches[k].source == wrote.touches[k].source);
            CHECK(read.touches[k].kind == wrote.touches[k].kind);
        }
    }
}

TEST_CASE("A folder without ticks is empty, and an old recording is read without poses") {
    const ScratchFolder folder;
    CHECK(readTickLog(folder.path()).ticks.empty());
    put(folder.path() / kWrenchFile, "t_s,fx,fy,fz,tx,ty,tz,contacts,state\n0.5,1,2,3,0,0,0,2,2\n");
    const TickLog log = readTickLog(folder.path());
    REQUIRE(log.ticks.size() == 1);
    CHECK_FALSE(log.poses);
    CHECK(log.recordAt(0).wrench.force == dvec3(1, 2, 3));
    CHECK(log.recordAt(0).state == StepState::Contact);
    CHECK(std::isnan(log.recordAt(0).residual.force.x));
}

TEST_CASE("A row of a recording has the hand's buttons of its own time, not of the shown moment") {
    const ScratchFolder folder;
    write(folder.path(), {0, 0, 0}); // 0, 0.1 and 0.2 s
    const TickLog log = readTickLog(folder.path());
    const HandPath hand({{0.0, {}, 0}, {0.1, {}, kDeadManOpen}, {0.2, {}, kGuidanceButton}});
    CHECK(log.rowAt(0, &hand).hand.buttons == 0);
    CHECK(log.rowAt(1, &hand).hand.buttons == kDeadManOpen);
    CHECK(log.rowAt(2, &hand).hand.buttons == kGuidanceButton);
    CHECK(log.rowAt(1, nullptr).hand.buttons == 0); // not known
    CHECK(log.rowAt(1, &hand).record.t == log.ticks[1].t);
}

TEST_CASE("A recording from before the columns of the residual is read without it") {
    const ScratchFolder folder;
    write(folder.path(), {1});
    std::ifstream in(folder.path() / kWrenchFile);
    std::string head, row;
    std::getline(in, head);
    std::getline(in, row);
    const auto without = [](std::string line) {
        for (int i = 0; i < 6; ++i) {
            line.erase(line.rfind(','));
        }
        return line + "\n";
    };
    CHECK(without(head).ends_with(",q12\n"));
    put(folder.path() / kWrenchFile, without(head) + without(row));
    const StepRecord read = readTickLog(folder.path()).recordAt(0);
    CHECK(read.wrench.force == step(0.3, 1).wrench.force);
    CHECK(read.arm.posture.q == step(0.3, 1).arm.posture.q);
    CHECK(std::isnan(read.residual.torque.z));
}

TEST_CASE("Damaged ticks are rejected with line and column") {
    const ScratchFolder folder;
    const auto file = folder.path() / kWrenchFile;
    const std::string head = "t_s,fx,fy,fz,tx,ty,tz,contacts,state\n";
    put(file, "t_s,fx\n0,0\n");
    CHECK(refusal(folder.path()).find("line 1") != std::string::npos);
    put(file, head + "0,0,0,0,0,0,0,0,0\n0,0,0,0,0,0,0,0,0\n");
    CHECK(refusal(folder.path()).find("line 3, t_s: '0.000000' (allowed: later") != std::string::npos);
    put(file, head + "0,0,0,0,0,0,0,0,7\n");
    CHECK(refusal(folder.path()).find("line 2, column 9") != std::string::npos);
    put(file, head + "0,0,0,0,0,0,0,-1,0\n");
    CHECK(refusal(folder.path()).find("line 2, column 8") != std::string::npos);
    put(file, head + "nan,0,0,0,0,0,0,0,0\n");
    CHECK(refusal(folder.path()).find("line 2, t_s") != std::string::npos);
    put(file, head + "0,0,0\n");
    CHECK(refusal(folder.path()).find("3 fields") != std::string::npos);
    put(file, head + std::string(2049, '7') + "\n");
    CHECK(refusal(folder.path()).find("line 2") != std::string::npos);
    CHECK(refusal(folder.path()).find("2048 characters at most") != std::string::npos);
    write(folder.path(), {1, 1});
    put(folder.path() / kTouchesFile, std::string(touchesHeader()) + "\n0.05,0,0,0,0,0,0,0,0,0,0,0,0\n");
    CHECK(refusal(folder.path()).find("touches.csv: line 2, t_s") != std::string::npos);
}

TEST_CASE("Of a recording with more ticks than are shown, the first ones are read with their touches") {
    const ScratchFolder folder;
    write(folder.path(), {1, 0, 2, 8, 1});
    const TickLog all = readTickLog(folder.path(), 5), first = readTickLog(folder.path(), 3);
    CHECK_FALSE(all.cut);
    CHECK(first.cut);
    REQUIRE(first.ticks.size() == 3);
    CHECK(first.touches.size() == 3);
    CHECK(first.recordAt(2).touchCount == 2);
    CHECK(readTickLog(folder.path(), 2).touches.size() == 1);
}
