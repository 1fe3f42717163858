// SPDX-License-Identifier: Apache-2.0
// A hand path recorded with frames.
#include "apps/record/hand_log.h"

#include "devices/recorded/hand_csv.h"
#include "tests/support/scratch_folder.h"

#include <chrono>
#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>

using namespace fathom;
using namespace fathom::testing;

namespace {

// Its position is the time of the reading; it keeps the force that it receives.
class Clockwork final : public LiveHand {
public:
    explicit Clockwork(double& worst)
        : worst_(worst) {}
    HandSample read(double t) noexcept override {
        HandSample sample;
        sample.deviceThandle.position.x = t;
        sample.buttons = 4;
        return sample;
    }
    void write(const Wrench& w, double) noexcept override { worst_ = std::max(worst_, glm::length(w.force)); }
    std::string description() const override { return "clockwork"; }
    std::string preset() const override { return "none"; }
    bool alive() const noexcept override { return true; }
    LiveHandFigures figures() const noexcept override { return {}; }

private:
    double& worst_;
};

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void awaitSamples(const HandLog& log, uint64_t more) {
    const uint64_t until = log.samples() + more;
    while (log.samples() < until) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

} // namespace

TEST_CASE("A hand path between two recorded frames is scaled to the time between their captures") {
    const ScratchFolder folder;
    double pushed = 0.0;
    std::vector<double> captured;
    {
        HandLog log(std::make_unique<Clockwork>(pushed), folder.path() / "hand.csv");
        awaitSamples(log, 3); // before the first frame: skipped
        for (const uint64_t ticks : {5u, 40u, 12u}) {
            captured.push_back(now());
            log.frame(captured.back());
            awaitSamples(log, ticks);
        }
        log.finish();
    }
    const auto path = readHandCsv(folder.path() / "hand.csv");
    REQUIRE(path.size() >= 40);
    size_t between = 0;
    for (size_t i = 0; i < path.size(); ++i) {
        CHECK((i == 0 || path[i].t > path[i - 1].t));
        CHECK(path[i].buttons == 4);
        const auto j = static_cast<size_t>(path[i].t * 30.0 + 1e-9);
        REQUIRE(j < 3);
        const double length = j < 2 ? captured[j + 1] - captured[j] : 1.0 / 30.0;
        const double truth = captured[j] + (path[i].t * 30.0 - static_cast<double>(j)) * length;
        CHECK(path[i].deviceThandle.position.x == doctest::Approx(truth).epsilon(1e-10));
        between += j < 2 ? 1 : 0;
    }
    CHECK(between >= 40);
    CHECK(pushed == 0.0); // no force while recording
}

TEST_CASE("A hand path without a frame gives a file without rows") {
    const ScratchFolder folder;
    double pushed = 0.0;
    HandLog log(std::make_unique<Clockwork>(pushed), folder.path() / "hand.csv");
    awaitSamples(log, 2);
    log.finish();
    CHECK_THROWS(readHandCsv(folder.path() / "hand.csv"));
    CHECK_THROWS(HandLog(std::make_unique<Clockwork>(pushed), folder.path() / "none/hand.csv"));
}
