// SPDX-License-Identifier: Apache-2.0
// A real arm whose engine is killed or stopped, or whose watchdog process is killed, while it moves.
#include "tests/rig/arm_stage.h"
#include "tests/support/sanitized.h"

#include <csignal>
#include <doctest/doctest.h>
#include <fcntl.h>
#include <fstream>
#include <optional>
#include <unistd.h>
#include <utility>

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
    void kill() { wait(SIGKILL); }
    int wait(int signal = 0) { return exitCodeOf(std::exchange(id_, -1), signal); }
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

// [s] longest motion after the engine ends: the watchdog waits for 0.2 s of silence, and a busy machine may
// add a second.
constexpr double kUnreported = 1.2; // [s]
constexpr double kEcaHoming = 0.1;  // [rad/s]

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

// An engine that homes an ECA. The arm keeps its last commanded speed: it would move on to its stop, which
// takes 15 s here.
struct EcaRun {
    EcaRun() {
        setUp(stage, kEca, pushing(30.0));
        stage.write("scene.yaml",
                    stage.read("scene.yaml") +
                        "  joints: [{name: slew, speed: 0.25}, {name: shoulder, speed: 0.25, lower: 0.8}, "
                        "{name: elbow, speed: 0.25, lower: 0.4}]\n");
        arm.upper.fill(1.6);
        arm.angle.fill(1.5);
        bench.emplace(arm, stage / "line");
        engine.emplace(stage);
        REQUIRE(bench->wait([&] { return arm.angle[0] < 1.45; }));
    }
    double angle() {
        return bench->with([&] { return arm.angle[0]; });
    }

    const Stage stage;
    EcaSimulator arm;
    std::optional<ArmBench> bench;
    std::optional<Engine> engine;
};

// An engine that moves a Reach, whose last setpoint is 0.05 rad ahead.
struct ReachRun {
    explicit ReachRun(double speed) { // [rad/s]
        setUp(stage, kReach, {{0.0, {0, 0, 0}}, {0.3, {0, 0, 0}}, {10.0, {0, 0, 0.1}}, {30.0, {0, 0, 0.1}}});
        setStart(arm);
        arm.speed.fill(speed);
        bench.emplace(arm, stage / "line");
        engine.emplace(stage);
    }
    double angle() {
        return bench->with([&] { return shoulder; });
    }
    // Waits until the arm has moved on by `way` [rad].
    bool moves(double way) {
        const double then = angle();
        return bench->wait([&] { return std::abs(shoulder - then) > way; });
    }
    bool hasOtherWatchdog(pid_t first) {
        return bench->wait([&] { return engine->watchdog() > 0 && engine->watchdog() != first; });
    }

    const Stage stage;
    ReachSimulator arm;
    const double& shoulder = arm.position[4];
    std::optional<ArmBench> bench;
    std::optional<Engine> engine;
};

} // namespace

TEST_CASE("An ECA stops far from its end stop when the engine is killed or crashes while homing it") {
    for (const int signal : {SIGKILL, SIGSEGV}) {
        CAPTURE(signal);
        EcaRun run;
        const double killed = run.angle();
        run.engine->signal(signal);
        CHECK(run.engine->wait() == (kSanitized && signal == SIGSEGV ? 1 : -1)); // sanitizers exit on a crash
        CHECK(comesToRest(*run.bench, run.arm.angle[0]));
        CHECK(killed - run.arm.angle[0] < kUnreported * kEcaHoming);
    }
}

TEST_CASE("A Reach stops before its last setpoint when the engine is killed, also after the line was "
          "unplugged and back") {
    for (const bool replugged : {false, true}) {
        CAPTURE(replugged);
        ReachRun run(0.005); // so slow that the way to the last setpoint takes 10 s
        REQUIRE(run.moves(0.01));
        if (replugged) {
            const pid_t first = run.engine->watchdog();
            CHECK(first > 0);
            run.bench->unplug();
            run.bench->plug();
            REQUIRE(run.hasOtherWatchdog(first));
            CHECK(::kill(first, 0) != 0); // it has ended, so the line is free
            REQUIRE(run.moves(0.01));
        }
        const double killed = run.angle();
        run.engine->kill();
        CHECK(comesToRest(*run.bench, run.shoulder));
        CHECK(std::abs(run.shoulder - killed) < kUnreported * run.arm.speed[4]);
    }
}

TEST_CASE(
    "The watchdog stops the arm when the engine is stopped, and the engine resumes it when it continues") {
    EcaRun run;
    const double stopped = run.angle();
    run.engine->signal(SIGSTOP);
    CHECK(comesToRest(*run.bench, run.arm.angle[0]));
    const double rest = run.angle();
    CHECK(stopped - rest < kUnreported * kEcaHoming);
    run.engine->signal(SIGCONT);
    CHECK(run.bench->wait([&] { return run.arm.angle[0] < rest - 0.02; }));
}

TEST_CASE("A watchdog process that is killed is replaced, and the arm resumes") {
    ReachRun run(0.05);
    REQUIRE(run.moves(0.001));
    const pid_t first = run.engine->watchdog();
    REQUIRE(first > 0);
    ::kill(first, SIGTERM); // ignored: only the engine ends it
    ::kill(first, SIGKILL);
    REQUIRE(run.hasOtherWatchdog(first));
    CHECK(run.moves(0.001));
    run.engine->signal(SIGINT);
    CHECK(run.engine->wait() == 0);
    CHECK(run.stage.read("said").find("its watchdog process ended; the arm is held until a new one runs") !=
          std::string::npos);
}

TEST_CASE("While the watchdog process hangs the arm is held, and it resumes with it") {
    ReachRun run(0.05);
    REQUIRE(run.moves(0.001));
    const pid_t watchdog = run.engine->watchdog();
    REQUIRE(watchdog > 0);
    ::kill(watchdog, SIGSTOP);
    CHECK(comesToRest(*run.bench, run.shoulder));
    ::kill(watchdog, SIGCONT);
    CHECK(run.moves(0.001));
    CHECK(run.engine->watchdog() == watchdog);
    run.engine->signal(SIGINT);
    CHECK(run.engine->wait() == 0);
}
