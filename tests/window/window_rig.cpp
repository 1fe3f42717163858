// SPDX-License-Identifier: Apache-2.0
#include "tests/window/window_rig.h"

#include "tests/rig/run_fathom.h"
#include "tests/support/validation_wanted.h"
#include "tests/window/iconify.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <doctest/doctest.h>
#include <fcntl.h>
#include <fstream>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace fathom::window {

namespace {

using Clock = std::chrono::steady_clock;

bool installed(const std::string& program) {
    return std::system(("command -v " + program + " >/dev/null 2>&1").c_str()) == 0;
}

// Allocates nothing in the child, because another thread may hold the allocator at the fork.
pid_t start(const std::vector<std::string>& words, int out) {
    std::vector<char*> argv;
    for (const std::string& word : words) {
        argv.push_back(const_cast<char*>(word.c_str()));
    }
    argv.push_back(nullptr);
    const pid_t child = ::fork();
    if (child == 0) {
        ::dup2(out, 1);
        ::dup2(out, 2);
        ::execvp(argv[0], argv.data());
        ::_exit(127);
    }
    return child;
}

int ended(pid_t child, double seconds) {
    int status = 0;
    const auto until = Clock::now() + std::chrono::duration<double>(seconds);
    while (::waitpid(child, &status, WNOHANG) == 0) {
        if (Clock::now() > until) {
            ::kill(child, SIGKILL);
            ::waitpid(child, &status, 0);
            return -1;
        }
        std::this_thread::sleep_for(std::chrono::duration<double>(0.02));
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

} // namespace

void requireDisplay() {
    if (!installed("Xvfb") || !installed("xdotool")) {
        std::puts("SKIPPED: Xvfb or xdotool is not installed, no window was tested");
        std::fflush(stdout);
        std::_Exit(77);
    }
}

WindowRig::WindowRig(const std::vector<std::string>& extra, const TestMonitor& monitor) {
    requireDisplay();
    const Image image = bumpImage().set({50, 36, 64, 48}, 0); // a corner without depth
    writeRecording(folder_.path() / "recording", std::vector<Image>(4, image));
    SceneText scene;
    scene.camera = "source: {recorded: recording}, near: 0.1, far: 3.0";
    scene.fixtures.push_back(SceneText::kGuideYellow);
    scene.tool = "spheres: [[0, 0, 0, 0.01], [0, 0, -0.03, 0.012]]";
    scene.haptics = "friction: 0, damping: 0, margin: 1, smooth: false"; // smooth, a tool slides off the bump
    folder_.write("scene.yaml", "# a comment that saving must keep\n" + scene.text());
    startDisplay(monitor);
    startProgram(folder_.path() / "scene.yaml", extra);
}

void WindowRig::startDisplay(const TestMonitor& monitor) {
    int ends[2];
    REQUIRE(::pipe(ends) == 0);
    const int log = ::open((folder_.path() / "xvfb.log").c_str(), O_CREAT | O_WRONLY | O_CLOEXEC, 0644);
    server_ = start({"Xvfb", "-displayfd", std::to_string(ends[1]), "-screen", "0", monitor.size + "x24",
                     "-noreset", "-nolisten", "tcp"},
                    log);
    ::close(log);
    ::close(ends[1]);
    char digit = 0;
    while (::read(ends[0], &digit, 1) == 1 && digit != '\n') {
        display_ += digit;
    }
    ::close(ends[0]);
    REQUIRE_MESSAGE(!display_.empty(), "Xvfb did not start");
    display_ = ":" + display_;
    REQUIRE(setResolution(display_, monitor.perInch));
}

void WindowRig::reopen(const std::filesystem::path& scene, const std::vector<std::string>& extra) {
    const int code = close();
    CHECK_MESSAGE(code == 0, output());
    std::filesystem::remove(folder_.path() / "state.jsonl");
    startProgram(scene, extra);
}

void WindowRig::startProgram(const std::filesystem::path& scene, const std::vector<std::string>& extra) {
    std::vector<std::string> words{"env",
                                   "DISPLAY=" + display_,
                                   FATHOM_PROGRAM,
                                   "operate",
                                   scene.string(),
                                   "--device",
                                   "llvmpipe",
                                   "--state",
                                   (folder_.path() / "state.jsonl").string(),
                                   "--folder",
                                   folder_.path().string()};
    if (testing::validationWanted()) {
        words.push_back("--validate");
    }
    words.insert(words.end(), extra.begin(), extra.end());
    allowLibraryLeaks();
    const int log = ::open((folder_.path() / "program.log").c_str(), O_CREAT | O_WRONLY | O_CLOEXEC, 0644);
    program_ = start(words, log);
    ::close(log);
    const auto ready = [](const nlohmann::json& s) { // else forces cannot be switched on
        return s["window"]["frames"] > 3 && (s["run"]["frame"] >= 0 || s["console"]["time_line"]["on"]);
    };
    REQUIRE_MESSAGE(await(ready, 90.0), output());
    findWindow();
}

void WindowRig::findWindow() {
    const std::string words = " xdotool search --name '^Fathom' > " + (folder_.path() / "window").string();
    REQUIRE(std::system(("DISPLAY=" + display_ + words).c_str()) == 0);
    window_ = folder_.read("window");
    window_.erase(window_.find_last_not_of('\n') + 1);
    xdo("windowfocus --sync $W mousemove --window $W 300 300");
}

WindowRig::~WindowRig() {
    if (program_ > 0) {
        close();
    }
    ::kill(server_, SIGTERM);
    ended(server_, 5.0);
}

nlohmann::json WindowRig::state() const {
    constexpr std::streamoff kEnd = 1 << 16; // [bytes] the last lines
    std::ifstream in(folder_.path() / "state.jsonl", std::ios::ate);
    std::string line, last;
    if (in && in.tellg() > kEnd) {
        in.seekg(-kEnd, std::ios::end);
        std::getline(in, line); // the rest of a cut line
    } else {
        in.seekg(0);
    }
    while (std::getline(in, line) && !in.eof()) { // the last line may be incomplete
        last = line;
    }
    return last.empty() ? nlohmann::json() : nlohmann::json::parse(last);
}

bool WindowRig::await(const std::function<bool(const nlohmann::json&)>& wanted, double seconds) const {
    const auto until = Clock::now() + std::chrono::duration<double>(seconds);
    nlohmann::json now;
    do {
        now = state();
        if (!now.is_null() && wanted(now)) {
            return true;
        }
        std::this_thread::sleep_for(std::chrono::duration<double>(0.01));
    } while (Clock::now() < until && ::kill(program_, 0) == 0);
    MESSAGE("the state never came; the last one: " << now.dump());
    return false;
}

bool WindowRig::awaitNotice(const std::string& text) const {
    return await([&](const nlohmann::json& s) {
        return s["console"]["notice"].get<std::string>().find(text) != std::string::npos;
    });
}

nlohmann::json WindowRig::atRest() const {
    constexpr double kStill = 5e-5; // [m]
    constexpr int kTicks = 200;
    nlohmann::json since;
    const auto moved = [&](const nlohmann::json& now, const char* what) {
        double most = 0.0;
        for (size_t i = 0; i < 3; ++i) {
            most = std::max(
                most, std::abs(now["run"][what][i].get<double>() - since["run"][what][i].get<double>()));
        }
        return most > kStill;
    };
    const bool rests = await([&](const nlohmann::json& now) {
        if (since.is_null() || moved(now, "device") || moved(now, "tool")) {
            since = now;
        }
        return now["run"]["turns"].get<int>() > since["run"]["turns"].get<int>() + kTicks;
    });
    return rests ? state() : nlohmann::json();
}

std::array<double, 4> WindowRig::place(const std::string& name) const {
    const nlohmann::json places = state()["console"]["places"];
    REQUIRE_MESSAGE(places.contains(name), "the window shows no place called " << name);
    return places[name];
}

void WindowRig::xdo(const std::string& words) const {
    const std::string command = "W=" + window_ + "; DISPLAY=" + display_ + " xdotool " + words + " >> " +
                                (folder_.path() / "xdo.log").string() + " 2>&1";
    CHECK_MESSAGE(std::system(command.c_str()) == 0, "xdotool " << words);
    settle();
}

// Waits two frames: the current frame may have read its events already.
void WindowRig::settle() const {
    constexpr int kFrames = 2;
    const nlohmann::json before = state();
    const auto until = Clock::now() + std::chrono::seconds(2); // a program that has ended writes no more
    while (!before.is_null() && state()["window"]["begun"] < before["window"]["begun"].get<int>() + kFrames &&
           Clock::now() < until) {
        std::this_thread::sleep_for(std::chrono::duration<double>(0.01));
    }
}

void WindowRig::keyDown(const std::string& name) const {
    xdo("keydown " + name);
}

void WindowRig::keyUp(const std::string& name) const {
    xdo("keyup " + name);
}

// Presses and releases at once, so that the key never repeats; the window counts taps between two frames.
void WindowRig::key(const std::string& name) const {
    xdo("key " + name);
}

void WindowRig::point(const std::string& name, glm::dvec2 share) const {
    const auto at = place(name);
    xdo("mousemove --window $W " + std::to_string(std::lround(at[0] + share.x * at[2])) + " " +
        std::to_string(std::lround(at[1] + share.y * at[3])));
}

void WindowRig::click(const std::string& name, double u, double v) const {
    point(name, {u, v});
    xdo("mousedown 1");
    xdo("mouseup 1");
}

void WindowRig::drag(const std::string& name, glm::dvec2 from, glm::dvec2 to) const {
    point(name, from);
    xdo("mousedown 1");
    for (int i = 1; i <= 8; ++i) {
        point(name, from + i / 8.0 * (to - from));
    }
    xdo("mouseup 1");
}

void WindowRig::wheel(int notches) const {
    xdo("click --delay 30 --repeat " + std::to_string(std::abs(notches)) + (notches > 0 ? " 4" : " 5"));
}

// Further, and the tool would slide off the bump. So a contact must be seen before the wheel turns again.
void WindowRig::push() const {
    xdo("mousemove --window $W 300 300");
    for (int i = 0; i < 32 && state()["run"]["contacts"] == 0; ++i) {
        wheel(2);
        const nlohmann::json gap = state()["depth_cues"]["gap_m"];
        REQUIRE((gap > 0.06 || !atRest().is_null())); // null, too, is near
    }
    wheel(2);
}

int WindowRig::awaitEnd() {
    const int code = ended(program_, 30.0);
    program_ = -1;
    return code;
}

int WindowRig::close() {
    ::kill(program_, SIGTERM);
    return awaitEnd();
}

void closeQuietly(WindowRig& rig) {
    CHECK_MESSAGE(rig.close() == 0, rig.output());
    CHECK_MESSAGE(rig.output().find("validation") == std::string::npos, rig.output());
}

} // namespace fathom::window
