// SPDX-License-Identifier: Apache-2.0
// --hold-clock: a separate process keeps the chosen device busy so that its clock stays high. The tests
// provide a fake driver library, and check runs where the clock cannot be held.
#include "tests/rig/run_fathom.h"
#include "tests/rig/stage.h"
#include "tests/support/eventually.h"

#include <csignal>
#include <cstdlib>
#include <doctest/doctest.h>
#include <fstream>
#include <optional>
#include <string>

using namespace fathom;

namespace {

// Sets environment variables for programs started during its lifetime.
class Environment {
public:
    using Values = std::vector<std::pair<std::string, std::string>>;
    explicit Environment(Values values)
        : values_(std::move(values)) {
        for (const auto& [name, value] : values_) {
            const char* const before = std::getenv(name.c_str());
            before_.push_back(before != nullptr ? std::optional<std::string>(before) : std::nullopt);
            ::setenv(name.c_str(), value.c_str(), 1);
        }
    }
    ~Environment() {
        for (size_t i = 0; i < values_.size(); ++i) {
            if (before_[i]) {
                ::setenv(values_[i].first.c_str(), before_[i]->c_str(), 1);
            } else {
                ::unsetenv(values_[i].first.c_str());
            }
        }
    }
    Environment(const Environment&) = delete;
    Environment& operator=(const Environment&) = delete;

private:
    Values values_;
    std::vector<std::optional<std::string>> before_;
};

std::string textOf(const std::filesystem::path& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
}

// A stage with two frames.
struct Short : Stage {
    Short() {
        recording({bumpImage(), bumpImage()});
        scene({});
        hand({{0.0, {0.0, 0.0, 0.4}}});
    }
    std::vector<std::string> holding() const {
        std::vector<std::string> words = command();
        words.insert(words.begin(), "--hold-clock");
        return words;
    }
};

// The device's id, from the warning of the program.
std::string idOfDevice(const Short& stage) {
    const Environment library(Environment::Values{{"LD_LIBRARY_PATH", FAKE_CUDA}});
    const std::string said = runFathom(stage.holding()).err;
    const size_t at = said.find("no CUDA device has the id ");
    REQUIRE_MESSAGE(at != std::string::npos, said);
    return said.substr(at + 26, 32);
}

} // namespace

TEST_CASE("The chosen device, and no other, is occupied while the program runs, and free when it has ended") {
    const Short stage;
    const Environment driver(Environment::Values{{"LD_LIBRARY_PATH", FAKE_CUDA},
                                                 {"FAKE_CUDA_ID", idOfDevice(stage)},
                                                 {"CUDA_VISIBLE_DEVICES", "7"},
                                                 {"FAKE_CUDA_LOG", (stage / "log").string()}});
    const ProgramRun run = runFathom(stage.holding());
    CHECK(run.exitCode == 0);
    CHECK(run.err == "");
    CHECK(textOf(stage / "log") == "made\nended\n");
}

TEST_CASE("The device is also free after the program was killed") {
    const Short stage;
    const Environment driver(Environment::Values{{"LD_LIBRARY_PATH", FAKE_CUDA},
                                                 {"FAKE_CUDA_ID", idOfDevice(stage)},
                                                 {"FAKE_CUDA_LOG", (stage / "log").string()}});
    const std::vector<std::string> endless{"--hold-clock",
                                           "latency",
                                           (stage / "scene.yaml").string(),
                                           "--source",
                                           (stage / "rec").string(),
                                           "--load",
                                           "idle",
                                           "--seconds",
                                           "600"};
    const pid_t program = startFathom(endless, stage / "said");
    CHECK(testing::eventually([&] { return textOf(stage / "log") == "made\n"; }));
    exitCodeOf(program, SIGKILL);
    CHECK(testing::eventually([&] { return textOf(stage / "log") == "made\nended\n"; }));
}

TEST_CASE("Where the clock cannot be held, one line says why, and the run is otherwise the same") {
    const Short stage;
    const std::string digest = [&] {
        const ProgramRun run = runFathom(stage.command());
        REQUIRE(run.exitCode == 0);
        return run.out.substr(run.out.find("digest"), 45);
    }();
    const auto check = [&](const std::string& why) {
        const ProgramRun run = runFathom(stage.holding());
        CHECK(run.exitCode == 0);
        REQUIRE(run.errorLines().size() == 1);
        CHECK(run.err.find("warning: --hold-clock: cannot lock the clock of '") == 0);
        CHECK_MESSAGE(run.err.find(why) != std::string::npos, run.err);
        CHECK(run.out.find(digest) != std::string::npos);
    };
    SUBCASE("no such driver") {
        stage.write("libcuda.so.1", ""); // not the id of any device here
        const Environment library(Environment::Values{{"LD_LIBRARY_PATH", stage.path().string()}});
        check("libcuda.so.1");
    }
    SUBCASE("a driver that does not know the device") {
        const Environment library(Environment::Values{{"LD_LIBRARY_PATH", FAKE_CUDA}});
        check("no CUDA device has the id");
    }
    SUBCASE("a driver that refuses") {
        const Environment library(
            {{"LD_LIBRARY_PATH", FAKE_CUDA}, {"FAKE_CUDA_ID", idOfDevice(stage)}, {"FAKE_CUDA_FAULT", "2"}});
        check("cuDevicePrimaryCtxRetain says 2");
    }
}
