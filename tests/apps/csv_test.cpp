// SPDX-License-Identifier: Apache-2.0
#include "apps/output/csv.h"

#include "apps/output/haptics_csv.h"
#include "apps/replay/frames_csv.h"
#include "tests/support/scratch_folder.h"

#include <bit>
#include <cmath>
#include <cstdlib>
#include <doctest/doctest.h>
#include <limits>
#include <sstream>

using namespace fathom;
using namespace fathom::testing;

namespace {

std::vector<std::string> split(const std::string& text, char mark) {
    std::vector<std::string> parts;
    std::stringstream stream(text);
    for (std::string part; std::getline(stream, part, mark);) {
        parts.push_back(part);
    }
    return parts;
}

StepRecord someTick() {
    StepRecord tick;
    tick.t = 0.1;
    tick.device = {{1, 2, 3}, {0.5, -0.5, 0.5, -0.5}};
    tick.tool = {{4, 5, 6}, {1, 0, 0, 0}};
    tick.wrench = {{7, 8, 9}, {10, 11, 12}};
    tick.contactCount = 13;
    tick.minGap = 14;
    tick.state = StepState::Escape;
    tick.guidance = 0.25;
    tick.frame = 16;
    tick.sceneAge = 17;
    tick.stalled = true;
    tick.marginPassive = 18;
    tick.marginUncoupled = 19;
    tick.cause = 20;
    tick.lag = 0.5;
    tick.deviceWrench = {{21, 22, 23}, {24, 25, 26}};
    tick.residual = {{27, 28, 29}, {30, 31, 32}};
    tick.clearance = 33;
    return tick;
}

} // namespace

TEST_CASE("17 significant digits restore every double, subnormal and largest ones included") {
    CsvRow row;
    uint64_t bits = 1;
    for (int i = 0; i < 20000; ++i) {
        bits = bits * 6364136223846793005u + 1442695040888963407u;
        const double value = std::bit_cast<double>(bits);
        row.add(value);
        const std::string text(row.end());
        if (std::isfinite(value)) {
            CHECK(std::bit_cast<uint64_t>(std::strtod(text.c_str(), nullptr)) == bits);
        }
    }
    for (const double value : {0.0, 0.1, 1.0, 5e-324, 1.7976931348623157e308}) {
        row.add(value);
        CHECK(std::strtod(std::string(row.end()).c_str(), nullptr) == value);
    }
    row.add(0.1);
    CHECK(row.end() == "0.10000000000000001\n");
}

TEST_CASE("A value that is not finite is written as nan, inf or -inf, nan without a sign") {
    CsvRow row;
    const double nan = std::numeric_limits<double>::quiet_NaN(),
                 inf = std::numeric_limits<double>::infinity();
    row.add(nan);
    row.add(std::copysign(nan, -1.0));
    row.add(inf);
    row.add(-inf);
    row.add(int64_t{-7});
    CHECK(row.end() == "nan,nan,inf,-inf,-7\n");
}

TEST_CASE("haptics.csv has the header of the contract and every column in its place") {
    const ScratchFolder folder;
    HapticsCsv csv(folder.path() / "haptics.csv");
    csv.add(someTick());
    StepRecord start;
    csv.add(start);
    csv.commit();
    const auto lines = split(textOf(folder.path() / "haptics.csv"), '\n');
    REQUIRE(lines.size() == 3);
    CHECK(lines[0] ==
          "t_s,dev_x,dev_y,dev_z,dev_qw,dev_qx,dev_qy,dev_qz,tool_x,tool_y,tool_z,tool_qw,tool_qx,"
          "tool_qy,tool_qz,fx,fy,fz,tx,ty,tz,contacts,min_gap_m,state,guidance,frame,scene_age_s,"
          "stalled,margin_passive,margin_uncoupled,cause,lag_m,out_fx,out_fy,out_fz,out_tx,out_ty,out_tz,"
          "rest_fx,rest_fy,rest_fz,rest_tx,rest_ty,rest_tz,clearance_m");
    CHECK(lines[1] ==
          "0.10000000000000001,1,2,3,0.5,-0.5,0.5,-0.5,4,5,6,1,0,0,0,7,8,9,10,11,12,13,14,escape,0.25,"
          "16,17,1,18,19,20,0.5,21,22,23,24,25,26,27,28,29,30,31,32,33");
    CHECK(lines[2] == "0,0,0,0,1,0,0,0,0,0,0,1,0,0,0,0,0,0,0,0,0,0,nan,off,0,-1,nan,0,nan,nan,0,0,0,0,0,0,0,"
                      "0,0,0,0,0,0,0,nan");
}

TEST_CASE("An empty run gives a header only") {
    const ScratchFolder folder;
    HapticsCsv(folder.path() / "h.csv").commit();
    FramesCsv(folder.path() / "f.csv", {}).file().commit();
    CHECK(split(textOf(folder.path() / "h.csv"), '\n').size() == 1);
    CHECK(textOf(folder.path() / "f.csv") ==
          "index,t_s,valid,forbidden_points,spheres,patches,nodes,guidance_count,upload_ms,publish_ms,"
          "answerable_ms\n");
}

TEST_CASE("frames.csv has one column per pass in the order of the plan, and nan for a missing time") {
    const ScratchFolder folder;
    FramesCsv csv(folder.path() / "f.csv", {"classify", "surface", "tree"});
    FrameReport frame;
    frame.index = 5;
    frame.counts.valid = 100, frame.counts.forbidden = 40;
    frame.counts.spheres = 30, frame.counts.patches = 7, frame.counts.nodes = 9;
    frame.guidanceCount = 11;
    frame.uploadMs = 0.25, frame.publishMs = 4.0, frame.answerableMs = 4.5;
    frame.passMs = {1.0, 3.0};
    csv.add(frame, 0.5);
    csv.file().commit();
    CHECK(textOf(folder.path() / "f.csv") ==
          "index,t_s,valid,forbidden_points,spheres,patches,nodes,"
          "guidance_count,upload_ms,classify_ms,surface_ms,"
          "tree_ms,publish_ms,answerable_ms\n5,0.5,100,40,30,7,9,11,0.25,1,3,nan,4,4.5\n");
}

TEST_CASE("The digest is FNV-1a with 128 bits as published") {
    const auto of = [](const std::string& text) {
        Digest digest;
        digest.add(text.data(), text.size());
        return digest.hex();
    };
    CHECK(of("") == "6c62272e07bb014262b821756295c58d");
    CHECK(of("a") == "d228cb696f1a8caf78912b704e4a8964");
    CHECK(of("foobar") == "343e1662793c64bf6f0d3597ba446f18");
}

TEST_CASE("The digest of a run changes with the last bit of any column and with the order of rows, not with "
          "the solver's counts") {
    const auto digestOf = [](const std::vector<StepRecord>& ticks) {
        Digest digest;
        for (const StepRecord& tick : ticks) {
            digest.add(tick);
        }
        return digest.hex();
    };
    const StepRecord tick = someTick();
    const std::string same = digestOf({tick});
    StepRecord timed = tick;
    timed.solves = 4, timed.infeasible = 1;
    CHECK(digestOf({timed}) == same);
    const auto nudged = [&](auto&& change) {
        StepRecord other = tick;
        change(other);
        return digestOf({other}) != same;
    };
    const auto up = [](double& value) { value = std::nextafter(value, 1e9); };
    double StepRecord::*const scalars[] = {
        &StepRecord::t,        &StepRecord::minGap,        &StepRecord::guidance,
        &StepRecord::sceneAge, &StepRecord::marginPassive, &StepRecord::marginUncoupled};
    for (const auto member : scalars) {
        CHECK(nudged([&](StepRecord& other) { up(other.*member); }));
    }
    for (int axis = 0; axis < 3; ++axis) {
        CHECK(nudged([&](StepRecord& other) { up(other.device.position[axis]); }));
        CHECK(nudged([&](StepRecord& other) { up(other.tool.position[axis]); }));
        CHECK(nudged([&](StepRecord& other) { up(other.wrench.force[axis]); }));
        CHECK(nudged([&](StepRecord& other) { up(other.wrench.torque[axis]); }));
    }
    for (int part = 0; part < 4; ++part) {
        CHECK(nudged([&](StepRecord& other) { up(other.device.rotation[part]); }));
        CHECK(nudged([&](StepRecord& other) { up(other.tool.rotation[part]); }));
    }
    CHECK(nudged([](StepRecord& other) { ++other.contactCount; }));
    CHECK(nudged([](StepRecord& other) { ++other.frame; }));
    CHECK(nudged([](StepRecord& other) { other.stalled = false; }));
    CHECK(nudged([](StepRecord& other) { other.state = StepState::Contact; }));
    StepRecord next = tick;
    next.t = 0.2;
    CHECK(digestOf({tick, next}) != digestOf({next, tick}));
}
