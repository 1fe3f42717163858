// SPDX-License-Identifier: Apache-2.0
// Runs the built program in its own X display, drives it by keys and mouse, and observes it through its state
// file and screenshots.
#pragma once

#include "tests/rig/small_recording.h"

#include <algorithm>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <sys/types.h>
#include <vector>

namespace fathom::window {

// Exits with 77 and a message where Xvfb or xdotool is not installed.
void requireDisplay();

struct Screenshot {
    uint32_t width = 0, height = 0;
    std::vector<uint32_t> pixels; // 0xAABBGGRR

    // Share of the pixels that pass the test in a rectangle (in fractions 0..1 of the screenshot).
    double share(const std::array<double, 4>& place,
                 const std::function<bool(int r, int g, int b)>& accepts) const;
};

inline bool isRed(int r, int g, int b) {
    return r > 110 && r > 2 * g && r > 2 * b;
}

// The monitor of a display. Other than 96 pixels per inch are the desktop's setting.
struct TestMonitor {
    std::string size = "1920x1080";
    int perInch = 96;
};

// One display and one program. The scene has a wall with a red bump and a yellow square; validation layers
// are on.
class WindowRig {
public:
    // extra: further arguments of `fathom operate`.
    explicit WindowRig(const std::vector<std::string>& extra = {}, const TestMonitor& monitor = {});
    ~WindowRig();
    WindowRig(const WindowRig&) = delete;
    WindowRig& operator=(const WindowRig&) = delete;

    // The newest complete line of the state file; null before the first.
    nlohmann::json state() const;
    // Waits until the state satisfies `wanted`; false, with the last state in the log, on a timeout.
    bool await(const std::function<bool(const nlohmann::json&)>& wanted, double seconds = 20.0) const;
    bool awaitNotice(const std::string& text) const; // until the notice contains it
    // Waits until hand and tool have not moved for 200 ticks; returns that state, or null when they keep
    // moving. A busy program may see a key release late.
    nlohmann::json atRest() const;
    std::array<double, 4> place(const std::string& name) const; // x, y, width, height

    void key(const std::string& name) const; // pressed and released
    void keyDown(const std::string& name) const;
    void keyUp(const std::string& name) const;
    void click(const std::string& place, double u = 0.5, double v = 0.5) const; // relative position
    void drag(const std::string& place, glm::dvec2 from, glm::dvec2 to) const;
    void wheel(int notches) const;            // positive: away from the user
    void xdo(const std::string& words) const; // runs xdotool; $W is the window
    void push() const; // pushes the hand with the wheel from its start some millimetres into the bump
    void minimise(bool on) const;                    // like a window manager
    Screenshot shoot(const std::string& keep) const; // F12; `keep`: name of the kept file

    // Ends the program, checks its exit code, and starts it again with this scene or recording.
    void reopen(const std::filesystem::path& scene, const std::vector<std::string>& extra = {});
    void findWindow();       // after the program has opened another one
    void askToClose() const; // like the close button of a window manager
    int awaitEnd();          // exit code of a program that ends by itself
    int close();             // ends the program; exit code, or -1 when it crashed or had to be killed
    std::string output() const { return folder_.read("program.log"); } // stdout and stderr so far
    const std::filesystem::path& folder() const { return folder_.path(); }
    std::string sceneText() const { return folder_.read("scene.yaml"); }

private:
    void startDisplay(const TestMonitor& monitor);
    void startProgram(const std::filesystem::path& scene, const std::vector<std::string>& extra);
    void point(const std::string& place, glm::dvec2 share) const; // moves the mouse
    void settle() const;

    TemporaryFolder folder_;
    std::string display_, window_;
    pid_t server_ = -1, program_ = -1;
};

// Closes the window and expects exit code 0 and no validation message.
void closeQuietly(WindowRig& rig);

// Whether an alarm of a state line contains these words.
inline bool hasAlarm(const nlohmann::json& state, const std::string& words) {
    const nlohmann::json& alarms = state["alarms"];
    return std::any_of(alarms.begin(), alarms.end(), [&](const nlohmann::json& alarm) {
        return alarm.get<std::string>().find(words) != std::string::npos;
    });
}

// Three numbers of a state line.
inline glm::dvec3 vec(const nlohmann::json& v) {
    return {v[0].get<double>(), v[1].get<double>(), v[2].get<double>()};
}

} // namespace fathom::window
