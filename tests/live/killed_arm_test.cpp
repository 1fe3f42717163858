// SPDX-License-Identifier: Apache-2.0
// An arm whose engine is killed, stopped or left without its guardian while it moves.
#include "tests/rig/arm_stage.h"
#include "tests/support/sanitized.h"

#include <csignal>
#include <doctest/doctest.h>
#include <fcntl.h>
#include <fstream>
#include <sys/wait.h>
#include <unistd.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

// A replay on the stage that goes on meanwhile; what it says goes to the file "said".
class Engine {
public:
    explicit Engine(const Stage& stage)
        : id_(startFathom(stage.command({"--realtime", "--arm", (stage / "line").string()}),
                          stage / "said")) {}
    Engine(const Engine&) = delete;
    Engine& operator=(const Engine&) = delete;
    ~Engine() {
        if (id_ > 0) {
            kill();
        }
    }
    void signal(int number) const { ::kill(id_, number); }
    void kill() {
        signal(SIGKILL);
        wait();
    }
    int wait() { // exit code; -1 for one that a signal ended
        int status = 0;
        ::waitpid(id_, &status, 0);
        id_ = -1;
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    pid_t watchdog() const { // -1 = none
        const auto tasks = "/proc/" + std::to_string(id_) + "/task";
        for (const auto& task : std::filesystem::directory_iterator(tasks)) {
            std::ifstream children(task.path() / "children");
            for (pid_t child = 0; children >> child;) {
                std::ifstream words("/proc/" + std::to_string(child) + "/cmdline");
                const std::string text{std::istreambuf_iterator<char>(words), {}};
                if (text.find("arm-guardian") != std::string::npos) {
                    return child;
                }
            }
        }
        return -1;
    }

private:
    pid_t id_ = -1;
};

// An ECA keeps its speed until it is told another: left alone while it is homed, it goes to its stop, which
// is a quarter of a minute away.
void setUpEca(const Stage& stage, EcaSimulator& arm) {
    setUp(stage, kEca, pushing(30.0));
    stage.write("scene.yaml",
                stage.read("scene.yaml") +
                    "  joints: [{name: slew, speed: 0.25}, {name: shoulder, speed: 0.25, lower: 0.8}, "
                    "{name: elbow, speed: 0.25, lower: 0.4}]\n");
    arm.upper.fill(1.6);
    arm.angle.fill(1.5);
}

// A Reach goes on to its last setpoint, 0.05 rad ahead: this one takes so long for it.
void setUpSlowReach(const Stage& stage, ReachSimulator& arm) {
    setUp(stage, kReach, {{0.0, {0, 0, 0}}, {0.3, {0, 0, 0}}, {10.0, {0, 0, 0.1}}, {30.0, {0, 0, 0.1}}});
    setStart(arm);
    arm.speed.fill(0.005);
}

// What an arm goes on by until its guardian has told it: 0.2 s of silence, and a second for a machine that
// has other things to do.
constexpr double kUntold = 1.2;    // [s]
constexpr double kEcaHoming = 0.1; // [rad/s]

// Until the joint has rested for 0.3 s.
bool comesToRest(ArmBench& bench, const double& joint) {
    double before = -1e9;
    for (int still = 0, i = 0; i < 3000; ++i) {
        const double now = bench.with([&] { return joint; });
        still = now == before ? still + 1 : 0;
        before = now;
        if (still > 30) {
            return true;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
}

} // namespace

TEST_CASE("An ECA that is homed stands still once its engine is killed or crashes, far from its stop") {
    for (const int signal : {SIGKILL, SIGSEGV}) {
        CAPTURE(signal);
        const Stage stage;
        EcaSimulator arm;
        setUpEca(stage, arm);
        ArmBench bench(arm, stage / "line");
        Engine engine(stage);
        REQUIRE(bench.wait([&] { return arm.angle[0] < 1.45; }));
        const double killed = bench.with([&] { return arm.angle[0]; });
        engine.signal(signal);
        CHECK(engine.wait() == (kSanitized && signal == SIGSEGV ? 1 : -1)); // the sanitizer ends a crash
        CHECK(comesToRest(bench, arm.angle[0]));
        CHECK(killed - arm.angle[0] < kUntold * kEcaHoming);
    }
}

TEST_CASE("A Reach stands still before its last setpoint once its engine is killed, also on a line that came "
          "back") {
    for (const bool replugged : {false, true}) {
        CAPTURE(replugged);
        const Stage stage;
        ReachSimulator arm;
        setUpSlowReach(stage, arm);
        ArmBench bench(arm, stage / "line");
        Engine engine(stage);
        const double& shoulder = arm.position[4];
        const double start = shoulder;
        REQUIRE(bench.wait([&] { return std::abs(shoulder - start) > 0.01; }));
        if (replugged) {
            const pid_t first = engine.watchdog();
            CHECK(first > 0);
            bench.unplug();
            bench.plug();
            REQUIRE(bench.wait([&] { return engine.watchdog() > 0 && engine.watchdog() != first; }));
            CHECK(::kill(first, 0) != 0); // it left the line
            const double then = bench.with([&] { return shoulder; });
            REQUIRE(bench.wait([&] { return std::abs(shoulder - then) > 0.01; }));
        }
        const double killed = bench.with([&] { return shoulder; });
        engine.kill();
        CHECK(comesToRest(bench, shoulder));
        CHECK(std::abs(shoulder - killed) < kUntold * arm.speed[4]);
    }
}

TEST_CASE("An engine that is stopped loses the arm to its guardian, and has it again when it goes on") {
    const Stage stage;
    EcaSimulator arm;
    setUpEca(stage, arm);
    ArmBench bench(arm, stage / "line");
    Engine engine(stage);
    REQUIRE(bench.wait([&] { return arm.angle[0] < 1.45; }));
    const double stopped = bench.with([&] { return arm.angle[0]; });
    engine.signal(SIGSTOP);
    CHECK(comesToRest(bench, arm.angle[0]));
    const double rest = bench.with([&] { return arm.angle[0]; });
    CHECK(stopped - rest < kUntold * kEcaHoming);
    engine.signal(SIGCONT);
    CHECK(bench.wait([&] { return arm.angle[0] < rest - 0.02; }));
}

TEST_CASE("A guardian that is killed gets a successor, and the arm goes on") {
    const Stage stage;
    ReachSimulator arm;
    setUpSlowReach(stage, arm);
    arm.speed.fill(0.05);
    ArmBench bench(arm, stage / "line");
    Engine engine(stage);
    const double& shoulder = arm.position[4];
    const double start = shoulder;
    REQUIRE(bench.wait([&] { return std::abs(shoulder - start) > 0.001; }));
    const pid_t first = engine.watchdog();
    REQUIRE(first > 0);
    ::kill(first, SIGTERM); // that is the engine's business
    ::kill(first, SIGKILL);
    REQUIRE(bench.wait([&] { return engine.watchdog() > 0 && engine.watchdog() != first; }));
    const double then = bench.with([&] { return shoulder; });
    CHECK(bench.wait([&] { return std::abs(shoulder - then) > 0.001; }));
    engine.signal(SIGINT);
    CHECK(engine.wait() == 0);
    CHECK(stage.read("said").find("its watchdog process ended; the arm is held until a new one runs") !=
          std::string::npos);
}
