// SPDX-License-Identifier: Apache-2.0
// Recordings that are unusable as a whole, and what the message says.
#include "devices/bag/bag_camera.h"
#include "devices/pcd/pcd_camera.h"
#include "devices/recorded/recorded_camera.h"
#include "engine/types/error.h"
#include "tests/devices/recorded_folder.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <sys/stat.h>

using namespace fathom;

namespace {

bool holds(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

// The small recording with `from` in intrinsics.json replaced must be refused by that file's name and these
// words.
void checkIntrinsics(const std::string& from, const std::string& to, const std::string& fieldAndValue) {
    const TemporaryFolder folder;
    writeSmallRecording(folder, 1);
    std::string text = kSmallIntrinsics;
    const size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    folder.write("intrinsics.json", text.replace(at, from.size(), to));
    const std::string message = recordingRefusal(folder.path());
    CAPTURE(to);
    CAPTURE(message);
    CHECK(holds(message, "intrinsics.json: " + fieldAndValue));
    CHECK(holds(message, "(allowed: "));
}

const std::string kLens = R"({"width": 7, "height": 5, "fx": 6.5, "fy": 6.25, "cx": 3, "cy": 2})";

std::string twoLenses(const std::string& rest, const std::string& colour = kLens) {
    return R"({"depth": )" + kLens + R"(, "color": )" + colour + R"(, "depth_scale_m_per_unit": 0.001)" +
           rest + "}";
}

std::string jsonRefusal(const std::string& intrinsics) {
    const TemporaryFolder folder;
    writeSmallRecording(folder, 1);
    folder.write("intrinsics.json", intrinsics);
    return recordingRefusal(folder.path());
}

} // namespace

TEST_CASE("a missing folder, an empty folder and a folder without an index are refused") {
    CHECK(holds(recordingRefusal("no/such/recording"), "no/such/recording: folder: missing"));
    const TemporaryFolder folder;
    CHECK(holds(recordingRefusal(folder.path()), "folder: empty"));
    writeSmallRecording(folder, 1);
    CHECK(recordingRefusal(folder.path()) == "");
    std::filesystem::remove(folder.path() / "associations.txt");
    CHECK(holds(recordingRefusal(folder.path()), "associations.txt: missing"));
    folder.write("depth.txt", "0 depth/0.png\n");
    CHECK(holds(recordingRefusal(folder.path()), "associations.txt: missing"));
    folder.write("rgb.txt", "5 rgb/0.png\n");
    CHECK(holds(recordingRefusal(folder.path()), "rgb.txt and depth.txt: no pair of images"));
    folder.write("associations.txt", "# nothing\n\n");
    CHECK(holds(recordingRefusal(folder.path()), "associations.txt: no pair of images"));
    std::filesystem::remove(folder.path() / "intrinsics.json");
    CHECK(holds(recordingRefusal(folder.path()), "intrinsics.json: file: missing"));
    folder.write("b_1.mcap", "x");
    folder.write("b_0.mcap", "x");
    CHECK(holds(recordingRefusal(folder.path()), "metadata.yaml: missing (allowed: metadata.yaml of a ROS 2 "
                                                 "recording, or the name of one file: " +
                                                     (folder.path() / "b_0.mcap").string()));
}

TEST_CASE("A recording without a usable frame is rejected at its end, with the first reason") {
    const TemporaryFolder folder;
    writeSmallRecording(folder, 3);
    for (const char* name : {"depth/0.png", "depth/1.png", "depth/2.png"}) {
        std::filesystem::resize_file(folder.path() / name, 50);
    }
    RecordedCamera camera(folder.path());
    CHECK_THROWS_AS(camera.next(), BadInput);
    CHECK(camera.skipped() == 3);
    const std::string message = recordingRefusal(folder.path());
    CHECK(holds(message, "frames: none of 3 is usable; first: "));
    CHECK(holds(message, "depth/0.png"));
}

TEST_CASE("Images of another size than their lens are rejected with the file that states the size") {
    const TemporaryFolder folder;
    folder.write("camera_intrinsic.json",
                 R"({"width": 70, "height": 50, "intrinsic_matrix": [60, 0, 0, 0, 65, 0, 30, 20, 1]})");
    addPair(folder, "depth/00000.png", "color/00000.png", 500);
    CHECK(holds(recordingRefusal(folder.path()),
                "7x5 pixels, not 70x50 (allowed: at least one usable pair of images, of the size in "
                "camera_intrinsic.json)"));
}

TEST_CASE("Colour of another size than depth is rejected when the registration is unknown") {
    const TemporaryFolder folder;
    writeSmallRecording(folder, 2);
    writeColour(folder.path() / "rgb/0.png", 14, 10, 1, 2, 3);
    writeColour(folder.path() / "rgb/1.png", 14, 10, 1, 2, 3);
    const std::string message = recordingRefusal(folder.path());
    CHECK(holds(message,
                "intrinsics.json: color.width, color.height: colour images of 14x10 where 7x5 is stated"));
    const std::string wide = R"({"width": 14, "height": 10, "fx": 13, "fy": 12.5, "cx": 6, "cy": 4})";
    folder.write(
        "intrinsics.json",
        twoLenses(R"(, "extrinsics_topic_tf": {"Color": {"t": [0.1, 0, 0], "q_xyzw": [0, 0, 0, 1]}})", wide));
    RecordedCamera camera(folder.path());
    CHECK(camera.next().value()->colour.size() == 140);
    CHECK(camera.info().colourTdepth.position == dvec3(0.1, 0, 0));
    CHECK_FALSE(camera.info().registered);
}

TEST_CASE("a lens with a missing, negative, zero or non-finite number is refused by its field") {
    checkIntrinsics(R"("fx": 6.5)", R"("fx": -6.5)", "fx: -6.5");
    checkIntrinsics(R"("fx": 6.5)", R"("fx": 0)", "fx: 0");
    checkIntrinsics(R"("fx": 6.5)", R"("fx": "6.5")", "fx: \"6.5\"");
    checkIntrinsics(R"("fx": 6.5)", R"("fx": null)", "fx: null");
    checkIntrinsics(R"("fy": 6.25,)", "", "fy: missing");
    checkIntrinsics(R"("cx": 3,)", "", "cx: missing");
    checkIntrinsics(R"("cy": 2)", R"("cy": [2])", "cy: [2]");
    checkIntrinsics(R"("width": 7)", R"("width": 0)", "width: 0");
    checkIntrinsics(R"("width": 7)", R"("width": 3841)", "width: 3841");
    checkIntrinsics(R"("width": 7)", R"("width": 7.5)", "width: 7.5");
    checkIntrinsics(R"("height": 5)", R"("height": 2161)", "height: 2161");
    checkIntrinsics(R"("height": 5)", R"("height": -5)", "height: -5");
    checkIntrinsics(R"("depth_scale_m_per_unit": 0.001)", R"("depth_scale_m_per_unit": 0)",
                    "depth_scale_m_per_unit: 0");
    checkIntrinsics(R"(, "depth_scale_m_per_unit": 0.001)", "", "depth_scale_m_per_unit: missing");
    checkIntrinsics(R"("registered_to_color": true)", R"("registered_to_color": false)",
                    "registered_to_color: false");
    checkIntrinsics(R"("registered_to_color": true)", R"("registered_to_color": 1)",
                    "registered_to_color: 1");
    checkIntrinsics(R"("registered_to_color": true)", R"("registered_to_colour": false)",
                    "registered_to_colour: false");
}

TEST_CASE("A whole number may be written with a decimal point") {
    std::string text = kSmallIntrinsics;
    text.replace(text.find("7"), 1, "7.0");
    CHECK(jsonRefusal(text) == "");
}

TEST_CASE("Distortion and depth scale under the names of other programs are rejected, and zeros are not") {
    for (const char* name : {"D", "distortion_coefficients", "coeffs", "k1"}) {
        const std::string key = std::string("\"") + name + "\": ";
        std::string text = R"({"width": 7, "height": 5, "fx": 6.5, "fy": 6.25, "cx": 3, "cy": 2,
                              "depth_scale_m_per_unit": 0.001, )";
        CHECK(holds(jsonRefusal(text + key + "[0.3, 0, 0, 0, 0]}"), std::string(name) + ": [0.3,0,0,0,0]"));
        CHECK(holds(jsonRefusal(text + key + "0.3}"), "(allowed: zeros, or the coefficients as a list"));
        CHECK(holds(jsonRefusal(text + key + R"({"rows": 1}})"), std::string(name) + ": an object"));
        CHECK(jsonRefusal(text + key + "[0, 0, 0, 0, 0]}") == "");
    }
    checkIntrinsics(R"("depth_scale_m_per_unit": 0.001)", R"("depth_scale": 1000)",
                    "depth_scale: 1000 (allowed: depth_scale_m_per_unit: ");
}

TEST_CASE("Invalid JSON is rejected with its position: NaN, infinity, a truncated file, an empty one") {
    checkIntrinsics(R"("fx": 6.5)", R"("fx": NaN)", "syntax: ");
    checkIntrinsics(R"("fx": 6.5)", R"("fx": 1e999)", "syntax: ");
    checkIntrinsics(R"("registered_to_color": true})", "", "syntax: ");
    CHECK(holds(jsonRefusal(R"({"width": 7, "fx": NaN})"), "last read: '\"fx\": N'"));
    CHECK(holds(jsonRefusal(kSmallIntrinsics.substr(0, 30)), "line 1"));
    CHECK(holds(jsonRefusal(""), "intrinsics.json: syntax"));
    CHECK(holds(jsonRefusal("[1, 2]"), "intrinsics.json: file: [1,2] (allowed: an object)"));
}

TEST_CASE(
    "A value nested deeper than any stack is rejected in one line, and so is a text truncated within it") {
    constexpr size_t kDeep = 200'000;
    const std::string opened(kDeep, '['), closed(kDeep, ']');
    checkIntrinsics(R"("fx": 6.5)", R"("fx": )" + opened + closed, "fx: [...] (");
    checkIntrinsics(R"("fx": 6.5)", R"("fx": {"a": )" + opened + closed + "}", "fx: an object (");
    CHECK(holds(jsonRefusal(opened), "syntax: "));
}

TEST_CASE("A rejection quotes a short, printable part of a JSON text of any length") {
    const std::string bytes(100'000, 'k');
    for (const std::string& text : {"{\"" + bytes + "\x01", "{\"width\": \"" + bytes + "\"}",
                                    "{\"\xc2\x85\xe2\x80\xae" + bytes, std::string("{\"a\": \xff\xfe")}) {
        const std::string message = jsonRefusal(text);
        CAPTURE(message);
        CHECK(message != "");
        CHECK(message.size() < 500);
        CHECK(std::all_of(message.begin(), message.end(), [](char c) { return c >= 0x20 && c < 0x7f; }));
    }
}

TEST_CASE("A recording with text files larger than any real ones is rejected with the limit") {
    CHECK(holds(jsonRefusal(std::string(17u << 20, ' ')),
                "intrinsics.json: file: 17825792 bytes (allowed: a readable text file of at most 16 MiB)"));
    const TemporaryFolder folder;
    writeSmallRecording(folder, 1);
    std::string lines;
    for (int i = 0; i <= 1'000'000; ++i) {
        lines += "0\n";
    }
    folder.write("associations.txt", lines);
    CHECK(holds(recordingRefusal(folder.path()),
                "associations.txt: line 1000001: over 1000000 lines so far (allowed: "));
}

TEST_CASE("A pipe in place of a file never blocks; in place of an image it skips the frame") {
    const TemporaryFolder folder;
    writeSmallRecording(folder, 3);
    const auto toPipe = [&](const char* name) {
        std::filesystem::remove(folder.path() / name);
        REQUIRE(::mkfifo((folder.path() / name).c_str(), 0600) == 0);
    };
    toPipe("rgb/0.png");
    toPipe("depth/1.png");
    RecordedCamera camera(folder.path());
    CHECK(camera.next().value()->index == 2);
    CHECK(camera.skipped() == 2);
    toPipe("rgb/2.png");
    CHECK(holds(recordingRefusal(folder.path()), "rgb/0.png: a pipe or device"));
    toPipe("associations.txt");
    CHECK(holds(recordingRefusal(folder.path()), "associations.txt: file: a pipe or device (allowed: "));
    toPipe("intrinsics.json");
    CHECK(holds(recordingRefusal(folder.path()), "intrinsics.json: file: a pipe or device (allowed: "));
    toPipe("x.bag");
    CHECK_THROWS_WITH_AS(BagCamera(folder.path() / "x.bag"), doctest::Contains("a pipe or device"), BadInput);
    CHECK_THROWS_WITH_AS(PcdCamera(folder.path() / "x.bag"), doctest::Contains("a pipe or device"), BadInput);
}

TEST_CASE("Distortion that is unknown, incomplete or folds the image is rejected") {
    const std::string none = R"("distortion_model": "none", "distortion": [])";
    const auto with = [&](const std::string& model, const std::string& list, const std::string& expected) {
        checkIntrinsics(none, R"("distortion_model": ")" + model + R"(", "distortion": )" + list, expected);
    };
    with("f_theta", "[0.1, 0, 0, 0, 0]", "distortion_model: \"f_theta\"");
    with("plumb_bob", "[0.1, 0.2]", "distortion: [0.1,0.2]");
    with("plumb_bob", "[0.1, 0, 0, 0, null]", "distortion[4]: null");
    with("plumb_bob", "[-5, 0, 0, 0, 0]", "distortion: [-5,0,0,0,0]");
    const TemporaryFolder folder;
    writeSmallRecording(folder, 1);
    std::string text = kSmallIntrinsics;
    folder.write("intrinsics.json",
                 text.replace(text.find(none), none.size(),
                              R"("distortion_model": "Brown Conrady", "distortion": [0.01, 0, 0, 0.002])"));
    CHECK(RecordedCamera(folder.path()).info().depth.distortion ==
          std::array<double, 5>{0.01, 0, 0, 0.002, 0});
}

TEST_CASE("two lenses without usable extrinsics are refused by their field") {
    CHECK(holds(jsonRefusal(twoLenses("")), "intrinsics.json: extrinsics_topic_tf: missing"));
    CHECK(holds(jsonRefusal(twoLenses(R"(, "extrinsics_topic_tf": {})")),
                "extrinsics_topic_tf.Color: missing"));
    CHECK(holds(
        jsonRefusal(twoLenses(R"(, "extrinsics_topic_tf": {"Color": {"t": [0, 0], "q_xyzw": [0,0,0,1]}})")),
        "extrinsics_topic_tf.Color.t: [0,0]"));
    CHECK(holds(
        jsonRefusal(twoLenses(R"(, "extrinsics_topic_tf": {"Color": {"t": [0,0,0], "q_xyzw": [0,0,0,0]}})")),
        "extrinsics_topic_tf.Color.q_xyzw: [0,0,0,0]"));
    for (const char* other : {R"({"width": 6, "height": 5, "fx": 6, "fy": 6, "cx": 3, "cy": 2})",
                              R"({"width": 7, "height": 5, "fx": 9, "fy": 6, "cx": 3, "cy": 2})"}) {
        CHECK(
            holds(jsonRefusal(twoLenses(R"(, "registered_to_color": true)", other)), "to_color: true (allo"));
    }
    CHECK(holds(jsonRefusal(R"({"depth": )" + kLens + R"(, "depth_scale_m_per_unit": 0.001})"),
                "color: missing"));
    CHECK(holds(jsonRefusal(twoLenses("", R"({"width": 7})")), "color.height: missing"));
    CHECK(jsonRefusal(twoLenses(R"(, "registered_to_color": true)")) == "");
}

TEST_CASE("stamps that do not match the files in number are refused by their field") {
    const TemporaryFolder folder;
    writeSmallRecording(folder, 2);
    std::filesystem::remove(folder.path() / "associations.txt");
    const std::string lens = kSmallIntrinsics.substr(0, kSmallIntrinsics.size() - 1);
    folder.write("intrinsics.json", lens + R"(, "depth_stamps_s": [0], "color_stamps_s": [0, 1]})");
    CHECK(holds(recordingRefusal(folder.path()), "intrinsics.json: depth_stamps_s: 1 stamps (allowed: 2"));
    folder.write("intrinsics.json", lens + R"(, "depth_stamps_s": [0, 1], "color_stamps_s": [0, "1"]})");
    CHECK(holds(recordingRefusal(folder.path()), "intrinsics.json: color_stamps_s[1]: \"1\""));
    folder.write("intrinsics.json",
                 lens + R"(, "depth_stamps_s": [0, 1], "color_stamps_s": [0.4, 1.4], "nominal_fps": 1})");
    RecordedCamera camera(folder.path());
    CHECK(camera.next().value()->captureTime == 0.0);
    CHECK(camera.next().value()->captureTime == 1.0);
}

TEST_CASE("broken poses are refused with file and line") {
    const TemporaryFolder folder;
    writeSmallRecording(folder, 1);
    const auto message = [&](const std::string& text) {
        folder.write("poses.txt", text);
        return recordingRefusal(folder.path());
    };
    CHECK(holds(message("# none\n"), "poses.txt: poses: none"));
    CHECK(holds(message("0 0 0 0 0 0 0 1\n\n1 0 0 0 0 0 1\n"), "poses.txt: line 3: 1 0 0 0 0 0 1"));
    CHECK(holds(message("0 0 0 nan 0 0 0 1\n"), "poses.txt: line 1: "));
    CHECK(holds(message("0 0 0 0 0 0 0 0\n"), "non-zero length"));
    CHECK(holds(message("0 0 0 0 0 0 0 1\n0 0 0 0 0 0 0 1\n"), "later than in the previous line"));
}
