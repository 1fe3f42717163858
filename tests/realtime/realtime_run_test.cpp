// SPDX-License-Identifier: Apache-2.0
#include "engine/run/realtime_run.h"

#include "apps/binding/stop_signals.h"
#include "engine/types/error.h"

#include <algorithm>
#include <csignal>
#include <doctest/doctest.h>
#include <filesystem>
#include <semaphore>
#include <thread>
#include <utility>

#include "tests/realtime/fake_scene.h"
#include "tests/support/scratch_folder.h"

using namespace fathom;
using namespace fathom::testing;

namespace {

constexpr double kPenetrationLimit = 1e-5; // [m]

void sleepFor(double seconds) {
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

void checkEnded(const FakeRun& fake) {
    CHECK(fake.hand.last.force == dvec3(0.0));
    CHECK(fake.hand.last.torque == dvec3(0.0));
    CHECK(fake.hand.writes == fake.sink.rows.size() + 1); // one per tick, then zero
    CHECK(fake.run->recordsLost() == 0);
    CHECK(fake.sink.unknown == 0);
    CHECK(fake.sink.audit.maxPenetration() <= kPenetrationLimit);
}

} // namespace

TEST_CASE(
    "A realtime run sends the writer every tick in order, uses new sets as they come and never penetrates") {
    FakeRun fake(45, wipingPath(1.5));
    const testing::ScratchFolder scratch;
    const auto file = scratch.path() / "trace.json";
    CadenceTrace trace(file, {"only"});
    fake.realtime.trace = &trace;
    fake.go();
    trace.file().finish();
    checkEnded(fake);
    CHECK(fake.sink.frames == 45);
    CHECK(fake.sink.queries > 50);
    REQUIRE(fake.sink.rows.size() > 100);
    bool touched = false;
    for (size_t i = 1; i < fake.sink.rows.size(); ++i) {
        const TickRow &before = fake.sink.rows[i - 1], &row = fake.sink.rows[i];
        CHECK(row.record.t > before.record.t);
        CHECK(row.generation >= before.generation);
        CHECK(row.query >= before.query);
        CHECK(row.start.pose.position == before.record.tool.position);
        touched = touched || (row.record.state == StepState::Contact && forceOf(row.record) > 1.0);
    }
    CHECK(touched);
    CHECK(fake.sink.rows.back().record.frame >= 40);
    CHECK(fake.sink.rows.back().record.t > 1.4);
    CHECK(fake.sink.audit.ticks() > fake.sink.rows.size() / 2);
    CHECK(std::filesystem::file_size(file) > 10'000);
}

TEST_CASE("The haptic thread never waits for an answer: one that comes only after 200 more ticks comes") {
    FakeRun fake(90, wipingPath(3.0));
    std::atomic<uint64_t> ticks{0};
    fake.sink.onTurn = [&](const TickRow&) { ++ticks; };
    // False if they do not come, because they wait for what this holds up.
    const auto moreTicksCome = [&] {
        const uint64_t until = ticks + 200;
        for (int i = 0; i < 20000 && ticks < until; ++i) {
            sleepFor(0.001);
        }
        return ticks >= until;
    };
    std::atomic<int> hung{0}, answered{0};
    const auto hang = [&](uint64_t after) {
        if (ticks > after && hung < 4) {
            ++hung;
            answered += moreTicksCome() ? 1 : 0;
        }
    };
    fake.answers.before = [&] { hang(300); };
    fake.answers.beforeClearance = [&] { hang(100); };
    fake.go();
    checkEnded(fake);
    CHECK(hung >= 2);
    CHECK(answered == hung);
    CHECK(fake.sink.rows.size() > 500);
    CHECK(fake.sink.rows.back().record.clearance == FakeAnswers::kSomeClearance);
}

TEST_CASE("A contact thread that stalls for 100 ms and for 1 s stalls the tool and never lets it penetrate") {
    FakeRun fake(90, wipingPath(3.0));
    const auto start = std::chrono::steady_clock::now();
    int stalls = 0;
    fake.answers.before = [&] {
        const double t = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        if (stalls == 0 && t > 0.6) {
            ++stalls;
            sleepFor(0.1);
        } else if (stalls == 1 && t > 1.1) {
            ++stalls;
            sleepFor(1.0);
        }
    };
    fake.go();
    CHECK(stalls == 2);
    checkEnded(fake);
    size_t stalled = 0, stalledLate = 0;
    for (const TickRow& row : fake.sink.rows) {
        stalled += row.record.stalled ? 1 : 0;
        stalledLate += row.record.stalled && row.record.t > 2.6 ? 1 : 0;
    }
    CHECK(stalled > 20);
    CHECK(stalledLate * 4 < stalled); // ends soon after the answers are back
    CHECK(fake.sink.audit.ticks() > 100);
    CHECK(fake.sink.rows.back().record.frame >= 80);
}

TEST_CASE("A camera that stalls lets the scene age: forces fade after 100 ms and return with it") {
    FakeRun fake(90, pressingPath(3.0));
    fake.feed.beforeFetch = [](uint32_t index) {
        if (index == 24) { // after 0.8 s
            sleepFor(1.2);
        }
    };
    fake.go();
    checkEnded(fake);
    double before = 0.0, least = 1e9, oldest = 0.0, after = 0.0;
    size_t fading = 0;
    fake.during(0.5, 0.8, [&](const StepRecord& r) { before = std::max(before, forceOf(r)); });
    fake.during(1.2, 2.0, [&](const StepRecord& r) {
        least = std::min(least, forceOf(r));
        oldest = std::max(oldest, r.sceneAge);
        fading += r.state == StepState::Fading ? 1 : 0;
    });
    fake.during(2.7, 9.0, [&](const StepRecord& r) { after = std::max(after, forceOf(r)); });
    CHECK(before > 5.0);
    CHECK(least < 0.01);
    CHECK(oldest > 0.9);
    CHECK(oldest < 1.6);
    CHECK(fading > 50);
    CHECK(after > 5.0);
    CHECK(fake.run->framesLost() >= 30); // a live camera would have lost about 35
    CHECK(fake.run->staleTicks() >= fading);
}

TEST_CASE("A camera that is gone is retried while the forces fade, and the run continues when it is back") {
    FakeRun fake(45, pressingPath(2.5));
    int refusals = 0;
    fake.feed.beforeFetch = [&](uint32_t index) {
        if (index == 20 && refusals < 3) {
            ++refusals;
            throw DeviceLost("unplugged");
        }
    };
    fake.go();
    checkEnded(fake);
    CHECK(refusals == 3);
    CHECK(fake.feed.published == 45);
    CHECK(fake.run->failure() == nullptr);
    size_t fading = 0;
    fake.during(0.7, 1.5, [&](const StepRecord& r) { fading += r.state == StepState::Fading ? 1 : 0; });
    CHECK(fading > 50);
    CHECK(fake.run->framesLost() < 10); // frames that never existed are not lost
}

TEST_CASE("When the source has ended, its last frame stays active and does not age") {
    FakeRun fake(12, pressingPath(1.2));
    fake.go();
    checkEnded(fake);
    size_t seen = 0;
    fake.during(0.9, 9.0, [&](const StepRecord& r) {
        ++seen;
        CHECK(r.frame == 11);
        CHECK(r.sceneAge <= 0.1);
        CHECK(r.state != StepState::Fading);
    });
    CHECK(seen > 10);
}

TEST_CASE("A path that is shorter than the recording holds its last pose until the frames have ended") {
    FakeRun fake(30, pressingPath(0.3));
    fake.go();
    checkEnded(fake);
    CHECK(fake.sink.frames == 30);
    CHECK(fake.sink.rows.back().record.t > 29.0 / 30.0);
}

TEST_CASE("SIGINT, SIGTERM, SIGQUIT and SIGHUP end a run early with zero force and every record written") {
    std::signal(SIGHUP, SIG_DFL); // the parent process may ignore it
    for (int signal : {SIGINT, SIGTERM, SIGQUIT, SIGHUP}) {
        CAPTURE(signal);
        FakeRun fake(300, pressingPath(10.0));
        StopSignals signals;
        CHECK_FALSE(signals.requested().load());
        fake.sink.onTurn = [&](const TickRow& row) {
            if (row.record.t > 0.5 && !fake.stop.load()) {
                std::raise(signal);
                fake.stop.store(signals.requested().load());
            }
        };
        fake.go();
        CHECK(signals.requested().load());
        checkEnded(fake);
        CHECK(fake.sink.rows.back().record.t < 5.0);
    }
}

TEST_CASE("A signal takes the force away while the writer is blocked") {
    FakeRun fake(300, pressingPath(60.0));
    std::binary_semaphore blocked{0}, free{0};
    fake.sink.onTurn = [&, once = true](const TickRow& row) mutable {
        if (row.record.t > 0.3 && std::exchange(once, false)) {
            blocked.release();
            free.acquire();
        }
    };
    std::thread running([&] { fake.go(); });
    blocked.acquire();
    CHECK_FALSE(fake.hand.zero.load());
    fake.stop.store(true);
    bool zero = false;
    for (int i = 0; i < 20000 && !zero; ++i) { // up to 20 s on a busy machine
        sleepFor(0.001);
        zero = fake.hand.zero.load();
    }
    CHECK(zero);
    free.release();
    running.join();
    checkEnded(fake);
    CHECK(glm::length(fake.sink.rows.back().record.wrench.force) > 0.0); // no old scene took the force away
}

TEST_CASE("A closed reader of the output does not end a run, nor does an ignored SIGHUP") {
    const auto before = std::signal(SIGHUP, SIG_IGN); // as under nohup
    {
        const StopSignals signals;
        std::raise(SIGPIPE);
        std::raise(SIGHUP);
        CHECK_FALSE(signals.requested().load());
    }
    CHECK((std::signal(SIGHUP, before) == SIG_IGN));
    CHECK((std::signal(SIGPIPE, SIG_DFL) == SIG_DFL)); // restored
}

TEST_CASE("An exception in any thread ends the run with zero force, and is reported") {
    FakeRun fake(300, pressingPath(10.0));
    fake.feed.beforePublish = [](uint32_t index) {
        if (index == 10) {
            throw Error("the passes broke");
        }
    };
    fake.go();
    checkEnded(fake);
    REQUIRE(fake.run->failure() != nullptr);
    CHECK_THROWS_WITH_AS(std::rethrow_exception(fake.run->failure()), "the passes broke", Error);
    CHECK(fake.sink.rows.back().record.t < 5.0);
}

TEST_CASE("An exception of the sink is passed on after the hand has zero force") {
    FakeRun fake(300, pressingPath(10.0));
    fake.sink.onTurn = [](const TickRow& row) {
        if (row.record.t > 0.3) {
            throw Error("disk full");
        }
    };
    CHECK_THROWS_WITH_AS(fake.go(), "disk full", Error);
    CHECK(fake.hand.last.force == dvec3(0.0));
}

TEST_CASE("A scene with nothing to collide with runs without a contact thread") {
    FakeRun fake(10, pressingPath(0.5));
    fake.options.needsContacts = false;
    fake.go(false);
    CHECK(fake.sink.queries == 0);
    REQUIRE(!fake.sink.rows.empty());
    CHECK(fake.sink.rows.back().record.state == StepState::Free);
    CHECK(fake.sink.rows.back().record.frame == 9);
}

TEST_CASE("A source without a frame is rejected before a thread starts") {
    FakeRun fake(0, pressingPath(0.5));
    RealtimeRun run(fake.feed, &fake.answers, fake.realtime);
    CHECK_FALSE(run.firstFrame());
}
