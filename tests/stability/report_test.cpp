// SPDX-License-Identifier: Apache-2.0
// The stability command: case names, files and verdicts.
#include "apps/stability/stability_plots.h"
#include "apps/stability/stability_report.h"
#include "engine/types/error.h"
#include "tests/support/scratch_folder.h"

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

using namespace fathom;
using namespace fathom::stability;
using namespace fathom::testing;

namespace {

Outcome outcome(double figure, double limit, const char* relation = "<=") {
    Outcome o;
    o.figure = figure;
    o.limit = limit;
    o.unit = std::string("m");
    o.relation = std::string(relation);
    o.note = std::string("a note");
    return o;
}

std::vector<CaseResult> someResults() {
    std::vector<CaseResult> results;
    results.push_back({"solver-good", Group::Solver, outcome(1e-12, 1e-9), 0.5});
    results.push_back({"stiff-boundary", Group::Stiff, outcome(0.97, 0.95, ">="), 1.0});
    results.back().outcome.curves.push_back(
        {"measured", "b [N s/m]", "K [N/m]", {0.1, 0.5, 2.0}, {200, 1000, 4000}, true, true});
    results.back().outcome.curves.push_back(
        {"theory", "b [N s/m]", "K [N/m]", {0.1, 0.5, 2.0}, {210, 990, 4100}, true, true});
    results.back().outcome.curves.push_back(
        {"other axes", "t [s]", "x [m]", {0.0, 1.0}, {0.0, std::nan("")}, false, false});
    return results;
}

} // namespace

TEST_CASE("The suite has at least sixty cases in ten groups, each with a unique name") {
    const std::vector<Case> all = allCases([]() -> gpu::Device& { throw Error("no case runs here"); });
    CHECK(all.size() >= 60);
    std::set<Group> groups;
    for (const Case& one : all) {
        groups.insert(one.group);
        CHECK(one.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-_") == std::string::npos);
    }
    CHECK(groups.size() == 10);
}

TEST_CASE("Cases are selected by name or group in the suite's order, and an unknown name is rejected with "
          "the groups") {
    const std::vector<Case> all{
        {"a-1", Group::Solver, {}}, {"b-1", Group::Stiff, {}}, {"b-2", Group::Stiff, {}}};
    CHECK(chosenCases(all, {}).size() == 3);
    const auto chosen = chosenCases(all, {"stiff", "a-1"});
    REQUIRE(chosen.size() == 3);
    CHECK(chosen[0].name == "a-1");
    CHECK(chosenCases(all, {"b-2"}).front().name == "b-2");
    try {
        chosenCases(all, {"a-1", "nonsense"});
        FAIL("an unknown name was taken");
    } catch (const BadInput& e) {
        CHECK(e.exitCode() == 2);
        const std::string text = e.what();
        CHECK(text.find("'nonsense'") != std::string::npos);
        CHECK(text.find("long-run") != std::string::npos);
        CHECK(text.find("--list") != std::string::npos);
        CHECK(text.find("b-2") == std::string::npos); // the full suite has far too many for a line
    }
}

TEST_CASE("The list of cases has one line per case, its group and its name") {
    std::ostringstream list;
    listCases(list, {{"a-1", Group::Solver, {}}, {"b-1", Group::LongRun, {}}});
    CHECK(list.str() == "solver    a-1\nlong-run  b-1\n");
}

TEST_CASE("A case that throws or has a NaN figure does not hold") {
    const CaseResult thrown = runCase(
        {"x", Group::Solver, [](RunLength) -> Outcome { throw Error("what happened"); }}, RunLength::Short);
    CHECK(!thrown.outcome.holds());
    CHECK(thrown.outcome.note.find("what happened") != std::string::npos);
    CHECK(!outcome(std::nan(""), 1.0).holds());
    CHECK(!outcome(std::nan(""), 1.0, ">=").holds());
    CHECK(outcome(1.0, 1.0).holds());
    CHECK(!outcome(1.0 + 1e-15, 1.0).holds());
}

TEST_CASE(
    "stability.json has the documented fields, null for non-finite figures, and the verdict of all cases") {
    auto results = someResults();
    const auto good = nlohmann::json::parse(toJson(results, "a device \xff"));
    CHECK(good["holds"] == true);
    CHECK(good["device"].is_string());
    REQUIRE(good["cases"].size() == 2);
    const auto& first = good["cases"][0];
    for (const char* key : {"name", "group", "figure", "unit", "limit", "holds", "note"}) {
        CHECK(first.contains(key));
    }
    CHECK(first.size() == 7);
    CHECK(first["group"] == "solver");
    CHECK(first["figure"] == 1e-12);
    results[0].outcome.figure = std::numeric_limits<double>::infinity();
    const auto bad = nlohmann::json::parse(toJson(results, "d"));
    CHECK(bad["cases"][0]["figure"].is_null());
    CHECK(bad["cases"][0]["holds"] == false);
    CHECK(bad["holds"] == false);
    CHECK(nlohmann::json::parse(toJson({}, "d"))["cases"].empty());
}

TEST_CASE("The output folder has the report and the plots, one image for each pair of axes") {
    const ScratchFolder folder;
    const auto results = someResults();
    writeReport(folder.path(), results, "device | with a bar");
    writePlots(folder.path(), results);
    for (const char* name :
         {"stability.json", "stability.md", "margins.png", "stiff-boundary.png", "stiff-boundary-2.png"}) {
        CHECK(std::filesystem::file_size(folder.path() / name) > 100);
    }
    CHECK(!std::filesystem::exists(folder.path() / "solver-good.png"));
    const std::string table = toMarkdown(results, "device | with a bar");
    CHECK(table.find("## stiff (1 of 1 hold)") != std::string::npos);
    CHECK(table.find("0.97 >= 0.95 m") != std::string::npos);
    writePlots(folder.path(), {});
}
