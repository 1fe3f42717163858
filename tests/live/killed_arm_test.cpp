// SPDX-License-Identifier: Apache-2.0
// A real arm whose engine is killed or stopped, or whose watchdog process is killed, while it moves.
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

// A realtime replay of the stage in the background; its output goes to the file "said".
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
    int wait() { // exit code; -1 = ended by a signal
        int status = 0;
        ::waitpid(id_, &status, 0);
        id_ = -1;
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    pid_t watchdog() const { // -1 = none runs
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

// An ECA keeps its last commanded speed. During homing it would move on to its stop, which takes 15 s here.
void setUpEca(const Stage& stage, EcaSimulator& arm) {
    setUp(stage, kEca, pushing(30.0));
    stage.write("scene.yaml",
                stage.read("scene.yaml") +
                    "  joints: [{name: slew, speed: 0.25}, {name: shoulder, speed: 0.25, lower: 0.8}, "
                    "{name: elbow, speed: 0.25, lower: 0.4}]\n");
    arm.upper.fill(1.6);
    arm.angle.fill(1.5);
}

// A Reach moves on to its last setpoint, 0.05 rad ahead. This one is so slow that this takes 10 s.
void setUpSlowReach(const Stage& stage, ReachSimulator& arm) {
    setUp(stage, kReach, {{0.0, {0, 0, 0}}, {0.3, {0, 0, 0}}, {10.0, {0, 0, 0.1}}, {30.0, {0, 0, 0.1}}});
    setStart(arm);
    arm.speed.fill(0.005);
}

// [s] longest motion after the engine ends: the watchdog waits for 0.2 s of silence, and a busy machine may
// add a second.
constexpr double kUntold = 1.2;    // [s]
constexpr double kEcaHoming = 0.1; // [rad/s]

// Waits until the joint has been at rest for 0.3 s.
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

TEST_CASE("An ECA stops far from its end stop when the engine is killed or crashes while homing it") {
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
        CHECK(engine.wait() == (kSanitized && signal == SIGSEGV ? 1 : -1)); // sanitizers exit on a crash
        CHECK(comesToRest(bench, arm.angle[0]));
        CHECK(killed - arm.angle[0] < kUntold * kEcaHoming);
    }
}

TEST_CASE("A Reach stops before its last setpoint when the engine is killed, also after the line was "
          "unplugged and back") {
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
            CHECK(::kill(first, 0) != 0); // it has ended, so the line is free
            const double then = bench.with([&] { return shoulder; });
            REQUIRE(bench.wait([&] { return std::abs(shoulder - then) > 0.01; }));
        }
        const double killed = bench.with([&] { return shoulder; });
        engine.kill();
        CHECK(comesToRest(bench, shoulder));
        CHECK(std::abs(shoulder - killed) < kUntold * arm.speed[4]);
    }
}

TEST_CASE(
    "The watchdog stops the arm when the engine is stopped, and the engine resumes it when it continues") {
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

TEST_CASE("A watchdog process that is killed is replaced, and the arm resumes") {
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
    ::kill(first, SIGTERM); // ignored: only the engine ends it
    ::kill(first, SIGKILL);
    REQUIRE(bench.wait([&] { return engine.watchdog() > 0 && engine.watchdog() != first; }));
    const double then = bench.with([&] { return shoulder; });
    CHECK(bench.wait([&] { return std::abs(shoulder - then) > 0.001; }));
    engine.signal(SIGINT);
    CHECK(engine.wait() == 0);
    CHECK(stage.read("said").find("its watchdog process ended; the arm is held until a new one runs") !=
          std::string::npos);
}

TEST_CASE("While the watchdog process hangs the arm is held, and it resumes with it") {
    const Stage stage;
    ReachSimulator arm;
    setUpSlowReach(stage, arm);
    arm.speed.fill(0.05);
    ArmBench bench(arm, stage / "line");
    Engine engine(stage);
    const double& shoulder = arm.position[4];
    const double start = shoulder;
    REQUIRE(bench.wait([&] { return std::abs(shoulder - start) > 0.001; }));
    const pid_t watchdog = engine.watchdog();
    REQUIRE(watchdog > 0);
    ::kill(watchdog, SIGSTOP);
    CHECK(comesToRest(bench, shoulder));
    const double there = bench.with([&] { return shoulder; });
    ::kill(watchdog, SIGCONT);
    CHECK(bench.wait([&] { return std::abs(shoulder - there) > 0.001; }));
    CHECK(engine.watchdog() == watchdog);
    engine.signal(SIGINT);
    CHECK(engine.wait() == 0);
}
