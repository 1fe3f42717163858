// SPDX-License-Identifier: Apache-2.0
// Fields of a lens file under the names of other programs, and its depth unit in every kind of recording.
#include "devices/recorded/recorded_camera.h"
#include "tests/devices/played_bag.h"
#include "tests/support/mentions.h"

using namespace fathom;
using namespace fathom::testing;

namespace {

const std::string kFourFields = R"({"width": 7, "height": 5, "fx": 6, "fy": 6, "cx": 3, "cy": 2, )";

// Plays one pair of numbered images with this lens file; returns the refusal, or empty.
std::string refusalWith(const std::string& lens, const SourceOptions& options = {}) {
    const TemporaryFolder folder;
    addPair(folder, "depth/0.png", "rgb/0.png", 500);
    folder.write("lens.json", lens);
    SourceOptions all = options;
    all.intrinsics = folder.path() / "lens.json";
    return recordingRefusal(folder.path(), all);
}

constexpr const char* kOwnScale = "(allowed: depth_scale_m_per_unit";

// A bag of 16-bit depth with the value 5000 everywhere, with this lens file.
BagCamera bagWith(const TemporaryFolder& folder, const std::string& lens, std::optional<double> scale = {},
                  const std::string& encoding = "16UC1") {
    BagMaker maker;
    addStream(maker, "/camera/depth/image_raw",
              {.encoding = encoding, .pixels = encoding == "16UC1" ? filled(uint16_t{5000}) : filled(0.5f)});
    folder.write("lens.json", lens);
    return playStreams(folder, maker, {.intrinsics = folder.path() / "lens.json", .scale = scale});
}

const std::string kBagLens = R"({"width": 8, "height": 6, "fx": 7, "fy": 7, "cx": 3.5, "cy": 2.5)";

} // namespace

TEST_CASE("A depth scale under the name of another program is refused with the name that is read") {
    for (const char* name : {"scale",
                             "png_depth_scale",
                             "depth_factor",
                             "depthFactor",
                             "DepthMapFactor",
                             "depthScale",
                             "depth_unit",
                             "depth_units",
                             "depth_scale_m",
                             "integer_depth_scale",
                             "depth_unit_scale_factor",
                             "m_depthShift",
                             "units_per_metre",
                             "scale_factor",
                             "Depth Map Factor",
                             "depth_scale",
                             "depth_to_meters",
                             "metres_per_unit",
                             "depth_divisor",
                             "depth_multiplier",
                             "depth_resolution",
                             "meter_scale",
                             "z_scale"}) {
        CAPTURE(name);
        for (const char* value : {"6553.5", "0.0001526"}) {
            const std::string field = "\"" + std::string(name) + "\": " + value + "}";
            const std::string refusal = refusalWith(kFourFields + field);
            mentions(refusal, std::string(name) + ": ");
            mentions(refusal, kOwnScale);
        }
    }
    mentions(refusalWith(R"({"width": 7, "height": 5, "intrinsic_matrix": [6, 0, 0, 0, 6, 0, 3, 2, 1],
                             "depth_factor": 5000})"),
             kOwnScale);
}

TEST_CASE("A second depth scale of millimetres, or one that scale= replaces, is not refused") {
    for (const char* fields :
         {R"("depth_factor": 1000})", R"("depth_units": 0.001})", R"("depth_unit": "mm"})", R"("scale": 1})",
          R"("units": "pixels"})", R"("depth_trunc": 3})", R"("depth_resolution": [640, 480]})",
          R"("pixels_per_meter": 3780})", R"("depth_info": {"scale": 0.001}})", R"("scale": null})",
          R"("depth_shift": 0})", R"("depth_factor": 5000, "depth_scale_m_per_unit": 0.0002})"}) {
        CAPTURE(fields);
        CHECK(refusalWith(kFourFields + fields) == "");
    }
    CHECK(refusalWith(kFourFields + R"("depth_factor": 5000})", {.scale = 0.0002}) == "");
    mentions(refusalWith(kFourFields + R"("depth_unit": "cm"})"), kOwnScale);
}

TEST_CASE("A depth scale in the block of depth, or distortion outside of those of two lenses, is refused") {
    const std::string lens = kFourFields.substr(0, kFourFields.size() - 2);
    const auto two = [&](const std::string& inDepth, const std::string& beside,
                         const std::string& inBoth = "") {
        return R"({"depth": )" + lens + inBoth + inDepth + R"(}, "color": )" + lens + inBoth + "}" + beside +
               R"(, "extrinsics_topic_tf": {"Color": {"t": [0.015, 0, 0], "q_xyzw": [0, 0, 0, 1]}}})";
    };
    for (const char* field : {R"(, "depth_scale_m_per_unit": 0.0001)", R"(, "depth_scale": 0.0001)",
                              R"(, "scale": 0.0001)", R"(, "units": "cm")"}) {
        CAPTURE(field);
        mentions(refusalWith(two(field, "")), "lens.json: depth.");
        mentions(refusalWith(two(field, "")), "(allowed: depth_scale_m_per_unit at the top level");
        CHECK(refusalWith(two(field, R"(, "depth_scale_m_per_unit": 0.0001)")) == "");
        CHECK(refusalWith(two(field, ""), {.scale = 0.0001}) == "");
    }
    CHECK(refusalWith(two(R"(, "depth_scale_m_per_unit": 0.001)", "")) == "");
    mentions(refusalWith(kFourFields + R"("depth_info": {"scale": 0.0002}})"), "depth_info.scale: 0.0002 (");
    for (const char* field : {R"(, "distortion": [0.1, 0, 0, 0])", R"(, "D": [0.1, 0, 0, 0, 0])",
                              R"(, "camera_model": "OPENCV_FISHEYE")"}) {
        CAPTURE(field);
        CHECK(refusalWith(two("", field)) != "");
        CHECK(refusalWith(two("", field, R"(, "distortion": [0.01, 0, 0, 0])")) == "");
    }
}

TEST_CASE("A bag's depth has the unit that the file of its lens states, unless scale= gives another") {
    const TemporaryFolder folder;
    BagCamera tenths = bagWith(folder, kBagLens + R"(, "depth_scale_m_per_unit": 0.0001})");
    CHECK(firstDepth(tenths) == doctest::Approx(0.5));
    BagCamera given = bagWith(folder, kBagLens + R"(, "depth_scale_m_per_unit": 0.0001})", 0.001);
    CHECK(firstDepth(given) == doctest::Approx(5.0));
    BagCamera none = bagWith(folder, kBagLens + "}");
    CHECK(firstDepth(none) == doctest::Approx(5.0));
    mentions(testing::refusalOf([&] { bagWith(folder, kBagLens + R"(, "depth_factor": 5000})"); }),
             kOwnScale);
    for (const char* unused : {R"(, "depth_factor": 5000})", R"(, "depth_scale_m_per_unit": 0.0001})"}) {
        BagCamera metres = bagWith(folder, kBagLens + unused, {}, "32FC1");
        CHECK(firstDepth(metres) == doctest::Approx(0.5));
    }
}

TEST_CASE("Two depth scales of one file that contradict each other have a warning with both") {
    const TemporaryFolder folder;
    const auto warnings = [&](const std::string& fields, std::optional<double> scale = {},
                              const std::string& encoding = "16UC1") {
        std::string all;
        for (const std::string& line :
             bagWith(folder, kBagLens + ", " + fields + "}", scale, encoding).warnings()) {
            all += line + "\n";
        }
        return all;
    };
    const std::string own = R"("depth_scale_m_per_unit": 0.001, )",
                      tum = R"("depth_scale_m_per_unit": 0.0002, )";
    mentions(warnings(own + R"("depth_factor": 5000)"),
             "the depth unit of lens.json is 0.001 m, which is used, but its depth_factor is 5000, a unit of "
             "0.0002 m; remove one, or append scale=M");
    for (const std::string& fields :
         {own + R"("png_depth_scale": 0.0002)", own + R"("depth_info": {"scale": 5000})",
          tum + R"("depth_factor": 1000)", tum + R"("depth_unit": 0.001)"}) {
        CAPTURE(fields);
        mentions(warnings(fields), "which is used, but its ");
    }
    for (const std::string& fields :
         {own + R"("depth_factor": 1000)", tum + R"("depth_factor": 5000)",
          own + R"("depth_scale": 0.0010000000474974513)", own + R"("depth_trunc": 3)",
          own + R"("scale": 0.05)", own + R"("depth_shift": 0.02)", own + R"("depth_resolution": 640)",
          own + R"("depth_unit_um": 250)", own + R"("depthUnitMicrometres": 250)",
          own + R"("depth_noise_scale": 0.005)", own + R"("depth_noise_factor": 0.01)",
          own + R"("depth_scale": 1)", own + R"("depth_unit": "mm")", own + R"("depth_scale": null)"}) {
        CAPTURE(fields);
        CHECK(warnings(fields) == "");
    }
    CHECK(warnings(own + R"("depth_factor": 5000)", 0.0002) == "");
    CHECK(warnings(own + R"("depth_factor": 5000)", {}, "32FC1") == "");
}

TEST_CASE("Distortion under the name of another program is refused unless it is zero") {
    for (const char* name : {"distCoeffs",
                             "distortionCoeff",
                             "distortionCoefficients",
                             "distortion_params",
                             "Distortion",
                             "kc",
                             "distortion_parameters",
                             "radial_distortion",
                             "K1",
                             "k_1",
                             "k2",
                             "p1",
                             "dist_coefs",
                             "distort",
                             "dist",
                             "D",
                             "coeffs",
                             "distortion_coefficients",
                             "radial",
                             "tangential",
                             "radial_params",
                             "disto_k3",
                             "dist_params",
                             "cameraDistCoeffs",
                             "coefficients",
                             "lens_coeffs",
                             "lens_dist",
                             "coeff",
                             "coefs",
                             "distorsion",
                             "k0",
                             "kappa",
                             "xi",
                             "thin_prism"}) {
        CAPTURE(name);
        for (const char* value : {"[0.2, 0.05, 0, 0, 0]", "0.2", R"({"k1": 0.2})", "[[0.2], [0.05]]"}) {
            const std::string field = "\"" + std::string(name) + "\": " + value + "}";
            mentions(refusalWith(kFourFields + field), "(allowed: zeros, or the coefficients as a list");
        }
        for (const char* value : {"[0, 0.0, 0, 0, 0]", "0", R"({"k1": 0})", "[[0], [0]]", "null", "[]"}) {
            CAPTURE(value);
            CHECK(refusalWith(kFourFields + "\"" + std::string(name) + "\": " + value + "}") == "");
        }
    }
    CHECK(refusalWith(kFourFields + R"("k2": 0.1, "distortion": [0.01, 0.1, 0, 0, 0]})") == "");
    for (const char* list :
         {R"("params": [6, 6, 3, 2, 0.12, -0.25])", R"("lens_params": [0.12, -0.25])",
          R"("parameters": [6, 3, 2, 0.12])", R"("k": [0.12, -0.25, 0, 0])", R"("k": 0.12)"}) {
        mentions(refusalWith(kFourFields + list + "}"), "(allowed: zeros, or the coefficients as a list");
    }
    for (const char* list : {R"("params": [6, 6, 3, 2, 0, 0])", R"("K": [600, 0, 300, 0, 600, 200, 0, 0, 1])",
                             R"("k": [[6, 0, 3], [0, 6, 2], [0, 0, 1]])", R"("params": {"k": 0.1})",
                             R"("omega": 1, "phi": 2, "kappa": 3)", R"("is_fisheye": false)"}) {
        CAPTURE(list);
        CHECK(refusalWith(kFourFields + list + "}") == "");
    }
    CHECK(refusalWith(kFourFields + R"("undistorted": true, "distance": 3, "p": 4, "k10": 5})") == "");
}

TEST_CASE("Fields of a lens file that only sound like distortion, or repeat the pinhole, are not refused") {
    for (const char* field :
         {R"("attenuation_coefficients": [0.2, 0.1, 0.05])", R"("coefficient_count": 5)",
          R"("image_coeff": 1.5)", R"("radial_accuracy": 0.02)", R"("radial_resolution": 0.01)",
          R"("distance_apart": 0.05)", R"("distance_parallel": 1.5)", R"("min_distance_param": 0.3)",
          R"("prismatic": 2)", R"("camera_dist": 0.8)", R"("K": [6.01, 6.01, 3, 2])",
          R"("params": [6, 6, 2.9999, 2])", R"("params": [6.05, 3, 2])", R"("params": [12, 12, 6, 4])",
          R"("parameters": 4)", R"("k": 3)", R"("params": [6.5])", R"("params": 0.5)"}) {
        CAPTURE(field);
        CHECK(refusalWith(kFourFields + field + "}") == "");
    }
}

TEST_CASE("The model of a lens that bends rays is refused without its coefficients") {
    for (const char* model : {R"("camera_model": "OPENCV_FISHEYE")", R"("model": "fisheye")",
                              R"("distortion_model": "equidistant")", R"("camera_type": "kannala_brandt4")",
                              R"("lens_model": "omni")", R"("model": "double_sphere")"}) {
        CAPTURE(model);
        mentions(refusalWith(kFourFields + model + "}"),
                 "(allowed: a pinhole, or the coefficients as a list");
    }
    mentions(refusalWith(kFourFields + R"("is_fisheye": true, "distortion": [0.1, 0, 0, 0]})"),
             "is_fisheye: true (allowed: a pinhole, or the coefficients as a list");
    CHECK(refusalWith(
              kFourFields +
              R"("is_fisheye": true, "distortion_model": "equidistant", "distortion": [0.01, 0, 0, 0]})") ==
          "");
    for (const char* model : {R"("camera_model": "OPENCV")", R"("model": "Intel RealSense D435")",
                              R"("distortion_model": "plumb_bob")", R"("camera": "fisheye room")",
                              R"("sensor_type": "OmniVision OV9281")",
                              R"("distortion_model": "equidistant", "distortion": [0.01, 0, 0, 0])"}) {
        CAPTURE(model);
        CHECK(refusalWith(kFourFields + model + "}") == "");
    }
}

TEST_CASE("Lenses that the extrinsics of a folder place over a metre apart are refused as millimetres") {
    const auto refused = [](const std::string& t) {
        const TemporaryFolder folder;
        writeSmallRecording(folder, 1);
        const std::string pose = R"({"t": )" + t + R"(, "q_xyzw": [0, 0, 0, 1]})",
                          lens = kFourFields.substr(0, kFourFields.size() - 2) + "}";
        folder.write("intrinsics.json", R"({"depth": )" + lens + R"(, "color": )" + lens +
                                            R"(, "depth_scale_m_per_unit": 0.001, "extrinsics_topic_tf":
                                            {"Color": )" +
                                            pose + "}}");
        std::string lines = recordingRefusal(folder.path());
        writeSmallRecording(folder, 1);
        folder.write("e.json", pose);
        return lines + "\n" + recordingRefusal(folder.path(), {.extrinsics = folder.path() / "e.json"});
    };
    CHECK(refused("[0.015, 0, 0]") == "\n");
    for (const char* millimetres : {"[9, 0, 0.3]", "[15, 0, 0]"}) {
        const std::string lines = refused(millimetres);
        mentions(lines, "intrinsics.json: extrinsics_topic_tf.Color.t: ");
        mentions(lines, "e.json: t: ");
        mentions(lines.substr(lines.find('\n')),
                 " m between the lenses (allowed: at most 1 m; metres, not millimetres)");
    }
}

TEST_CASE("A camera model of BOP and a nested matrix of Open3D are refused with what is read instead") {
    const TemporaryFolder bop;
    addPair(bop, "depth/0.png", "rgb/0.png", 500);
    bop.write("scene_camera.json",
              R"({"0": {"cam_model": {"projection_params": [6, 6, 3, 2]}, "depth_scale": 1}})");
    mentions(recordingRefusal(bop.path()),
             "0.cam_K: missing (allowed: cam_K row by row, fx 0 cx, 0 fy cy, 0 0 1 "
             "with fx and fy above 0; cam_model is not read)");
    for (const char* matrix : {"[[6, 0, 3], [0, 6, 2], [0, 0, 1]]", "[6, 6, 3, 2]", "{}"}) {
        mentions(refusalWith(R"({"width": 7, "height": 5, "intrinsic_matrix": )" + std::string(matrix) + "}"),
                 "(allowed: nine numbers in column-major order: fx, 0, 0, 0, fy, 0, cx, cy, 1)");
    }
}
