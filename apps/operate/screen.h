// SPDX-License-Identifier: Apache-2.0
// The whole screen: which view and panel goes where, and what is in them.
#pragma once

#include "apps/operate/alarms.h"
#include "apps/operate/camera_ground.h"
#include "apps/operate/fixture_editor.h"
#include "apps/operate/hud.h"
#include "apps/operate/space_ground.h"
#include "apps/operate/view_marks.h"

namespace fathom::operate {

// Everything is read during the call only.
struct ScreenInput {
    const RunView& run;
    const Tool& tool;
    const HudInput& hud;
    bool freshImage = false;     // since the call before
    std::span<const Sphere> arm; // base frame; empty = none
    const MeasuredArm& measured;
};

// Thread: the window's.
class Screen {
public:
    // Draws into the ImGui frame that is open, and makes the pictures below it.
    void draw(Console& console, FixtureEditor& editor, Alarms& alarms, const ScreenInput& input);

    std::span<const Layer> layers() const { return layers_; }
    void redraw() { redraw_ = true; } // the pictures of the next draw() are whole: those before are lost
    const ViewPort& large() const { return *large_; }
    double unknownShare() const { return camera_.unknownShare(); }
    // The pixel of the colour picture under a window point of the camera view; empty when it is not there.
    std::optional<glm::uvec2> colourPixelAt(ImVec2 at) const;

private:
    struct Rooms {
        PixelRect head, large, inset, gauges, tabs, traces, timeLine;
    };
    static Rooms arrange(ImVec2 size, double scale, bool timeLine);
    void makeImages(const Console& console, const FixtureEditor& editor, const ScreenInput& input,
                    const Rooms& rooms);
    void drawViews(Console& console, const FixtureEditor& editor, const ScreenInput& input,
                   const Rooms& rooms);
    void drawAlarm(Console& console, const Alarms& alarms) const;
    void drawHint(Console& console, const ScreenInput& input) const;
    void drawTabs(Console& console, FixtureEditor& editor, Alarms& alarms, const ScreenInput& input,
                  const PixelRect& room);

    CameraGround camera_;
    SpaceGround space_;
    std::optional<ViewPort> cameraPort_, spacePort_;
    const ViewPort* large_ = nullptr;
    std::array<Layer, 2> layers_;
    Orbit drawnOrbit_;
    int drawnLevel_ = -1;
    bool centred_ = false, drawnLarge_ = false, redraw_ = false;
    uint64_t selectionDrawn_ = 0;
};

} // namespace fathom::operate
