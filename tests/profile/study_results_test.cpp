// SPDX-License-Identifier: Apache-2.0
// Results of the studies in a quick run: figures that hold on any machine, no times.
#include "apps/profile/frame_sequence.h"
#include "tests/profile/quick_run.h"
#include "tests/support/sanitized.h"
#include "tests/support/vulkan.h"

#include <algorithm>
#include <map>

using namespace fathom;
using namespace fathom::testing;

TEST_CASE(
    "The filter lowers the depth error of a smooth scene, and skipping patches does not change the error") {
    std::map<std::string, double> error;
    for (const auto& row : quickRun().study("filter")["rows"]) {
        if (row["source"] == "corner") {
            error[row["setting"]] = row["error"].get<double>();
        }
    }
    CHECK(error.at("5x5 s10mm") < 0.9 * error.at("none"));
    CHECK(error.at("5x5 s10mm") == error.at("5x5 s10mm all patches"));
}

TEST_CASE("Polynomial weights give nearly the same error as exact ones, but not exactly") {
    std::map<std::string, double> error;
    for (const auto& row : quickRun().study("filter")["rows"]) {
        if (row["source"] == "corner") {
            error[row["setting"]] = row["error"].get<double>();
        }
    }
    CHECK(error.at("5x5 s10mm polynomial") == doctest::Approx(error.at("5x5 s10mm")).epsilon(0.02));
    CHECK(error.at("5x5 s10mm polynomial") != error.at("5x5 s10mm"));
}

TEST_CASE("Solving on few rows and checking the rest is as exact as all rows; the worst row alone needs more "
          "solves") {
    std::map<std::string, nlohmann::json> rows;
    for (const auto& row : quickRun().study("solver")["rows"]) {
        if (startsWith(row["source"], "reduced rows, ")) {
            rows[row["setting"]] = row;
        }
    }
    const double all = rows.at("all rows")["error"];
    CHECK(all < 0.01);
    CHECK(rows.at("1 first")["error"].get<double>() == doctest::Approx(all).epsilon(1e-6));
    CHECK(rows.at("1 only")["strengthened_a_turn"].get<double>() >
          rows.at("1 first")["strengthened_a_turn"].get<double>());
    CHECK(rows.at("all rows")["share_in_contact"].get<double>() > 0.9);
}

TEST_CASE("Less precise formats have larger errors, and nodes rounded outwards lose no nearby sphere") {
    std::map<std::string, std::map<std::string, nlohmann::json>> rows;
    for (const auto& row : quickRun().study("precision")["rows"]) {
        rows[row["source"]][row["setting"]] = row;
    }
    for (const char* away : {"0.8", "8"}) {
        for (const char* what : {"centres ", "tree nodes "}) {
            auto& of = rows.at(std::string(what) + away + " m from the origin");
            const auto error = [&](const char* format) { return of.at(format)["error"].get<double>(); };
            CHECK(error("double") == 0.0);
            CHECK(error("double") < error("single"));
            CHECK(error("single") < error("half about the patch"));
            CHECK(error("half about the patch") < error("half"));
        }
        auto& nodes = rows.at(std::string("tree nodes ") + away + " m from the origin");
        const double exact = nodes.at("double")["nodes_found"];
        CHECK(exact > 0.0);
        CHECK(exact < nodes.at("double")["elements"].get<double>());
        CHECK(nodes.at("half about the patch")["nodes_found"].get<double>() >= exact);
        CHECK(nodes.at("half")["nodes_found"].get<double>() >= exact);
    }
    CHECK(rows.at("frame: depth pixels").at("half")["error"].get<double>() > 0.1); // [mm] at 0.8 m
    CHECK(rows.at("frame: depth pixels").at("16-bit sensor units")["error"].get<double>() < 1e-3);
    CHECK(rows.at("frame: filter weights").at("half weights")["error"].get<double>() > 0.0);
}

TEST_CASE("The boundary error stays within the budget, and a larger budget keeps fewer spheres") {
    std::map<std::string, nlohmann::json> rows;
    for (const auto& row : quickRun().study("fixture")["rows"]) {
        if (startsWith(row["source"].get<std::string>(), "plane")) {
            rows[row["setting"]] = row;
        }
    }
    CHECK(rows.at("0 mm")["error"] == 0.0);
    CHECK(rows.at("0.1 mm")["error"].get<double>() <= 0.102);
    CHECK(rows.at("1 mm")["error"].get<double>() <= 1.002);
    CHECK(rows.at("1 mm")["error"].get<double>() > 0.05);
    CHECK(rows.at("1 mm")["spheres"].get<double>() < 0.6 * rows.at("0 mm")["spheres"].get<double>());
}

TEST_CASE(
    "Error budgets are ranked by the time from upload to published, including collection and the grid") {
    const auto& study = quickRun().study("fixture");
    CHECK(study["time"] == "upload until published, p50");
    size_t front = 0;
    for (const auto& a : study["rows"]) {
        bool beaten = false;
        for (const auto& b : study["rows"]) {
            const double ta = a["upload_to_published_p50_ms"], tb = b["upload_to_published_p50_ms"],
                         ea = a["error"], eb = b["error"];
            beaten = beaten || (a["source"] == b["source"] && tb <= ta && eb <= ea && (tb < ta || eb < ea));
        }
        CHECK(a["on_front"].get<bool>() == !beaten);
        front += beaten ? 0 : 1;
    }
    CHECK(front >= 2);
}

TEST_CASE(
    "The spheres and the query of a budget belong to the first frame, regardless of the last measured one") {
    const gpu::Instance instance{testing::Vulkan::validation()};
    gpu::Device device(instance, "llvmpipe");
    profile::Settings settings;
    settings.quick = true;
    for (const auto& source : profile::studySources(settings, {"torus", "plane"}, 2)) {
        Scene scene = profile::studyScene(settings);
        scene.errorBudget = 0.0;
        scene.holdSeconds = 0.0;
        profile::FrameBench bench(device, scene, source.camera);
        bench.run(source.frames.back());
        const size_t last = bench.set().host.spheres.size();
        bench.run(source.frames.front());
        const size_t first = bench.set().host.spheres.size();
        CHECK(first != last); // otherwise the test shows nothing
        for (const auto& row : quickRun().study("fixture")["rows"]) {
            if (startsWith(row["source"], source.name) && row["setting"] == "0 mm") {
                CHECK(row["spheres"].get<size_t>() == first);
            }
        }
    }
}

TEST_CASE("Ticks and queries have separate wall and CPU times, each in its own column") {
    for (const char* name : {"solver", "tool", "query"}) {
        size_t rows = 0, same = 0;
        for (const auto& row : quickRun().study(name)["rows"]) {
            if (name == std::string("query") && !startsWith(row["source"], "answers ")) {
                continue;
            }
            ++rows;
            same += row["submit_to_result_p50_ms"] == row["cpu_p50_ms"] ? 1 : 0;
        }
        CHECK_MESSAGE(rows >= 4, name);
        CHECK_MESSAGE(same < rows, name);
    }
}

TEST_CASE("Larger frames take more time in every fitted step, and the exponents are reported") {
    size_t fitted = 0;
    for (const std::string finding : quickRun().study("scaling")["findings"]) {
        fitted += finding.find(" grows as x^") != std::string::npos ? 1 : 0;
    }
    CHECK(fitted >= 20);
    const auto& findings = quickRun().study("scaling")["findings"];
    for (const char* of :
         {"every point forbidden: ", "160x120, forbidden share: ", "160x120, 10 % forbidden, by classes: "}) {
        CHECK_MESSAGE(std::any_of(findings.begin(), findings.end(),
                                  [&](const std::string& f) {
                                      return startsWith(f,
                                                        std::string(of) + "upload to published grows as x^");
                                  }),
                      of);
    }
}

TEST_CASE("A row of the scaling study gives its size in exactly one of pixels, per cent or classes") {
    std::map<std::string, size_t> rows;
    for (const auto& row : quickRun().study("scaling")["rows"]) {
        size_t said = 0;
        for (const char* unit : {"pixels", "forbidden_percent", "classes"}) {
            said += row[unit].is_null() ? 0 : 1;
            rows[unit] += row[unit].is_null() ? 0 : 1;
        }
        CHECK(said == 1);
    }
    // three with noise, three without, seven formats of colour, two that the GPU answers
    CHECK(rows.at("pixels") == 15);
    CHECK(rows.at("forbidden_percent") == 3);
    CHECK(rows.at("classes") == 2);
}

TEST_CASE("Every format of colour has a row, with the time that the host would take to unpack it") {
    size_t formats = 0;
    for (const auto& row : quickRun().study("scaling")["rows"]) {
        if (const auto& ms = row["unpack_on_host_p50_ms"]; !ms.is_null()) {
            CHECK((ms == 0.0) == row["source"].get<std::string>().ends_with("colours RGBA"));
            ++formats;
        }
    }
    CHECK(formats == 7);
}

TEST_CASE("Sizes are measured with sensor noise, and separately without it") {
    std::map<std::string, std::map<std::string, double>> spheres;
    for (const auto& row : quickRun().study("scaling")["rows"]) {
        spheres[row["source"]][row["setting"]] = row["spheres"];
    }
    const auto& noisy = spheres.at("size, every point forbidden");
    const auto& smooth = spheres.at("size, every point forbidden, noise-free");
    CHECK(noisy.size() == smooth.size());
    CHECK(noisy.size() == 3);
    CHECK(smooth.at("400x300") <= noisy.at("400x300"));
}

TEST_CASE("Disabling a stage saves the memory of its buffers") {
    std::map<std::string, double> saved, heap, ms;
    for (const auto& row : quickRun().study("leave_out")["rows"]) {
        saved[row["setting"]] = row["memory_saved_MiB"].get<double>();
        heap[row["setting"]] = row["heap_saved_MiB"].get<double>();
        ms[row["setting"]] = row["share_of_frame_percent"].get<double>();
        const bool untimed = row["setting"] == "times of passes" || row["setting"] == "repeated frame";
        CHECK(row["gpu_p50_ms"].is_null() == untimed);
        CHECK(row["gpu_saved_ms"].is_null() == (row["setting"] == "times of passes"));
    }
    CHECK(saved.at("nothing left out") == 0.0);
    CHECK(saved.at("hold") > 1.0);
    CHECK(saved.at("forbidden class") > saved.at("hold"));
    CHECK(saved.at("filter") == 0.0);
    CHECK(saved.at("times of passes") == 0.0);
    CHECK(saved.at("colour, of gates that pass all") > 0.25); // one colour image
    CHECK(ms.at("repeated frame") > 90.0);                    // percentage: nothing runs
    for (const char* also : {"trimmed mean", "self-filter", "guidance points on the host (both)"}) {
        CHECK_MESSAGE(saved.count(also) == 1, also);
    }
    CHECK((kSanitized || heap.at("hold") > 1.0)); // lavapipe's buffers are in the heap
}

TEST_CASE("More leaves fit the gripper better, and covering spheres leave no gaps") {
    std::map<std::string, std::map<double, nlohmann::json>> rows;
    for (const auto& row : quickRun().study("tool")["rows"]) {
        rows[row["source"]][row["leaves"].get<double>()] = row;
    }
    for (const auto& row : rows) {
        CAPTURE(row.first);
        const auto& of = row.second;
        REQUIRE(of.size() == 2);
        CHECK(of.rbegin()->second["error"].get<double>() < 0.5 * of.begin()->second["error"].get<double>());
        CHECK(of.rbegin()->second["protrusion_mm"].get<double>() > 1.0);
        CHECK(of.rbegin()->second["share_in_contact"].get<double>() >= 0.9); // not a tick in free space
    }
    CHECK(rows.at("covers that fathom spheres makes").rbegin()->second["error"].get<double>() <
          0.5 * rows.at("covering spheres").rbegin()->second["error"].get<double>());
    CHECK(rows.at("covering spheres").rbegin()->second["gap_mm"].get<double>() <= 1e-6);
    CHECK(rows.at("smaller spheres, with gaps").rbegin()->second["gap_mm"].get<double>() > 0.1);
}
