// SPDX-License-Identifier: Apache-2.0
// The real recordings are read as they are. The sums come from a decoder of its own (zlib and the PNG filters
// alone).
#include "devices/recorded/recorded_camera.h"
#include "tests/devices/recorded_folder.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>

using namespace fathom;

namespace {

struct Facts {
    const char* name;
    uint32_t frames, width, height;
    uint64_t depthSum; // of the first frame
    size_t firstPixel; // first with depth
    uint16_t firstDepth;
    uint32_t firstColour; // there
    uint64_t colourSum;   // of R, G and B of the first frame
};

constexpr Facts kFacts[] = {
    {"pcl_milk_table", 1, 640, 480, 2184473750, 10814, 19920, 0xff445558, 65505415},
    {"tum_fr1_single", 1, 640, 480, 3074716315, 5779, 42065, 0xffa8a8a2, 101558687},
    {"valve_ball_d435", 27, 428, 240, 21808163, 5, 317, 0xffbbc6c4, 23531667},
    {"valve_globe_d435", 60, 428, 240, 22250000, 0, 314, 0xffb3c5c3, 23602080},
    {"ycb_posecnn_demo", 5, 640, 480, 2603062490, 74, 11480, 0xff000000, 84557547},
    {"realsense_bag", 1, 640, 480, 357542766, 31, 1722, 0xff6c90a9, 103934465},
};

void checkFirstFrame(const Frame::Content& frame, const Facts& facts) {
    CHECK(frame.index == 0);
    REQUIRE(frame.depth.size() == facts.width * facts.height);
    REQUIRE(frame.colour.size() == facts.width * facts.height);
    uint64_t depthSum = 0, colourSum = 0;
    for (size_t i = 0; i < frame.depth.size(); ++i) {
        depthSum += frame.depth[i];
        colourSum += (frame.colour[i] & 255) + (frame.colour[i] >> 8 & 255) + (frame.colour[i] >> 16 & 255);
    }
    CHECK(depthSum == facts.depthSum);
    CHECK(colourSum == facts.colourSum);
    const auto first =
        std::find_if(frame.depth.begin(), frame.depth.end(), [](uint16_t z) { return z != 0; });
    CHECK(first - frame.depth.begin() == static_cast<long>(facts.firstPixel));
    CHECK(*first == facts.firstDepth);
    CHECK(frame.colour[facts.firstPixel] == facts.firstColour);
}

// Colour gradient (up to 60 grey values per pixel) where depth edges fall, mean over the edges.
double edgeAgreement(const CameraInfo& camera, const Frame::Content& frame, const Pose& colourTdepth) {
    const long w = camera.depth.width, h = camera.depth.height;
    const auto grey = [&](long u, long v) {
        const uint32_t c = frame.colour[static_cast<size_t>(v * w + u)];
        return 0.3 * (c & 255) + 0.59 * (c >> 8 & 255) + 0.11 * (c >> 16 & 255);
    };
    const auto depth = [&](long u, long v) {
        return static_cast<double>(frame.depth[static_cast<size_t>(v * w + u)]);
    };
    double sum = 0.0, count = 0.0;
    for (long v = 2; v < h - 2; ++v) {
        for (long u = 2; u < w - 2; ++u) {
            const double z = depth(u, v);
            const double behind =
                std::max({depth(u - 2, v), depth(u + 2, v), depth(u, v - 2), depth(u, v + 2)});
            if (z == 0.0 || z > 2500.0 || behind < 1.06 * z) {
                continue;
            }
            const glm::dvec2 ray = camera.depth.ray(static_cast<double>(u), static_cast<double>(v));
            const dvec3 point = dvec3(ray.x, ray.y, 1.0) * (z * camera.metresPerUnit);
            const glm::dvec2 pixel = camera.colour.project(colourTdepth.apply(point));
            const long a = std::lround(pixel.x), b = std::lround(pixel.y);
            if (a > 0 && b > 0 && a < w - 1 && b < h - 1) {
                const double gx = grey(a + 1, b) - grey(a - 1, b), gy = grey(a, b + 1) - grey(a, b - 1);
                sum += std::min(60.0, std::hypot(gx, gy));
                count += 1.0;
            }
        }
    }
    return sum / std::max(count, 1.0);
}

} // namespace

TEST_CASE("every real recording is read to its end with the frames that its files hold") {
    for (const Facts& facts : kFacts) {
        if (!haveRecording(facts.name)) {
            continue;
        }
        CAPTURE(facts.name);
        RecordedCamera camera(kRecordings / facts.name);
        CHECK(camera.info().depth.width == facts.width);
        CHECK(camera.info().depth.height == facts.height);
        uint32_t count = 0;
        double last = -1.0;
        while (const std::optional<Frame> frame = camera.next()) {
            if (count == 0) {
                checkFirstFrame(**frame, facts);
            }
            CHECK((*frame)->index == count);
            CHECK((*frame)->sourceNumber == count);
            CHECK((*frame)->captureTime > last);
            CHECK_FALSE((*frame)->baseTcamera.has_value());
            last = (*frame)->captureTime;
            ++count;
        }
        CHECK(count == facts.frames);
        CHECK(camera.skipped() == 0);
        CHECK_FALSE(camera.next().has_value());
        CHECK(camera.description() == "recorded " + (kRecordings / facts.name).string());
    }
}

TEST_CASE("the lens and unit of each camera come from its intrinsics") {
    if (haveRecording("tum_fr1_single")) {
        const RecordedCamera camera(kRecordings / "tum_fr1_single");
        CHECK(camera.info().registered);
        CHECK(camera.info().metresPerUnit == 0.0002);
        CHECK(camera.info().depth.fy == 516.5);
        CHECK(camera.info().depth.distortion ==
              std::array<double, 5>{0.2624, -0.9531, -0.0054, 0.0026, 1.1633});
        CHECK(camera.info().colour.distortion == camera.info().depth.distortion);
    }
    if (haveRecording("valve_ball_d435")) {
        const RecordedCamera camera(kRecordings / "valve_ball_d435");
        CHECK(camera.info().registered);
        CHECK(camera.info().metresPerUnit == 0.001);
        CHECK(camera.info().depth.cx == 210.89148);
        CHECK_FALSE(camera.info().depth.distorted());
    }
    if (haveRecording("realsense_bag")) {
        const RecordedCamera camera(kRecordings / "realsense_bag");
        CHECK_FALSE(camera.info().registered);
        CHECK(camera.info().depth.fx == 390.43145751953125);
        CHECK(camera.info().colour.fy == 613.4193115234375);
        CHECK_FALSE(camera.info().colour.distorted());
        CHECK(camera.info().colourTdepth.position.x == 0.01431131362915039);
    }
}

TEST_CASE("depth edges of the D435 fall on colour edges by its extrinsics, and not by their inverse") {
    if (!haveRecording("realsense_bag")) {
        return;
    }
    RecordedCamera camera(kRecordings / "realsense_bag");
    const std::optional<Frame> frame = camera.next();
    REQUIRE(frame.has_value());
    CHECK((*frame)->captureTime == 1.5e-06); // the depth stamp nearest to the one colour image
    const Pose colourTdepth = camera.info().colourTdepth;
    const double as = edgeAgreement(camera.info(), **frame, colourTdepth);
    const double inverted = edgeAgreement(camera.info(), **frame, inverse(colourTdepth));
    const double none = edgeAgreement(camera.info(), **frame, Pose{});
    MESSAGE("mean colour gradient on depth edges: ", as, ", inverted ", inverted, ", identity ", none);
    CHECK(as > 3.0 * inverted);
    CHECK(as > 3.0 * none);
}
