// SPDX-License-Identifier: Apache-2.0
#include "devices/pcd/pcd_camera.h"

#include "devices/recorded/recorded_camera.h"
#include "tests/devices/organised_cloud.h"
#include "tests/devices/recorded_folder.h"
#include "tests/support/refusal.h"

#include <cmath>
#include <cstring>
#include <doctest/doctest.h>

using namespace fathom;

namespace {

constexpr uint32_t kWidth = 9, kHeight = 7;

// A wall at 1 m, tilted, seen by a pinhole; pixel 0 has no point.
std::string cloudText(const std::string& data, bool up = false) {
    std::string text =
        "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH 9\n"
        "HEIGHT 7\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 63\nDATA " +
        data + "\n";
    for (uint32_t i = 0; i < kWidth * kHeight; ++i) {
        const auto column = i % kWidth, row = i / kWidth;
        const float u = static_cast<float>(column), v = static_cast<float>(row);
        const float z = i == 0 ? NAN : 1.0f + 0.05f * u, sign = up ? -1.0f : 1.0f;
        const float values[3] = {(u - 4.25f) / 10.0f * z, sign * (v - 3.5f) / 11.0f * z, sign * z};
        const uint32_t colour = 0x00102030 + i; // red, green, blue
        if (data == "ascii") {
            text += std::to_string(values[0]) + " " + std::to_string(values[1]) + " " +
                    std::to_string(values[2]) + " " + std::to_string(colour) + "\n";
        } else {
            text.append(reinterpret_cast<const char*>(values), sizeof values);
            text.append(reinterpret_cast<const char*>(&colour), sizeof colour);
        }
    }
    return text;
}

// The tilted wall with its last point at this depth, on the same ray.
std::string farText(float depth) {
    std::string text = cloudText("binary");
    const float values[3] = {(8.0f - 4.25f) / 10.0f * depth, (6.0f - 3.5f) / 11.0f * depth, depth};
    std::memcpy(text.data() + text.size() - 16, values, sizeof values);
    return text;
}

std::string refusal(const std::filesystem::path& file, const SourceOptions& options = {}) {
    return testing::refusalOf([&] { PcdCamera camera(file, options); });
}

} // namespace

TEST_CASE("An organised cloud gives back its lens and depth: ascii, binary, and with y up and z backward") {
    const TemporaryFolder folder;
    folder.write("a.pcd", cloudText("ascii"));
    folder.write("b.pcd", cloudText("binary"));
    folder.write("c.pcd", cloudText("binary", true));
    for (const char* name : {"a.pcd", "b.pcd", "c.pcd"}) {
        testing::checkOrganisedCloud(folder.path() / name);
    }
}

TEST_CASE("A cloud that is unorganised, truncated or not from a pinhole is rejected with the line") {
    const TemporaryFolder folder;
    const std::string whole = cloudText("binary");
    const auto changed = [&](const std::string& from, const std::string& to) {
        std::string text = whole;
        text.replace(text.find(from), from.size(), to);
        folder.write("x.pcd", text);
        return refusal(folder.path() / "x.pcd");
    };
    CHECK(changed("HEIGHT 7", "HEIGHT 1").find("an organised cloud") != std::string::npos);
    CHECK(changed("HEIGHT 7", "HEIGHT 8").find("DATA: 1008 bytes (allowed: 1152)") != std::string::npos);
    CHECK(changed("FIELDS x y z", "FIELDS a b c").find("no x, y, z") != std::string::npos);
    CHECK(changed("SIZE 4 4 4 4", "SIZE 4 4 4").find("as many as FIELDS") != std::string::npos);
    CHECK(changed("DATA binary\n", "DATA parquet\n").find("binary_compressed") != std::string::npos);
    CHECK(changed("WIDTH 9", "WIDTH x").find("WIDTH: x") != std::string::npos);
    CHECK(changed("WIDTH 9\nHEIGHT 7", "WIDTH 7\nHEIGHT 9").find("deviates from the rays of a pinhole") !=
          std::string::npos);
    CHECK(refusal(folder.path() / "none.pcd").find("no such file") != std::string::npos);
    folder.write("y.pcd", "DATA");
    CHECK(refusal(folder.path() / "y.pcd").find("cut off") != std::string::npos);
}

TEST_CASE("A word of an ASCII cloud that is not a number is rejected with its point and field") {
    const TemporaryFolder folder;
    const auto rejects = [&](const std::string& last, const std::string& part) {
        std::string text = cloudText("ascii");
        text.erase(text.rfind(' ', text.size() - 2) + 1); // the last colour
        folder.write("a.pcd", text + last + "\n");
        const std::string message = refusal(folder.path() / "a.pcd");
        CHECK_MESSAGE(message.find(part) != std::string::npos, message);
    };
    rejects("red", "DATA: 'red' at point 62 (allowed: numbers of TYPE U for rgb)");
    rejects("12abc", "DATA: '12abc' at point 62");
    rejects("1.5", "DATA: '1.5' at point 62");
    rejects("99999999999999999999999", "DATA: '99999999999999999999999' at point 62");
    std::string text = cloudText("ascii");
    folder.write("a.pcd", text);
    CHECK(refusal(folder.path() / "a.pcd") == "");
    text.replace(text.find("-"), 1, "x-"); // the first coordinate of the second point
    folder.write("a.pcd", text);
    CHECK(refusal(folder.path() / "a.pcd").find("for x)") != std::string::npos);
}

TEST_CASE("A scan of equal angles gives a fan in any axis convention, with intensity as grey") {
    const TemporaryFolder folder;
    for (const bool robot : {false, true}) {
        std::string text = "VERSION 0.7\nFIELDS x y z intensity\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\n"
                           "WIDTH 31\nHEIGHT 15\nPOINTS 465\nDATA binary\n";
        for (int i = 0; i < 31 * 15; ++i) {
            const auto column = i % 31, row = i / 31;
            const double a = (column - 15.0) / 20.0, e = (row - 7.0) / 18.0;
            const double r = i == 5 ? NAN : 2.0 + 0.01 * (i % 31);
            const dvec3 p = r * dvec3(std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e));
            const dvec3 q = robot ? dvec3(p.z, -p.x, -p.y) : p;
            for (const double value : {q.x, q.y, q.z, 2.0 * (i % 100)}) {
                const auto number = static_cast<float>(value);
                text.append(reinterpret_cast<const char*>(&number), sizeof number);
            }
        }
        folder.write("fan.pcd", text);
        PcdCamera camera(folder.path() / "fan.pcd");
        const Intrinsics& lens = camera.info().depth;
        CHECK(lens.fan);
        CHECK(lens.fx == doctest::Approx(20.0).epsilon(1e-4));
        CHECK(lens.fy == doctest::Approx(18.0).epsilon(1e-4));
        CHECK(lens.cx == doctest::Approx(15.0).epsilon(1e-4));
        const auto frame = camera.next();
        REQUIRE(frame);
        CHECK((*frame)->depth[5] == 0);
        CHECK((*frame)->depth[7 * 31 + 15] == 21500); // straight ahead
        CHECK((*frame)->colour[64] == 0xff808080u);   // strength 128 of 255
    }
}

TEST_CASE("A point beyond the scene's far costs the others no precision, and is not measured") {
    const TemporaryFolder folder;
    for (const float depth : {2000.0f, 1e6f}) {
        folder.write("far.pcd", farText(depth));
        PcdCamera camera(folder.path() / "far.pcd", {.farthest = 2.0});
        CHECK(camera.info().metresPerUnit == 1e-4);
        const auto frame = camera.next();
        REQUIRE(frame);
        CHECK((*frame)->depth[8] == 14000);
        CHECK((*frame)->depth[62] == 0);
    }
    folder.write("far.pcd", farText(20.0f)); // of interest when no depth is named
    PcdCamera camera(folder.path() / "far.pcd");
    CHECK((*camera.next())->depth[62] * camera.info().metresPerUnit == doctest::Approx(20.0).epsilon(1e-3));
}

TEST_CASE("Options that a cloud cannot follow are rejected, and colour=none leaves its colour out") {
    const TemporaryFolder folder;
    folder.write("a.pcd", cloudText("binary"));
    const std::filesystem::path file = folder.path() / "a.pcd";
    const auto rejects = [&](const SourceOptions& options, const std::string& part) {
        CHECK_MESSAGE(refusal(file, options).find(part) != std::string::npos, refusal(file, options));
    };
    rejects({.depth = "/x"}, "depth: /x (allowed: only for files with topics");
    rejects({.colour = "/x"}, "colour: /x");
    rejects({.info = "/x"}, "info: /x");
    rejects({.intrinsics = "x.json"}, "intrinsics: for a cloud (allowed: neither");
    rejects({.extrinsics = "x.json"}, "extrinsics: for a cloud");
    rejects({.start = 5.0}, "start: for a single cloud (allowed: neither");
    rejects({.duration = 5.0}, "duration: for a single cloud");
    CHECK_FALSE(PcdCamera(file, {.colour = "none"}).info().hasColour);
    CHECK(PcdCamera(file).info().hasColour);
}

TEST_CASE("LZF unpacks literals and short, long and overlapping matches, and rejects damaged data") {
    // "ab", then 7 bytes from 2 back ("abababa"), then 11 from 1 back.
    const std::vector<uint8_t> packed{1, 'a', 'b', 5 << 5, 1, 7 << 5, 2, 0};
    std::vector<uint8_t> out(2 + 7 + 11);
    REQUIRE(unpackLzf(packed, out));
    CHECK(std::string(out.begin(), out.end()) == "ababababaaaaaaaaaaaa");
    std::vector<uint8_t> small(5), large(40);
    CHECK_FALSE(unpackLzf(packed, small));
    CHECK_FALSE(unpackLzf(packed, large));
    CHECK_FALSE(unpackLzf(std::vector<uint8_t>{3 << 5, 0}, small)); // points before the start
    CHECK_FALSE(unpackLzf(std::vector<uint8_t>{1, 'a'}, small));
    CHECK_FALSE(unpackLzf(std::vector<uint8_t>{7 << 5}, small));
}

TEST_CASE("Fields of sizes that no number has are not read beyond their bytes") {
    const TemporaryFolder folder;
    std::string text = cloudText("binary"), cut;
    text.replace(text.find("rgb"), 3, "intensity");
    text.replace(text.find("SIZE 4 4 4 4"), 12, "SIZE 4 4 4 2");
    text.replace(text.find("F F F U"), 7, "F F F F");
    const size_t head = text.find("binary\n") + 7;
    for (size_t at = head; at < text.size(); at += 16) {
        cut += text.substr(at, 14);
    }
    folder.write("half.pcd", text.substr(0, head) + cut);
    CHECK_FALSE(PcdCamera(folder.path() / "half.pcd").info().hasColour);
    text = cloudText("binary");
    text.replace(text.find("SIZE 4 4 4 4"), 12, "SIZE 5 4 4 4");
    folder.write("five.pcd", text);
    CHECK(refusal(folder.path() / "five.pcd")
              .find("FIELDS: x (allowed: x, y and z of type F and size 4 or 8)") != std::string::npos);
}

TEST_CASE("A cloud with fields r, g, b has colour, and one in millimetres is scaled when that is said") {
    const TemporaryFolder folder;
    std::string text = "FIELDS x y z r g b\nSIZE 4 4 4 1 1 1\nTYPE F F F U U U\nCOUNT 1 1 1 1 1 1\nWIDTH 9\n"
                       "HEIGHT 7\nPOINTS 63\nDATA ascii\n";
    for (uint32_t i = 0; i < kWidth * kHeight; ++i) {
        const uint32_t column = i % kWidth, row = i / kWidth;
        const double z = 500.0 + column, x = (column - 4.0) / 10.0 * z, y = (row - 3.0) / 10.0 * z;
        text += std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + " 200 10 20\n";
    }
    folder.write("mm.pcd", text);
    PcdCamera scaled(folder.path() / "mm.pcd", {.scale = 0.001});
    const auto frame = scaled.next();
    REQUIRE(frame);
    CHECK((*frame)->depth[0] * scaled.info().metresPerUnit == doctest::Approx(0.5).epsilon(1e-3));
    REQUIRE((*frame)->colour.size() == 63);
    CHECK((*frame)->colour[5] == 0xff140ac8u);
    PcdCamera metres(folder.path() / "mm.pcd");
    CHECK((*metres.next())->depth[0] * metres.info().metresPerUnit == doctest::Approx(500.0).epsilon(1e-3));
    REQUIRE(metres.warnings().size() == 1); // which --strict counts
    CHECK(metres.warnings()[0].find("scale=0.001") != std::string::npos);
    CHECK(scaled.warnings().empty());
    std::string floats = text;
    floats.replace(floats.find("4 4 4 1 1 1"), 11, "4 4 4 4 4 4");
    floats.replace(floats.find("F F F U U U"), 11, "F F F F F F");
    for (size_t at = 0; (at = floats.find(" 200 10 20\n")) != std::string::npos;) {
        floats.replace(at, 11, " 1 0 0.5\n");
    }
    folder.write("f.pcd", floats);
    PcdCamera unit(folder.path() / "f.pcd");
    CHECK((*unit.next())->colour[5] == 0xff8000ffu);
}

TEST_CASE("A real compressed cloud gives the depth image and lens of its recording") {
    if (!haveRecording("pcl_milk_table")) {
        return;
    }
    const auto folder = kRecordings / "pcl_milk_table";
    PcdCamera cloud(folder / "milk_cartoon_all_small_clorox.pcd");
    RecordedCamera recorded(folder);
    CHECK(cloud.info().depth.fx == doctest::Approx(525.0).epsilon(1e-4));
    CHECK(cloud.info().depth.cy == doctest::Approx(239.5).epsilon(1e-4));
    const auto a = cloud.next(), b = recorded.next();
    REQUIRE(a);
    REQUIRE(b);
    size_t differ = 0, colours = 0, valid = 0;
    for (size_t i = 0; i < (*b)->depth.size(); ++i) {
        const double z = (*a)->depth[i] * cloud.info().metresPerUnit,
                     w = (*b)->depth[i] * recorded.info().metresPerUnit;
        differ += std::abs(z - w) > 1.01e-4 ? 1 : 0;
        colours += ((*a)->colour[i] & 0xffffff) != ((*b)->colour[i] & 0xffffff) ? 1 : 0;
        valid += (*a)->depth[i] != 0 ? 1 : 0;
    }
    CHECK(valid > 200000);
    CHECK(differ == 0);
    CHECK(colours == 0);
}

TEST_CASE("A cloud of unknown axes is rejected, although a part of its points fits a lens") {
    const TemporaryFolder folder;
    std::string text = "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 64\nHEIGHT 48\nDATA ascii\n";
    for (int i = 0; i < 64 * 48; ++i) { // x right, y forward, z up
        const int u = i % 64, v = i / 64;
        const double z = 0.5 + 0.0005 * ((u * 7 + v * 13) % 11);
        text += std::to_string((u - 31.5) / 60.0 * z) + " " + std::to_string(z) + " " +
                std::to_string(-(v - 23.5) / 60.0 * z) + "\n";
    }
    folder.write("a.pcd", text);
    CHECK(refusal(folder.path() / "a.pcd").find("x right and y down") != std::string::npos);
}

TEST_CASE("A lens that no camera has says that the points may be in another frame") {
    const Intrinsics usual{.width = 80, .height = 60, .fx = 70.0, .fy = 71.0, .cx = 38.0, .cy = 31.0};
    CHECK(lensWarning(usual).empty());
    Intrinsics outside = usual, stretched = usual;
    outside.cy = 98.9;
    stretched.fx = 95.0;
    CHECK(lensWarning(outside).find("principal point (38.0, 98.9): they may be in another frame") !=
          std::string::npos);
    CHECK(lensWarning(stretched).find("fx 95.0, fy 71.0") != std::string::npos);
}
