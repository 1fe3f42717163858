// SPDX-License-Identifier: Apache-2.0
// `fathom plan`: what a scene needs, what it does not, and why; and that a replay runs exactly that. Also
// progress, which only a terminal shows.
#include "tests/rig/stage.h"

#include <doctest/doctest.h>
#include <map>
#include <set>
#include <sstream>

using namespace fathom;

namespace {

struct Item {
    bool in;
    std::string why;
};

// Items by "kind name". Each must be in or out and give the reason.
std::map<std::string, Item> planOf(const Stage& stage) {
    const ProgramRun run =
        runFathom({"plan", (stage / "scene.yaml").string(), "--source", (stage / "rec").string()});
    REQUIRE_MESSAGE(run.exitCode == 0, run.err);
    CHECK(run.err == "");
    CHECK(run.out.find((stage / "scene.yaml").string()) != std::string::npos);
    CHECK(run.out.find("64x48") != std::string::npos);
    std::map<std::string, Item> items;
    std::istringstream lines(run.out);
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string in, kind;
        words >> in >> kind;
        if ((in != "in" && in != "out") || (kind != "pass" && kind != "buffer" && kind != "thread")) {
            continue;
        }
        CAPTURE(line);
        const size_t gap = line.find("  ", 13); // the name ends at two spaces
        REQUIRE(gap != std::string::npos);
        const size_t mib = line.find("MiB"),
                     why = line.find_first_not_of(' ', mib == std::string::npos ? gap : mib + 3);
        REQUIRE(why != std::string::npos);
        CHECK((mib == std::string::npos || in == "in")); // an item that is out uses no memory
        items[kind + " " + line.substr(13, gap - 13)] = {in == "in", line.substr(why)};
    }
    CHECK(items.size() >= 15);
    return items;
}

// Checks that a replay reports times for exactly the passes of the plan.
void checkRunsThat(const Stage& stage, const std::map<std::string, Item>& plan) {
    std::set<std::string> planned{"upload_ms", "publish_ms", "answerable_ms"};
    for (const auto& [name, item] : plan) {
        if (item.in && name.starts_with("pass ") && name != "pass tree_query") {
            planned.insert(name.substr(5) + "_ms");
        }
    }
    stage.hand({{0.0, {0.0, 0.0, 0.4}}});
    const Replay replay = stage.replay();
    CHECK(std::set<std::string>(replay.timeColumns.begin(), replay.timeColumns.end()) == planned);
    const std::string where = replay.summary.at("contact").at("where");
    CHECK(plan.at("pass tree_query").in == (where == "gpu"));
}

} // namespace

TEST_CASE("The plan of a scene with everything contains every pass and says what each is for") {
    Stage stage;
    stage.recording({bumpImage()});
    SceneText scene;
    scene.fixtures.push_back(SceneText::kGuideYellow);
    stage.scene(scene);
    const auto plan = planOf(stage);
    for (const char* name : {"pass classify", "pass surface", "pass thin", "pass spheres", "pass moments",
                             "buffer colour upload", "buffer memory of points", "thread contact"}) {
        CAPTURE(name);
        CHECK(plan.at(name).in);
    }
    CHECK(!plan.at("pass occlusion").in);
    CHECK(plan.at("pass occlusion").why.find("registered") != std::string::npos);
    CHECK(!plan.at("pass tree").in);
    CHECK(plan.at("pass tree").why.find("grid") != std::string::npos);
    CHECK(plan.at("pass surface").why.find("5x5") != std::string::npos);
    checkRunsThat(stage, plan);
}

TEST_CASE("Without filter, hold, thinning, colour or guidance, each is out of the plan, with the reason") {
    Stage stage;
    stage.recording({bumpImage()});
    SceneText scene;
    scene.fixtures = {"name: all, role: forbidden"};
    scene.filter = "radius: 0";
    scene.more = "error_budget: 0\nhold_s: 0\n";
    stage.scene(scene);
    const auto plan = planOf(stage);
    CHECK(plan.at("pass surface").why.find("no filter") != std::string::npos);
    const std::map<std::string, std::string> out{{"pass thin", "error budget 0"},
                                                 {"pass moments", "no guidance"},
                                                 {"pass occlusion", "no class uses colour"},
                                                 {"buffer colour upload", "no class uses colour"},
                                                 {"buffer memory of points", "hold_s is 0"},
                                                 {"buffer rays", "no lens distortion"}};
    for (const auto& row : out) {
        CAPTURE(row.first);
        CHECK(!plan.at(row.first).in);
        CHECK(plan.at(row.first).why.find(row.second) != std::string::npos);
    }
    checkRunsThat(stage, plan);
}

TEST_CASE("Guidance alone needs no spheres, tree or query; shapes alone need no pass at all") {
    Stage stage;
    stage.recording({bumpImage()});
    SceneText scene;
    scene.fixtures = {SceneText::kGuideYellow};
    stage.scene(scene);
    const auto guidance = planOf(stage);
    CHECK(guidance.at("pass moments").in);
    for (const char* name : {"pass thin", "pass spheres", "pass tree", "pass tree_query", "thread contact"}) {
        CAPTURE(name);
        CHECK(!guidance.at(name).in);
    }
    checkRunsThat(stage, guidance);

    scene.fixtures = {"name: wall, role: forbidden, shape: plane, base_T_shape: {xyz: [0, 0, -1]}"};
    stage.scene(scene);
    const auto shapes = planOf(stage);
    for (const auto& row : shapes) {
        CAPTURE(row.first);
        CHECK((row.first.starts_with("thread") || !row.second.in));
    }
    checkRunsThat(stage, shapes);
    const std::string scenePath = (stage / "scene.yaml").string(), source = (stage / "rec").string();
    CHECK(runFathom({"plan", scenePath, "--source", source, "--device", "nosuch"})
              .out.find("note    --device nosuch is not used: no fixture uses points\n") !=
          std::string::npos);
}

TEST_CASE("Keys that a class's role does not use are a note in the plan and a line in the log of a replay") {
    Stage stage;
    stage.recording({bumpImage()});
    SceneText scene;
    scene.fixtures.push_back(std::string(SceneText::kGuideYellow) + ", radius: 0.02");
    stage.scene(scene);
    stage.hand({{0.0, {0.0, 0.0, 0.4}}});
    const std::string note = "fixture 'yellow': radius: no effect with role guidance, only with forbidden";
    const ProgramRun plan =
        runFathom({"plan", (stage / "scene.yaml").string(), "--source", (stage / "rec").string()});
    CHECK(plan.out.find("note    " + note + "\n") != std::string::npos);
    const ProgramRun run = runFathom(stage.command({"--strict"})); // no warning of the run
    CHECK(run.exitCode == 0);
    CHECK(run.err.find(note) != std::string::npos);
}

TEST_CASE("The plan notes that a line or an axis holds the tool with any role, without a button") {
    Stage stage;
    stage.recording({bumpImage()});
    SceneText scene;
    scene.fixtures = {"name: rail, role: guidance, shape: line", "name: bore, role: forbidden, shape: axis",
                      "name: wall, role: forbidden, shape: plane, base_T_shape: {xyz: [0, 0, -1]}"};
    stage.scene(scene);
    const ProgramRun plan =
        runFathom({"plan", (stage / "scene.yaml").string(), "--source", (stage / "rec").string()});
    REQUIRE_MESSAGE(plan.exitCode == 0, plan.err);
    CHECK(plan.out.find("note    fixture 'rail': a line holds the tool with any role") != std::string::npos);
    CHECK(plan.out.find("note    fixture 'bore': an axis holds the tool with any role") != std::string::npos);
    CHECK(plan.out.find("no button switches it") != std::string::npos);
    CHECK(plan.out.find("fixture 'wall'") == std::string::npos);
}

TEST_CASE("The plan names a missing hand path and a joint without an axis, which a replay would reject") {
    const Stage stage;
    stage.write("arm41.urdf", readWhole("apps/scenes/arm41.urdf"));
    stage.hand({{0.0, {0.0, 0.0, 0.0}}});
    const auto plan = [&](const std::string& axes, const std::string& path) {
        SceneText scene;
        scene.hand = "path: " + path;
        scene.more =
            "arm: {urdf: arm41.urdf, tip: tip, driver: {protocol: reach_alpha5, axes: [" + axes + "]}}\n";
        stage.scene(scene);
        const ProgramRun run = runFathom({"plan", (stage / "scene.yaml").string()});
        CHECK_MESSAGE(run.exitCode == 0, run.err);
        return run.out;
    };
    const std::string lacking = plan("{axis: base, joint: slew}", "none.csv");
    CHECK(lacking.find("arm.driver.axes: joint 'shoulder' has none (allowed: one axis per joint): --arm "
                       "rejects it\n") != std::string::npos);
    CHECK(lacking.find("none.csv: no such file: replay rejects it unless") != std::string::npos);
    const std::string whole = plan("{axis: base, joint: slew}, {axis: shoulder, joint: shoulder}, "
                                   "{axis: elbow, joint: elbow}, {axis: wrist, joint: wrist_roll}",
                                   "hand.csv");
    CHECK(whole.find("rejects it") == std::string::npos);
}

TEST_CASE("A scene that sets the query to the GPU gets it in the plan and in the run") {
    Stage stage;
    stage.recording({bumpImage()});
    SceneText scene;
    scene.contact = "where: gpu";
    stage.scene(scene);
    const auto plan = planOf(stage);
    CHECK(plan.at("pass tree_query").in);
    CHECK(plan.at("pass tree").in);
    checkRunsThat(stage, plan);
}

TEST_CASE("Every shipped scene file has a plan; the built-in scene needs no recording") {
    for (const char* scene : {"demo", "task1", "task2"}) {
        const ProgramRun run = runFathom({"plan", std::string("apps/scenes/") + scene + ".yaml"});
        CAPTURE(run.err);
        CHECK(run.exitCode == 0);
        CHECK(run.out.find("simulated tank") != std::string::npos);
    }
}

TEST_CASE("Progress appears on a terminal only and is removed at the end") {
    Stage stage;
    stage.recording(std::vector<Image>(3, bumpImage()));
    stage.hand({{0.0, {0.0, 0.0, 0.4}}, {0.5, {0.0, 0.0, 0.41}}});
    RunSetting setting;
    setting.terminal = true;
    ::setenv("TERM", "dumb", 1); // cannot erase a line
    CHECK(runFathom(stage.command(), setting).err == "");
    ::setenv("TERM", "xterm", 1);
    const ProgramRun seen = runFathom(stage.command(), setting);
    CHECK(seen.exitCode == 0);
    CHECK(seen.err.find("frame ") != std::string::npos);
    CHECK(seen.err.find("x real time") != std::string::npos);
    CHECK(seen.err.ends_with("\r\x1b[K"));
    CHECK(seen.err.find('\n') == std::string::npos);
    const ProgramRun silent = runFathom(stage.command());
    CHECK(silent.exitCode == 0);
    CHECK(silent.err == "");
    for (const ProgramRun& run : {seen, silent}) { // both print the result to standard output
        CHECK(run.out.find("digest") != std::string::npos);
        CHECK(run.out.find("\r") == std::string::npos);
        CHECK(run.out.find((stage / "out").string()) != std::string::npos);
    }
}
