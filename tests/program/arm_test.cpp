// SPDX-License-Identifier: Apache-2.0
// Runs the shipped scenes with an arm in full: the tasks of section VII of the paper in order, with the arm
// in the loop. Also what the section `arm:` rejects.
#include "tests/rig/program_refusal.h"
#include "tests/rig/stage.h"
#include "tests/support/sanitized.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <fstream>
#include <glm/geometric.hpp>
#include <sstream>

using namespace fathom;

namespace {

struct ArmRow {
    double t = 0.0, grasp = 0.0, residual = 0.0, violation = 0.0;
    std::vector<double> joints;
    int limits = 0, held = 0;
};

std::vector<ArmRow> readArm(const std::filesystem::path& file, size_t joints) {
    std::ifstream in(file);
    std::string line;
    std::getline(in, line);
    CHECK(line ==
          "t_s,slew,shoulder,elbow,wrist_roll,grasp,residual_m,manipulability,at_limits,limit_violation,"
          "singular,grasp_held,flipped");
    std::vector<ArmRow> rows;
    while (std::getline(in, line)) {
        std::vector<double> cells;
        std::istringstream text(line);
        for (std::string cell; std::getline(text, cell, ',');) {
            cells.push_back(std::strtod(cell.c_str(), nullptr));
        }
        REQUIRE(cells.size() == joints + 9);
        ArmRow row{cells[0], cells[joints + 1], cells[joints + 2], cells[joints + 5], {}, 0, 0};
        row.joints.assign(cells.begin() + 1, cells.begin() + 1 + static_cast<std::ptrdiff_t>(joints));
        row.limits = static_cast<int>(cells[joints + 4]);
        row.held = static_cast<int>(cells[joints + 7]);
        rows.push_back(row);
    }
    return rows;
}

struct ArmRun {
    Replay replay;
    std::vector<ArmRow> arm;

    const nlohmann::json& summary() const { return replay.summary.at("arm"); }
    const ArmRow& at(double t) const {
        return *std::find_if(arm.begin(), arm.end(), [&](const ArmRow& row) { return row.t >= t; });
    }
};

// Replays a shipped scene in lockstep and checks what holds for all of them.
ArmRun runShipped(const std::string& scene) {
    const TemporaryFolder folder;
    const std::filesystem::path out = folder.path() / "out";
    const ProgramRun run = runFathom({"replay", "apps/scenes/" + scene + ".yaml", "--out", out.string()});
    REQUIRE(run.exitCode == 0);
    ArmRun result{readReplay(out, run), readArm(out / "arm.csv", 4)};
    const nlohmann::json& arm = result.summary();
    double deepest = result.replay.haptic().at("max_penetration_m").get<double>();
    for (const auto& link : arm.at("links")) {
        deepest = std::max(deepest, link.at("max_penetration_m").get<double>());
        CHECK(link.at("leaves").get<int>() > 10);
    }
    CHECK(arm.at("links").size() == 7);
    CHECK(deepest <= 1e-5);
    CHECK(arm.at("limit_violation_max").get<double>() == 0.0);
    CHECK(result.arm.size() == result.replay.ticks.size());
    CHECK(result.replay.haptic().at("trapped_ticks").get<int>() == 0);
    MESSAGE(scene << ": " << arm.at("leaves") << " leaves, deepest " << deepest * 1e6 << " um, residual p50 "
                  << arm.at("residual_m").at("p50") << " max " << arm.at("residual_m").at("max")
                  << " m, turn p50 " << result.replay.haptic().at("turn_us").at("p50") << " p99 "
                  << result.replay.haptic().at("turn_us").at("p99") << " us");
    return result;
}

// An arm with the joint names of the shipped one and a ball on each link, which needs no sphere covering.
std::string ballArm() {
    const std::string ball = "<collision><geometry><sphere radius='0.02'/></geometry></collision></link>";
    const auto joint = [](const std::string& name, const std::string& parent, const std::string& child,
                          const std::string& lower, const std::string& upper) {
        return "<joint name='" + name + "' type='revolute'><parent link='" + parent + "'/><child link='" +
               child + "'/><origin xyz='0.1 0 0'/><axis xyz='0 0 1'/><limit effort='1' velocity='1' lower='" +
               lower + "' upper='" + upper + "'/></joint>";
    };
    return "<robot name='r'><link name='base'>" + ball + "<link name='column'>" + ball +
           "<link name='upper'>" + ball + "<link name='fore'>" + ball +
           joint("slew", "base", "column", "-1", "1") + joint("shoulder", "column", "upper", "0", "1") +
           joint("elbow", "upper", "fore", "-2.4", "-0.05") + "<link name='jaw'/>" +
           joint("pinch", "column", "jaw", "0", "0.5") + "</robot>";
}

// The red bump is around the arm's first ball. With a large padding the self-filter removes all of it.
void stageArmInBump(Stage& stage, const std::string& padding) {
    stage.recording(std::vector<Image>(3, bumpImage()));
    SceneText scene;
    scene.more = "arm: {urdf: arm41.urdf, base_T_arm: {xyz: [0, 0, 0.57]}, self_filter: " + padding + "}\n";
    scene.hand = "path: hand.csv";
    stage.scene(scene);
    stage.write("arm41.urdf", ballArm());
    stage.hand({{0.0, {0, 0, 0}}, {0.3, {0, 0.05, 0}}, {1.0, {0, 0, 0}}});
}

// Number of spheres in the last set that the window reports.
size_t spheresInWindow(const Stage& stage) {
    const ProgramRun run =
        runFathom({"operate", (stage / "scene.yaml").string(), "--source", (stage / "rec").string(),
                   "--device", "llvmpipe", "--offscreen", "640x480", "--seconds", "2", "--state",
                   (stage / "state").string(), "--folder", (stage / "made/shots").string()});
    INFO(run.err);
    REQUIRE(run.exitCode == 0);
    CHECK(std::filesystem::exists(
        stage / "made/shots/screenshot-1.png")); // in a folder that was made, on a busy device
    const std::string text = stage.read("state");
    const size_t from = text.rfind('\n', text.size() - 2);
    return nlohmann::json::parse(text.substr(from + 1)).at("run").at("spheres").get<size_t>();
}

void refused(const std::string& arm, const std::vector<std::string>& parts, const std::string& contact = "",
             const std::vector<std::string>& more = {}) {
    Stage stage;
    stage.recording({bumpImage()});
    SceneText scene;
    scene.contact = contact;
    stage.scene(scene);
    stage.write("scene.yaml", stage.read("scene.yaml") + "arm: {" + arm + "}\n");
    stage.write("arm41.urdf", ballArm());
    CAPTURE(arm);
    checkRefused(stage, parts, more);
}

} // namespace

TEST_CASE("A forbidden region holds off every link of the arm, and the arm stops at its joint limits") {
    const ArmRun run = runShipped("arm_valve");
    const nlohmann::json& arm = run.summary();
    // The hand feels the region that it pushes into, and the arm stays outside.
    CHECK(glm::length(run.replay.at(3.6).force) > 5.0);
    CHECK(run.replay.at(3.6).state == "contact");
    // Out of reach: the elbow is at its limit, which holds the hand without any contact.
    CHECK(run.at(13.0).joints[2] == doctest::Approx(-0.05));
    CHECK(run.at(13.0).limits > 0);
    CHECK(glm::length(run.replay.at(12.6).force) > 5.0); // later the hand withdraws
    CHECK(run.replay.at(13.0).contacts == 0);
    CHECK(run.replay.at(13.0).minGap > 0.005);
    CHECK(arm.at("limited_ticks").get<int>() > 500);
    // In the free space at first, the arm follows to the micrometre.
    CHECK(run.at(0.6).residual < 1e-6);
}

TEST_CASE("Guidance pulls the arm to the connector, and its jaw closes and opens there" *
          doctest::skip(kSanitized)) {
    const ArmRun run = runShipped("arm_wetmate");
    const auto& target = run.replay.summary.at("guidance").at(0).at("target_m");
    REQUIRE(target.is_array());
    const dvec3 goal(target.at(0), target.at(1), target.at(2));
    const double before = glm::distance(run.replay.at(2.95).tool.position, goal);
    const double pulled = glm::distance(run.replay.at(4.4).tool.position, goal);
    MESSAGE("jaw to connector: " << before * 1e3 << " mm before guidance, " << pulled * 1e3 << " mm with it");
    CHECK(run.replay.at(4.4).guidance == 1.0);
    CHECK(pulled < before - 0.0015); // guidance leads by at most F_g / K_t = 2 mm
    CHECK(run.at(4.4).grasp == 0.0);
    // Closed around the connector. The target, where the pull ends, is 30 mm in front of it.
    CHECK(run.at(6.0).grasp == 1.0);
    CHECK(glm::distance(run.replay.at(6.0).tool.position, goal) < 0.003);
    // In contact with the valve's region the button is released at 9.7 s and the jaw stays closed; away from
    // the region it opens.
    CHECK(run.at(9.6).held == 0);
    for (const double t : {9.8, 10.3, 11.0}) {
        CAPTURE(t);
        CHECK(run.at(t).held == 1);
        CHECK(run.at(t).grasp > 0.9);
        CHECK(run.replay.at(t).state == "contact");
    }
    CHECK(run.at(12.5).held == 0);
    CHECK(run.arm.back().grasp == 0.0);
}

TEST_CASE("The window removes the arm from the camera's points, as replay does") {
    for (const std::string padding : {"0.2", "0"}) {
        Stage stage;
        stageArmInBump(stage, padding);
        const ProgramRun run = runFathom(stage.command({"--realtime"}));
        INFO(run.err);
        REQUIRE(run.exitCode == 0);
        const Replay replay = readReplay(stage / "out", run);
        CAPTURE(padding);
        CHECK((spheresInWindow(stage) == 0) == (padding == "0.2"));
        CHECK((replay.frames.back().spheres == 0) == (padding == "0.2"));
    }
}

TEST_CASE("latency moves the arm of a scene that has one") {
    Stage stage;
    stageArmInBump(stage, "0.2");
    const ProgramRun run = runFathom({"latency", (stage / "scene.yaml").string(), "--source",
                                      (stage / "rec").string(), "--device", "llvmpipe", "--seconds", "0.5",
                                      "--load", "frames", "--out", (stage / "latency.json").string()});
    INFO(run.err);
    REQUIRE(run.exitCode == 0);
    const auto part = nlohmann::json::parse(stage.read("latency.json")).at("parts").at(0);
    CHECK(part.at("arm_travel").get<double>() > 0.05);
}

TEST_CASE("plan, and replay in one line, report a link with a visual but no collision shape") {
    Stage stage;
    stageArmInBump(stage, "0.2");
    std::string urdf = ballArm();
    urdf.replace(urdf.find("<link name='jaw'/>"), 18,
                 "<link name='jaw'><visual><geometry><sphere radius='0.1'/></geometry></visual></link>");
    stage.write("arm41.urdf", urdf);
    const std::string note = "link jaw has no collision shape and can enter regions";
    const ProgramRun plan =
        runFathom({"plan", (stage / "scene.yaml").string(), "--source", (stage / "rec").string()});
    CHECK(plan.exitCode == 0);
    CHECK(plan.out.find("        " + note + "\n") != std::string::npos);
    const ProgramRun run = runFathom(stage.command());
    CHECK(run.exitCode == 0);
    INFO(run.err);
    REQUIRE(run.errorLines().size() == 3);
    CHECK(run.err.find("fixture 'red' has no region in any frame") != std::string::npos);
    CHECK(
        run.err.find("arm41.urdf: tip fore (the end of the longest chain); base base (the root); arm.tip and "
                     "arm.base name others") != std::string::npos);
    CHECK(run.err.find("arm41.urdf: " + note) != std::string::npos);
    CHECK(plan.out.find("base base (the root), at base_T_arm\n") != std::string::npos);
    CHECK(plan.out.find(
              "        joint elbow: revolute, -2.4 to -0.05 rad (file), 1 rad/s (file), starts at -0.05\n") !=
          std::string::npos);
    CHECK(plan.out.find("        joint pinch stays at 0 (not between base and tip)\n") != std::string::npos);
}

TEST_CASE(
    "An invalid arm section is rejected in one line that names the field, the value and what is allowed") {
    const std::string urdf = "urdf: arm41.urdf, ";
    refused("", {"arm.urdf"});
    refused("urdf: nowhere.urdf", {"arm.urdf", "nowhere.urdf", "an existing URDF file"});
    refused(urdf + "tipp: x", {"tipp", "did you mean 'tip'"});
    refused(urdf + "locked: {elbow: 1}", {"locked elbow", "-2.4 to -0.05"});
    refused(urdf + "locked: {elbo: 1}", {"locked", "'elbo'"});
    refused(urdf + "locked: {elbow: x}", {"arm.locked.elbow", "a finite number"});
    refused(urdf + "locked: [elbow]", {"arm.locked", "a mapping"});
    refused(urdf + "keep_stray: 1", {"arm.keep_stray", "true or false"});
    refused(urdf + "tip: nothing", {"'nothing'", "fore"});
    refused(urdf + "base: base, tip: base", {"arm.tip", "base (", "a link with a moving joint"});
    refused(urdf + "joints: [{name: elbo}]", {"arm.joints[0].name", "'elbo'", "slew, shoulder, elbow"});
    refused(urdf + "joints: [{name: elbow, start: 1}]", {"arm.joints[0].start", "-2.4 to -0.05"});
    refused(urdf + "joints: [{name: elbow, lower: 1, upper: 0}]", {"arm.joints[0]", "lower <= upper"});
    refused(urdf + "joints: [{name: elbow}, {name: elbow}]", {"arm.joints[1].name", "each joint once"});
    refused(urdf + "joints: [{name: elbow, speed: 0}]", {"arm.joints[0].speed", "a number from"});
    refused(urdf + "self_filter: -1", {"arm.self_filter", "-1", "from 0 to 0.5"});
    refused(urdf + "direction: any", {"arm.direction", "any", "free"});
    refused(urdf + "grasp: {fingers: [{joint: thumb}]}", {"'thumb'", "outside the chain"});
    refused(urdf + "grasp: {fingers: [], button: 4}", {"arm.grasp", "button 4", "hand.map.clutch"});
    refused(urdf + "grasp: {fingers: [{joint: pinch, open: 0.6, closed: 0}]}",
            {"arm.grasp.fingers[0].open", "0.6", "0 to 0.5"});
    refused(urdf + "grasp: {fingers: [{joint: pinch, closed: -0.1}]}",
            {"arm.grasp.fingers[0].closed", "-0.1", "0 to 0.5"});
}

TEST_CASE("A missing driver of a real arm is rejected before the arm's files are read") {
    refused("urdf: arm41.urdf, tip: nothing", {"arm.driver: missing", "--arm names a serial port"}, "",
            {"--realtime", "--arm", "/dev/null"});
}
