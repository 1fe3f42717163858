// SPDX-License-Identifier: Apache-2.0
// The layout of the window, and the content of views and panels.
#pragma once

#include "apps/operate/alarms.h"
#include "apps/operate/camera_view_image.h"
#include "apps/operate/close_up.h"
#include "apps/operate/fixture_editor.h"
#include "apps/operate/hud.h"
#include "apps/operate/layout.h"
#include "apps/operate/pick_ghost.h"
#include "apps/operate/space_view_image.h"
#include "apps/operate/view_marks.h"

namespace fathom::operate {

// Valid during the call only.
struct ScreenInput {
    const RunView& run;
    const Tool& tool;
    const HudInput& hud;
    bool freshImage = false;     // a new frame since the previous call
    std::span<const Sphere> arm; // base frame; empty = none
    const ShownArm& measured;
};

// Window thread.
class Screen {
public:
    // Draws into the open ImGui frame, and composes the images below it.
    void draw(Console& console, FixtureEditor& editor, Alarms& alarms, const ScreenInput& input);

    std::span<const Layer> layers() const { return layers_; }
    // drawn: number of frames that were drawn so far. An image of a frame that was skipped is offered again.
    void noteDrawn(uint64_t drawn) {
        waiting_ = drawn == drawn_ ? waiting_ : std::array<bool, 2>();
        drawn_ = drawn;
    }
    // For a device that is the CPU itself: less detail of the regions and of a small 3D view.
    void setCoarse(bool coarse) {
        camera_.setCoarse(coarse);
        coarse_ = coarse;
    }
    void redraw() { redraw_ = true; } // the next draw() composes both images; call it after a lost device
    const ViewPort& large() const { return *large_; }
    const DepthCues& cues() const { return cues_; }
    const std::array<std::optional<CloseUp>, 2>& closeUps() const { return closeUps_; } // side, top
    double unknownShare() const { return camera_.unknownShare(); }
    // The pixel of the colour image at a point of the window; empty outside the camera view.
    std::optional<glm::uvec2> colourPixelAt(ImVec2 at) const;

private:
    void makeImages(const Console& console, const FixtureEditor& editor, const ScreenInput& input,
                    const Rooms& rooms);
    // These return whether the image is new. all: compose it whatever is shown now.
    bool composeCamera(const FixtureEditor& editor, const ScreenInput& input, bool all);
    bool composeSpace(const Console::Settings& settings, const ScreenInput& input, const PixelRect& room,
                      bool all);
    void placeImages(bool spaceIsLarge, const Rooms& rooms);
    void findGhost(Console& console, const FixtureEditor& editor, const SceneSnapshot& scene);
    void findCues(const ScreenInput& input);
    SurfaceDepth surfaceOf(const ViewPort& port, const HostFixtures& set) const;
    void drawViews(Console& console, const FixtureEditor& editor, const ScreenInput& input);
    void drawOver(Console& console, const Alarms& alarms, const ScreenInput& input, const Rooms& rooms);
    void drawCloseUps(Console& console, const FixtureEditor& editor, const ScreenInput& input,
                      const CloseUpRooms& rooms);
    void drawFigures(Console& console, const ScreenInput& input, const Rooms& rooms);

    CameraViewImage camera_;
    SpaceViewImage space_;
    std::optional<ViewPort> cameraPort_, spacePort_;
    const ViewPort* large_ = nullptr;
    std::array<Layer, 2> layers_;
    // What the composed images show.
    struct {
        Orbit orbit;
        int treeLevel = -1;
        bool spaceIsLarge = false;
        uint64_t selection = 0;  // FixtureEditor::selectionNumber()
        uint64_t spaceScene = 0; // SceneSnapshot::number of the 3D view
    } composed_;
    double floor_ = 0.0; // [m] of the grid, base y
    DepthCues cues_;
    std::array<std::optional<CloseUp>, 2> closeUps_; // from the side and from above
    // Of the picked colour.
    struct {
        std::vector<Sphere> spheres;
        double radius = 0.0;    // [m]
        uint64_t selection = 0; // FixtureEditor::selectionNumber(); 0 = none
    } ghost_;
    std::optional<Shape> placed_; // what a click would place
    bool centred_ = false, redraw_ = false, coarse_ = false;
    uint64_t drawn_ = 0;            // frames drawn so far
    std::array<bool, 2> waiting_{}; // images of camera and 3D view that no drawn frame has shown
};

} // namespace fathom::operate
