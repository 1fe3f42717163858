// SPDX-License-Identifier: Apache-2.0
// The state that keys, panels and the run share. Window thread only.
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

enum class ClosingStage { No, Fades, Asks };
enum class CloseAnswer { None, Save, Discard, Stay };

// How the window closes: the forces fade, then it asks about fixtures that are not saved. Only stepClosing()
// writes this, except `answer`, and `quit` where a playback has no device.
struct Closing {
    ClosingStage stage = ClosingStage::No;
    double deadline = 0.0;                  // [s] of the session: then it waits no longer for forces to go
    bool forcesRemain = false;              // they had not gone by then
    CloseAnswer answer = CloseAnswer::None; // the button pressed in the question; stepClosing() clears it
    bool quit = false;                      // the window may end
};

inline constexpr const char* kLiveRun = "back to the live run"; // one of OpenCard::choices

// What to show next in place of this run (open_card.h).
struct OpenCard {
    bool on = false;
    std::vector<std::string> choices; // folders of recordings, or kLiveRun
    size_t chosen = 0;
    bool clicked = false; // on a choice; stepOpenCard() clears it
    std::string next;     // choice that opens when this window has ended; empty = none
    bool leaves = false;  // requests that end, like the window's close button; RunDisplay clears it
};

// The running recording.
struct Recorded {
    double seconds = 0.0;
    uint64_t bytes = 0;
    std::optional<uint64_t> left; // [bytes] free on its disk; empty = unknown
    std::string text() const;     // "0:12, 34 MB, 2.1 GB left"
};

// What the next click on the cloud places.
struct Placing {
    ShapeKind shape = ShapeKind::None;
    std::optional<dvec3> from; // start of a line or an axis [m, base]; the next click is its end
};

// Grouped by writer and by what clears them.
struct Console {
    // Keys and panels change them, the run obeys in every frame. The run switches them off when it must, and
    // observers may request changes.
    struct Switches {
        bool forces = false, guidance = false, clutch = false, frozen = false;
        bool grasp = false; // the jaws of an arm close
        bool recording = false;
        void forcesOff() { forces = guidance = false; }
    };
    // Keys and panels set them; the handler named at each field clears it, so that each acts once.
    struct Requests {
        bool screenshot = false, newSwapchain = false;                            // Canvas
        bool exportTraces = false;                                                // RunDisplay
        bool acknowledge = false;                                                 // Alarms
        bool openCard = false;                                                    // stepOpenCard()
        bool undo = false, redo = false, saveFixtures = false, addPicked = false; // handleFixtureKeys()
        bool exportImages = false, stopExport = false; // ImageExport; OperatorRun, which refuses
        bool mark = false;                             // this moment: OperatorRun, PlaybackRun
        bool storeLast = false;                        // the last seconds (last_seconds.h): RecorderControl
        std::string pilot; // name of a pilot to switch to; empty = no request: OperatorRun
    };
    // Keys change them; nothing resets them.
    struct Settings {
        // Saved in the scene file:
        double textScale = 1.0;    // as the pilot wants it
        bool spaceIsLarge = false; // the 3D view is the large one
        bool pilotLayout = false;  // the pilot's layout (F2), otherwise the engineer's
        bool tones = true;         // contact, limit, stale and lost are heard
        Orbit orbit;
        // Until the window ends:
        bool fullScreen = false; // F11
        int treeLevel = -1;      // level of the region tree shown in the 3D view; -1 = none

        // Takes over what a scene file stores. chosenTextScale: 0 = as in the file.
        void take(const Scene& scene, double chosenTextScale);
        Scene::Window saved() const;
    };
    // Keys, tabs and traces change them.
    struct Panels {
        bool open = false;     // in the pilot's layout: the tabs are over the right column
        bool haveKeys = false; // arrows and Enter go to the panels, not to the tool
        Tab tab = Tab::Fixtures, shownTab = Tab::Help; // wanted, and drawn in the last frame
        bool tracesPaused = false;
    };
    // What a panel has begun. The panel writes and ends it, except `mapping`.
    struct Editing {
        std::string renamed;            // name of the fixture whose name is edited; empty = none
        std::array<char, 64> newName{}; // as typed
        int boxRow = -1;                // row of the fixture whose box is dragged; -1 = none
        Box box;
        int slider = -1; // id of the size slider that is dragged; the fixture changes on release
        float millimetres = 0.0f;
        std::string control; // of the camera, while its slider is dragged; empty = none
        int controlValue = 0;
        std::optional<ButtonUse> mapping; // waits for a button of the device: until LiveRun has it, or Esc
    };
    // The run and the canvas write it; panels, captions and the state file read it.
    struct Status {
        Recorded recorded;
        double keptSeconds = 0.0;         // as many could be stored now
        uint32_t marks = 0;               // so far in this run
        std::string lastTone;             // tones.h: name of the last one
        uint32_t toneCount = 0;           // tones so far, heard or not
        uint32_t shots = 0;               // screenshots written
        std::vector<std::string> caption; // lines under screenshots and exported images (caption.h)
        double monitorScale = 1.0;        // of the monitor (monitor_scale.h)
        double drawnScale = 1.0; // textScale x monitorScale, or less where there is no room (layout.h)
    };
    // Text over the views.
    struct Messages {
        std::string notice;       // one line about the last action
        double noticeUntil = 0.0; // [s] of ImGui's clock
        std::string refusal;      // why forces did not come on (arming.h); until they do, or Esc
        std::string contact;      // explanation of the contact under the mouse; found anew in each frame
        std::string tooltip;      // of the item under the mouse; found anew in each frame
        // Tooltips are shown after a moment, so that a mouse on its way does not show all of them.
        struct {
            const char* tip = nullptr; // under the mouse
            double since = 0.0;        // [s] of ImGui's clock
            int frame = 0;             // of ImGui, when it was there last
        } pointed;
    };

    float scale() const { return static_cast<float>(status.drawnScale); }
    bool aims() const { return (pick.active && !pick.taken) || placing.shape != ShapeKind::None; }
    void stopAiming();
    void notify(std::string text); // shows it for some seconds

    Switches switches;
    Requests requests;
    Settings settings;
    Panels panels;
    Pick pick;
    Placing placing;
    std::optional<ImVec2> cursor; // keyboard cursor [pixels], while it is in use; Steering writes it
    Editing editing;
    OpenCard openCard;
    Closing closing;
    TimeLine timeLine;
    Status status;
    Messages messages;
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
