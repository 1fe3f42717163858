// SPDX-License-Identifier: Apache-2.0
// What the pilot has set and asked for: the window's own state. Window thread only.
#pragma once

#include "engine/scene/scene.h"

#include <array>
#include <imgui.h>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace fathom::operate {

// Where the eye of the 3D view is: looks at `centre` from `distance`, turned by yaw about the base's y and
// pitch.
struct Orbit {
    dvec3 centre{0.0, 0.0, 0.8}; // [m] base frame
    double yaw = 0.55, pitch = 0.45, distance = 1.3;
    Pose pose() const; // base_T_eye: z forward, x right, y down
};

enum class Tab { Fixtures, Why, Alarms, Help };

// A pixel of the colour picture that the pilot points at, and what it would select.
struct Pick {
    bool active = false; // waiting for a click, or showing a preview
    bool taken = false;  // a click was made
    uint32_t u = 0, v = 0;
    FixtureClass gates; // what would be added
    int row = -1;       // of the class whose gates are changed; -1 = a new one
    bool fresh = false; // what it selects has not been looked at yet
};

// Where one is in a recording; of a run that is not one, `on` is false and nothing else counts.
struct TimeLine {
    bool on = false, playing = false;
    bool dragged = false;    // the pilot holds the head
    double t = 0.0;          // [s] shown
    double duration = 0.0;   // [s]
    double speed = 1.0;      // of playing
    uint32_t image = 0;      // shown, from 0
    uint32_t images = 0;     // there are
    bool wholeMemory = true; // held points of earlier pictures are there, too
};

struct Console {
    bool forces = false, guidance = false, clutch = false, frozen = false;
    bool grasp = false;        // the jaws of an arm close
    bool spaceIsLarge = false; // the 3D view is the large one
    bool paused = false;       // traces
    bool recording = false;
    bool quit = false, screenshot = false, exportCsv = false, acknowledge = false;
    bool remake = false; // the window's images
    bool undo = false, redo = false, save = false, addPicked = false;
    uint32_t shots = 0; // screenshots written
    int treeLevel = -1; // shown in the 3D view; -1 = none
    double textScale = 1.0;
    Tab tab = Tab::Fixtures, shownTab = Tab::Help;
    Orbit orbit;
    TimeLine timeLine;
    Pick pick;
    ShapeKind placing = ShapeKind::None; // the next click on the cloud puts one there
    std::optional<dvec3> placedFrom; // base point where a line or an axis begins: the next click is its way
    bool panels = false;             // arrows and Enter are the panels', not the tool's
    std::optional<ImVec2> cursor;    // [pixels] the keyboard's, while it aims
    bool aims() const { return (pick.active && !pick.taken) || placing != ShapeKind::None; }

    std::string pilotWanted; // of the scene's; empty = as it is

    int editedBoxRow = -1; // whose box is being dragged
    Box editedBox;
    int editedRow = -1; // whose slider is being dragged: the fixture changes when it is let go
    float editedMillimetres = 0.0f;

    std::string hovered;      // words about the block that the mouse points at
    std::string notice;       // one line about the last thing done, with
    double noticeUntil = 0.0; // [s] of ImGui's clock
    void tell(std::string words);
    // What the scene file keeps of this, and back. textScale: 0 = the file's.
    void takeSettings(const Scene& scene, double chosenTextScale);
    Scene::Window settings() const;

    // Where things were drawn last, by name: for those who drive the window from outside.
    std::map<std::string, std::array<float, 4>> places; // x, y, width, height
};

// Remembers where the last ImGui item is.
void markPlace(Console& console, const std::string& name);

} // namespace fathom::operate
