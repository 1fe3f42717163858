// SPDX-License-Identifier: Apache-2.0
// The state of the window: settings and requests of the pilot. Window thread only.
#pragma once

#include "apps/operate/button_map.h"
#include "apps/operate/event_marks.h"
#include "apps/operate/picked_parts.h"
#include "engine/scene/scene.h"

#include <array>
#include <imgui.h>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace fathom::operate {

// The eye of the 3D view: looks at `centre` from `distance`, rotated by yaw about the base's y axis and by
// pitch.
struct Orbit {
    dvec3 centre{0.0, 0.0, 0.8}; // [m] base frame
    double yaw = 0.55, pitch = 0.45, distance = 1.3;
    Pose pose() const; // base_T_eye: z forward, x right, y down
};

enum class Tab { Fixtures, Why, Alarms, Help, Camera, Device };

// A colour that the pilot picks in the camera view, and the fixture class it would add.
struct Pick {
    bool active = false; // waiting for a click, or showing a preview
    bool taken = false;  // a pixel was chosen
    uint32_t u = 0, v = 0;
    FixtureClass gates;                // the class to add
    PartRules rules;                   // for a new class
    PickedParts found;                 // by these rules
    int row = -1;                      // row of the class whose gates are edited; -1 = a new class
    bool fresh = false;                // the preview has not been computed yet
    std::vector<std::string> warnings; // what adding it would do at once (pick_ghost.h)
};

// The position in a recording. `on` is false, and the rest unused, in a live run.
struct TimeLine {
    bool on = false, playing = false;
    bool dragged = false;         // the pilot drags the marker
    double t = 0.0;               // [s] position
    double duration = 0.0;        // [s]
    double speed = 1.0;           // playback speed
    uint32_t frame = 0;           // current frame, from 0
    uint32_t frames = 0;          // number of frames
    std::vector<EventMark> marks; // of the recording
    bool wholeMemory = true;      // points held from earlier frames are included
};

// The way to the end: the forces fade, then a question is shown when fixtures are not saved.
enum class Closing { No, Fades, Asks };
enum class CloseAnswer { None, Save, Discard, Stay };

inline constexpr const char* kLiveRun = "back to the live run"; // one of OpenCard::choices

// What to show next in place of this run (open_card.h).
struct OpenCard {
    bool asked = false; // the key O, in this frame
    bool on = false, clicked = false;
    std::vector<std::string> choices; // folders of recordings, or kLiveRun
    size_t chosen = 0;
    std::string next;    // choice that opens when this window has ended; empty = none
    bool leaves = false; // requests that end, like the window's close button
};

// The running recording.
struct Recorded {
    double seconds = 0.0;
    uint64_t bytes = 0;
    std::optional<uint64_t> left; // [bytes] free on its disk; empty = unknown
    std::string text() const;     // "0:12, 34 MB, 2.1 GB left"
};

struct Console {
    bool forces = false, guidance = false, clutch = false, frozen = false;
    bool grasp = false;        // the jaws of an arm close
    bool spaceIsLarge = false; // the 3D view is the large one
    bool paused = false;       // the traces
    bool recording = false;
    Recorded recorded;
    bool addMark = false;     // at this moment
    uint32_t marks = 0;       // so far in this run
    bool storeLast = false;   // the last seconds (last_seconds.h)
    double keptSeconds = 0.0; // as many could be stored now
    bool tones = true;        // contact, limit, stale and lost are heard
    std::string lastTone;     // tones.h: name of the last one
    uint32_t toneCount = 0;   // tones so far, heard or not
    bool quit = false, screenshot = false, exportCsv = false, acknowledge = false;
    OpenCard openCard;
    Closing closing = Closing::No;
    double closeBy = 0.0;                        // [s] of the session: it waits no longer for forces to go
    bool forcesLast = false;                     // they had not gone by then
    CloseAnswer closeAnswer = CloseAnswer::None; // button pressed in the question
    bool remake = false;                         // recreate the swapchain
    bool undo = false, redo = false, save = false, addPicked = false;
    bool exportImages = false, stopExport = false; // of a recording (image_export.h)
    std::vector<std::string> caption;              // lines under exported images (caption.h)
    uint32_t shots = 0;                            // screenshots written
    int treeLevel = -1;                            // tree level shown in the 3D view; -1 = none
    double textScale = 1.0;                        // as the pilot wants it
    double monitorScale = 1.0;                     // of the monitor (monitor_scale.h)
    double drawnScale = 1.0; // the product, or less where the window has no room (layout.h)
    float scale() const { return static_cast<float>(drawnScale); }
    bool fullScreen = false;  // F11
    bool pilotLayout = false; // the pilot's layout (F2), otherwise the engineer's
    bool panelOpen = false;   // in the pilot's layout: the tabs are over the right column
    Tab tab = Tab::Fixtures, shownTab = Tab::Help;
    Orbit orbit;
    TimeLine timeLine;
    Pick pick;
    ShapeKind placing = ShapeKind::None; // shape that the next click on the cloud places
    std::optional<dvec3> placedFrom;     // start of a line or an axis [m, base]; the next click is its end
    bool panels = false;                 // arrows and Enter go to the panels, not to the tool
    std::optional<ImVec2> cursor;        // keyboard cursor [pixels], while it is in use
    bool aims() const { return (pick.active && !pick.taken) || placing != ShapeKind::None; }

    std::string pilotWanted; // name of a pilot to switch to; empty = no request

    std::string renamed;            // name of the fixture whose name is being edited; empty = none
    std::array<char, 64> newName{}; // as typed

    int editedBoxRow = -1; // fixture whose box is being dragged
    Box editedBox;
    int editedRow = -1; // slider being dragged; the fixture changes when it is released
    float editedMillimetres = 0.0f;

    std::optional<ButtonUse> mapping; // waits for a button of the device to be pressed

    std::string editedControl; // of the camera, while its slider is dragged; empty = none
    int editedValue = 0;

    std::string refusal; // why forces did not come on (arming.h); shown until they do, or Esc
    std::string hovered; // explanation of the block under the mouse
    std::string tooltip; // of the item under the mouse, while it is shown
    // Tooltips are shown after a moment, so that a mouse on its way does not show all of them.
    struct {
        const char* tip = nullptr; // under the mouse
        double since = 0.0;        // [s] of ImGui's clock
        int frame = 0;             // of ImGui, when it was there last
    } pointed;
    std::string notice;       // one line about the last action
    double noticeUntil = 0.0; // [s] of ImGui's clock
    void notify(std::string text);
    // Takes over the settings that a scene file stores. chosenTextScale: 0 = as in the file.
    void takeSettings(const Scene& scene, double chosenTextScale);
    Scene::Window settings() const;

    // Where items were drawn last, by name; written to --state for programs that drive the window.
    std::map<std::string, std::array<float, 4>> places; // x, y, width, height
};

// Records the rectangle of the last ImGui item, or of a view.
void markPlace(Console& console, const std::string& name, ImVec2 corner, ImVec2 size);
void markPlace(Console& console, const std::string& name);
// A small button whose rectangle is recorded under `name`, with a tooltip; true when pressed.
bool markedButton(Console& console, const char* label, const std::string& name, const char* tip);
// A tooltip for the last ImGui item.
void explain(Console& console, const char* tip);
// The same for a rectangle of a view that is no item; true while the mouse is there. Nothing while a window
// is over it or a button is down.
bool explainArea(Console& console, ImVec2 corner, ImVec2 size, const char* tip);
void colouredText(ImU32 colour, const char* text);
void fontText(ImFont* font, ImU32 colour, const std::string& text); // one line

} // namespace fathom::operate
