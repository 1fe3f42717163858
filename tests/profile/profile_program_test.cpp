// SPDX-License-Identifier: Apache-2.0
// `fathom profile --quick` as a program: every study runs, verifies its results and writes complete files
// with the documented fields. Only the duration of the whole run is checked, no other times.
#include "tests/profile/quick_run.h"

#include "engine/types/joined.h"
#include "engine/types/version.h"
#include "tests/support/sanitized.h"

#include <algorithm>
#include <map>

using namespace fathom;
using namespace fathom::testing;
using fathom::profile::Settings;

TEST_CASE("A quick profile verifies every study and exits with code 0") {
    const QuickRun& run = quickRun();
    CHECK(run.program.exitCode == 0);
    CHECK(run.program.err.find("error") == std::string::npos);
    REQUIRE(run.report["studies"].size() == profile::allStudies().size());
    for (const auto& entry : profile::allStudies()) {
        const auto& study = run.study(entry.name);
        CHECK(study["rows"].size() >= 2);
        CHECK(!study["verified"].get<std::string>().empty());
    }
}

TEST_CASE("A quick profile reports a duration below two minutes") {
    if (kSanitized) {
        MESSAGE("SKIPPED: a sanitized program is slower by what its checks cost");
        return;
    }
    const auto& report = quickRun().report;
    const double wall = report["run_seconds"], cpu = report["run_cpu_seconds"];
    CHECK(wall > 1.0);
    CHECK(cpu > 1.0);
    const bool alone = wall < 1.3 * cpu; // beside other suites also processor time grows, up to twofold
    CHECK(std::min(wall, cpu) < (alone ? 120.0 : 240.0));
}

TEST_CASE("Given a recording, each study names it or says that it does not use one") {
    Settings settings;
    CHECK(profile::servedBy("query", settings) == "frames made for it");
    settings.source = "data/valve_ball_d435/";
    CHECK(profile::servedBy("filter", settings) == "the recording valve_ball_d435");
    CHECK(profile::servedBy("query", settings) ==
          "frames made for it; this study has no use for --source valve_ball_d435");
    for (const auto& entry : profile::allStudies()) {
        CHECK(quickRun().study(entry.name)["served"] == "frames made for it");
    }
}

TEST_CASE("Every study writes a table and an image under its name, and the report embeds the images") {
    const auto out = quickRun().folder.path() / "out";
    const std::string html = textOf(out / "report.html");
    for (const auto& entry : profile::allStudies()) {
        const auto table = tableOf(out / (std::string(entry.name) + ".csv"));
        REQUIRE(table.size() >= 2);
        for (const auto& row : table) {
            CHECK(row.size() == table.front().size());
        }
        CHECK(startsWith(textOf(out / (std::string(entry.name) + ".png")), "\x89PNG"));
        CHECK(html.find("<h2 id=" + std::string(entry.name) + ">") != std::string::npos);
    }
    CHECK(html.find("data:image/png;base64,iVBOR") != std::string::npos);
    CHECK(html.find("<img") != std::string::npos);
    CHECK(html.find("src=\"http") == std::string::npos); // self-contained
}

TEST_CASE("The report names the device, its driver, the settings and the clocks of every row") {
    const QuickRun& run = quickRun();
    const auto& facts = run.report["facts"];
    CHECK(facts["device"].get<std::string>().find("llvmpipe") != std::string::npos);
    CHECK(facts["command"] == "fathom --device llvmpipe profile --quick --out DIR");
    CHECK(facts["version"] == version());
    CHECK(facts["date"].get<std::string>().size() == std::string("2026-01-01T00:00:00Z").size());
    CHECK(facts["filter_radius_pixels"] == "2");
    CHECK(facts["filter_sigma_m"] == "0.01");
    CHECK(facts["region_radius_m"] == "0.04");
    CHECK(facts["error_budget_m"] == "0.0001");
    CHECK(facts["hold_s"] == "0.5");
    CHECK(std::stoul(facts["publishers"].get<std::string>()) >= 1);
    for (const char* name : {"driver", "host_cpu", "host_cpus", "LP_NUM_THREADS", "load_average", "source",
                             "scene", "quick", "build"}) {
        CHECK_MESSAGE(!facts[name].get<std::string>().empty(), name);
    }
    for (const auto& study : run.report["studies"]) {
        for (const auto& row : study["rows"]) {
            for (const char* clock : {"gpu", "submit_to_result", "cpu", "wall"}) {
                for (const char* rank : {"_p50_ms", "_p90_ms", "_p99_ms"}) {
                    CHECK(row.contains(std::string(clock) + rank));
                }
                const auto& low = row[std::string(clock) + "_p50_ms"];
                const auto& high = row[std::string(clock) + "_p90_ms"];
                CHECK(low.is_null() == high.is_null());
                CHECK(
                    (low.is_null() || (low.get<double>() <= high.get<double>() && low.get<double>() >= 0.0)));
                CHECK((row[std::string(clock) + "_p99_ms"].is_null() || row["repeats"] >= 100));
            }
        }
    }
}

TEST_CASE("Every study says whether each default is on the front and if not, why, or why it has no default") {
    const auto out = quickRun().folder.path() / "out";
    const std::string html = textOf(out / "report.html");
    for (const auto& entry : profile::allStudies()) {
        CAPTURE(std::string(entry.name));
        const auto& study = quickRun().study(entry.name);
        CHECK(study["defaults"].empty() == study["no_default"].is_string());
        size_t defaults = 0;
        for (const auto& row : study["rows"]) {
            defaults += row["default"].get<bool>() ? 1 : 0;
        }
        CHECK(study["defaults"].size() == defaults);
        std::map<std::string, size_t> said; // judgements in the table
        const auto table = tableOf(out / (std::string(entry.name) + ".csv"));
        CHECK(table.front().back() == "default_judgement");
        for (size_t i = 1; i < table.size(); ++i) {
            ++said[table[i].size() == table.front().size() ? table[i].back() : std::string()];
        }
        for (const auto& verdict : study["defaults"]) {
            std::string words = verdict["words"];
            CHECK((verdict["on_front"].get<bool>()
                       ? words == "lies on the Pareto front"
                       : words.find("; it stays the default: ") < words.size() - 40));
            CHECK(html.find(words.substr(0, words.find('\''))) != std::string::npos);
            std::replace(words.begin(), words.end(), ',', ';');
            CHECK(said[words] > 0);
        }
        if (study["no_default"].is_string()) {
            const std::string why = study["no_default"];
            CHECK(why.size() > 20);
            CHECK(html.find("No default to judge: " + why) != std::string::npos);
        }
    }
}

TEST_CASE("Every study that ranks settings marks its default and says whether it is on the front") {
    for (const char* name : {"filter", "fixture", "query", "solver", "precision"}) {
        const auto& study = quickRun().study(name);
        size_t defaults = 0, said = 0, front = 0;
        for (const auto& row : study["rows"]) {
            defaults += row["default"].get<bool>() ? 1 : 0;
            front += row["on_front"].get<bool>() ? 1 : 0;
        }
        for (const std::string finding : study["findings"]) {
            said += startsWith(finding, "default '") ? 1 : 0;
        }
        CHECK_MESSAGE(defaults > 0, name);
        CHECK_MESSAGE(said == defaults, name);
        CHECK_MESSAGE(front > 0, name);
    }
}

TEST_CASE("--trace writes uploads, passes, queries and ticks on one timeline") {
    const auto trace = nlohmann::json::parse(textOf(quickRun().folder.path() / "trace.json"));
    std::map<std::string, size_t> spans;
    std::map<std::pair<int, double>, double> ends; // [us] by track and begin
    for (const auto& event : trace["traceEvents"]) {
        if (event["ph"] == "X") {
            ++spans[event["name"]];
            const double begin = event["ts"], duration = event["dur"];
            CHECK(duration >= 0.0);
            ends[{event["tid"], begin}] = begin + duration;
        }
    }
    REQUIRE(!ends.empty());
    for (auto span = ends.begin(), next = std::next(span); next != ends.end(); ++span, ++next) {
        const bool oneTrack = span->first.first == next->first.first;
        const bool apart = span->second <= next->first.second + 0.01;
        const bool inside = next->second <= span->second + 0.01;
        CHECK_MESSAGE((!oneTrack || apart || inside), "spans overlap at ", next->first.second, " us");
    }
    for (const char* name : {"upload", "classify", "surface", "spheres", "query", "turn"}) {
        CHECK_MESSAGE(spans[name] >= 10, name);
    }
}

TEST_CASE("An unknown study is rejected in one line that lists the known ones") {
    const ScratchFolder folder;
    const ProgramRun run = runFathom({"profile", "filtre", "--out", (folder.path() / "out").string()});
    CHECK(run.exitCode == 2);
    REQUIRE(run.errorLines().size() == 1);
    CHECK(run.errorLines().front() == "fathom: profile: STUDY: 'filtre', did you mean 'filter'? (allowed: " +
                                          joined(profile::allStudies(), &profile::StudyEntry::name) + ")");
}

TEST_CASE("A recording gives the scatter between its frames") {
    const std::filesystem::path recording = "../shared/data/valve_globe_d435";
    if (!std::filesystem::exists(recording)) {
        MESSAGE("SKIPPED: ../shared/data/valve_globe_d435 is absent");
        return;
    }
    const ScratchFolder folder;
    const auto out = folder.path() / "out";
    const ProgramRun run = runFathom({"--device", "llvmpipe", "profile", "filter", "--quick", "--source",
                                      recording.string(), "--out", out.string()});
    CHECK(run.exitCode == 0);
    const auto report = nlohmann::json::parse(textOf(out / "profile.json"));
    CHECK(report["facts"]["source"] == "valve_globe_d435");
    CHECK(report["studies"][0]["served"] == "the recording valve_globe_d435");
    CHECK(report["studies"][0]["error"] == "scatter between repeats");
    for (const auto& row : report["studies"][0]["rows"]) {
        CHECK(row["error"].get<double>() > 0.1); // [mm] the D435's own noise at this range
        CHECK(row["error"].get<double>() < 20.0);
    }
}

TEST_CASE("A source that is no folder is rejected before the work, with what it is") {
    const ScratchFolder folder;
    folder.write("rec.bag", "");
    std::filesystem::create_directory(folder / "rec");
    for (const auto& [source, what] :
         {std::pair("rec.bag", "rec.bag: --source: a file (allowed: a recording folder"),
          std::pair("rec,colour=none", "--source: options after a comma"),
          std::pair("none", "none: --source: missing")}) {
        const ProgramRun run = runFathom({"profile", "filter", "--quick", "--source",
                                          (folder / source).string(), "--out", (folder / "out").string()});
        CHECK(run.exitCode == 2);
        REQUIRE(run.errorLines().size() == 1);
        CHECK_MESSAGE(run.err.find(what) != std::string::npos, run.err);
        CHECK_FALSE(std::filesystem::exists(folder / "out"));
    }
}

TEST_CASE("Studies of regions reject a scene whose classes select nothing, and name it") {
    const ScratchFolder folder;
    const std::string scene = (folder / "nothing.yaml").string();
    folder.write("nothing.yaml",
                 "fixtures: [{name: a, role: forbidden, hue: [180, 181], saturation: [0.99, 1]}]\n"
                 "tool: {spheres: [[0, 0, 0, 0.01]]}\n");
    for (const char* study : {"fixture", "feel"}) {
        const ProgramRun run = runFathom({"--device", "llvmpipe", "profile", study, "--quick", "--scene",
                                          scene, "--out", (folder / "out").string()});
        CHECK(run.exitCode == 2);
        CHECK_MESSAGE(run.err.find(scene + ": fixtures: no forbidden class has points") != std::string::npos,
                      run.err);
    }
}
