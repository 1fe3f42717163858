// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/hand_csv.h"
#include "engine/types/error.h"
#include "tests/devices/recorded_folder.h"
#include "tests/realtime/listening.h"
#include "tests/support/refusal.h"

#include <cmath>
#include <doctest/doctest.h>

using namespace fathom;

namespace {

const std::string kHeader = "t_s,x,y,z,qw,qx,qy,qz\n";
const std::string kButtonHeader = "t_s,x,y,z,qw,qx,qy,qz,button\n";

std::vector<HandWaypoint> read(const std::string& text) {
    const TemporaryFolder folder;
    folder.write("way.csv", text);
    return readHandCsv(folder.path() / "way.csv");
}

bool refusedWith(const std::string& text, const std::string& part) {
    return testing::refusalOf([&] { read(text); }).find("way.csv: " + part) != std::string::npos;
}

} // namespace

TEST_CASE("a path with and without buttons is read with w first and unit quaternions") {
    const std::vector<HandWaypoint> plain =
        read(kHeader + "0,1,2,3,1,0,0,0\r\n0.001, -1e-3 ,0,0,0,0.6,0,0.8\n\n");
    REQUIRE(plain.size() == 2);
    CHECK(plain[0].deviceThandle.position == dvec3(1, 2, 3));
    CHECK(plain[0].deviceThandle.rotation == dquat(1, 0, 0, 0));
    CHECK(plain[0].buttons == 0);
    CHECK(plain[1].t == 0.001);
    CHECK(plain[1].deviceThandle.position.x == -1e-3);
    CHECK(std::abs(plain[1].deviceThandle.rotation.x - 0.6) < 1e-15);
    CHECK(std::abs(plain[1].deviceThandle.rotation.z - 0.8) < 1e-15);
    const std::vector<HandWaypoint> buttons = read(kButtonHeader + "-1,0,0,0,1,0,0,0,5\n");
    REQUIRE(buttons.size() == 1);
    CHECK(buttons[0].buttons == 5);
    CHECK(buttons[0].t == -1.0);
    CHECK(read("\xEF\xBB\xBF" + kHeader + "1,0,0,0,1,0,0,0\n").size() == 1); // byte order mark
}

TEST_CASE("The buttons of a path may be whole numbers in any spelling, as other programs write them") {
    for (const auto& spelling : {std::pair("1.000000000000000000e+00", 1u),
                                 {"0.0", 0u},
                                 {"-0.0", 0u},
                                 {"+3", 3u},
                                 {"2.5e1", 25u},
                                 {"4294967295.0", 4294967295u}}) {
        CAPTURE(spelling.first);
        const auto path = read(kButtonHeader + "0,0,0,0,1,0,0,0," + spelling.first + "\n");
        CHECK(path.at(0).buttons == spelling.second);
    }
    for (const char* word : {"0.5", "-1.0", "4294967296", "inf", "nan", "1.0x", ""}) {
        CAPTURE(word);
        CHECK(refusedWith(kButtonHeader + "0,0,0,0,1,0,0,0," + word + "\n",
                          "line 2, button: '" + std::string(word) + "' (allowed: a whole number from 0 to"));
    }
}

TEST_CASE("A quaternion of a path whose length is not 1 is rejected with its length and the order") {
    CHECK(refusedWith(kHeader + "0,0,0,0,10,20,30,0\n",
                      "line 2, qw..qz: '10,20,30,0' (allowed: a quaternion qw qx qy qz, in this order, of "
                      "length 1; its length is 37.42)"));
    CHECK(refusedWith(kHeader + "0,0,0,0,1e200,1e200,0,0\n", "line 2, qw..qz: '1e+200,1e+200,0,0'"));
    CHECK(read(kHeader + "0,0,0,0,0.7,0,0,0.7\n").size() == 1); // few digits
}

TEST_CASE("a path of 100000 rows keeps every one") {
    std::string text = kHeader;
    for (int i = 0; i < 100000; ++i) {
        text += std::to_string(0.5 * i) + ",0,0,0,1,0,0,0\n";
    }
    const std::vector<HandWaypoint> path = read(text);
    REQUIRE(path.size() == 100000);
    CHECK(path.back().t == 49999.5);
}

TEST_CASE("a path of more than 64 MiB is read, a line of more than 2048 characters is not") {
    std::string text = kHeader;
    for (int i = 0; i < 36000; ++i) {
        text += std::to_string(i) + ",1,2,3,1,0,0,0\n#" + std::string(2000, 'x') + "\n";
    }
    CHECK(text.size() > (64u << 20));
    CHECK(read(text).size() == 36000);
    CHECK(read(kHeader + "#" + std::string(2047, 'x') + "\n0,1,2,3,1,0,0,0").size() == 1);
    CHECK(refusedWith(kHeader + "#" + std::string(2048, 'x') + "\n0,1,2,3,1,0,0,0\n", "line 2: '#xxx"));
    CHECK(refusedWith(std::string(1u << 20, '7'), "line 1: '777"));
    CHECK(refusedWith(kHeader + "0,1,2,3,1,0,0,0" + std::string(1, '\0') + "1\n", "line 2, qz"));
}

TEST_CASE("A path without header or rows, out of order or invalid is rejected with its line and column") {
    CHECK(refusedWith("", "line 1: nothing"));
    CHECK(refusedWith(kHeader, "line 2: end of file"));
    CHECK(refusedWith("0,0,0,0,1,0,0,0\n", "line 1: '0,0,0,0,1,0,0,0' (allowed: header t_s,"));
    CHECK(refusedWith("t_s,x,y,z,qx,qy,qz,qw\n0,0,0,0,0,0,0,1\n", "line 1: 't_s,x,y,z,qx,qy,qz,qw'"));
    CHECK(refusedWith(kHeader + "0,0,0,0,1,0,0\n", "line 2: '7 fields' (allowed: 8"));
    CHECK(refusedWith(kHeader + "0,0,0,0,1,0,0,0,1\n", "line 2: '9 fields'"));
    CHECK(refusedWith(kHeader + "0,0,0,0,1,0,0,0\n0,0,0,0,1,0,0,0\n", "line 3, t_s: '0' (allowed: later"));
    CHECK(refusedWith(kHeader + "1,0,0,0,1,0,0,0\n\n0.5,0,0,0,1,0,0,0\n", "line 4, t_s: '0.5'"));
    CHECK(refusedWith(kHeader + "0,0,nan,0,1,0,0,0\n", "line 2, y: 'nan'"));
    CHECK(refusedWith(kHeader + "0,inf,0,0,1,0,0,0\n", "line 2, x: 'inf'"));
    CHECK(refusedWith(kHeader + "0,0,0,,1,0,0,0\n", "line 2, z: ''"));
    CHECK(refusedWith(kHeader + "0,0,0,0,0,0,0,0\n", "line 2, qw..qz: '0,0,0,0'"));
    CHECK(refusedWith(kHeader + "0,0,0,0,1,0,0,zero\n", "line 2, qz: 'zero'"));
    CHECK(refusedWith(kButtonHeader + "0,0,0,0,1,0,0,0,-1\n", "line 2, button: '-1'"));
    CHECK(refusedWith(kButtonHeader + "0,0,0,0,1,0,0,0,1.5\n", "line 2, button: '1.5'"));
    CHECK_THROWS_AS(readHandCsv("no/such/way.csv"), BadInput);
}

TEST_CASE(
    "A path of a recorded hand whose times are no seconds has one warning, slow scripts and rest have none") {
    const auto warned = [](double row, double step, int rows) {
        std::string text = kHeader;
        for (int i = 0; i < rows; ++i) {
            text += std::to_string(row * i) + "," + std::to_string(step * i) + ",0,0,1,0,0,0\n";
        }
        const testing::Listening log;
        CHECK(read(text).size() == static_cast<size_t>(rows));
        return log.count("t_s is read as seconds, but looks like milliseconds") +
               10 * log.count("looks like microseconds");
    };
    CHECK(warned(1.0, 1e-4, 1000) == 1); // 1 kHz and 0.1 m/s
    CHECK(warned(10.0, 1e-3, 200) == 1);
    CHECK(warned(300.0, 3e-5, 250) == 10);
    CHECK(warned(0.001, 1e-4, 1000) == 0);
    CHECK(warned(0.02, 1e-5, 1000) == 0); // slow
    CHECK(warned(1.0, 0.01, 100) == 0);   // a script
    CHECK(warned(1.0, 1e-3, 60) == 0);    // a slow script
    CHECK(warned(1.0, 0.0, 1000) == 0);   // at rest
}

TEST_CASE("Rows of a path that end before the run starts are counted in a warning") {
    const auto warned = [](const std::string& rows, const std::string& words) {
        const testing::Listening log;
        read(kHeader + rows);
        CHECK(log.count("are not played") == (words.empty() ? 0u : 1u));
        return words.empty() || log.count(words) == 1;
    };
    const std::string pose = ",0,0,0,1,0,0,0\n";
    CHECK(warned("-2" + pose + "-1" + pose + "1" + pose, "1 of 3 rows are not played"));
    CHECK(warned("-3" + pose + "-2" + pose + "-1" + pose, "2 of 3 rows are not played"));
    CHECK(warned("-1" + pose + "1" + pose, ""));
    CHECK(warned("0" + pose + "1" + pose, ""));
}
