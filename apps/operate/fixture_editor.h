// SPDX-License-Identifier: Apache-2.0
// Fixtures made by hand while the run goes on: picked by colour, changed, placed by a click, undone, saved.
#pragma once

#include "apps/operate/console.h"
#include "apps/operate/recorder.h"
#include "apps/operate/snapshots.h"
#include "engine/contact/shapes.h"

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace fathom::operate {

// The scene as the pilot has made it, with its history. Tells the run of every change through `onChange`.
class FixtureEditor {
public:
    FixtureEditor(const Scene& scene, std::function<void(const Scene&, const std::vector<Shape>&)> onChange);

    const Scene& scene() const { return scene_; }
    const std::vector<Shape>& shapes() const { return shapes_; }

    // What a click on this pixel would select: gates about its colour, histogram of hues, the points.
    void pickAt(Console& console, const SceneSnapshot& snapshot, glm::uvec2 pixel);
    // The preview of the gates as they are now.
    void preview(Console& console, const SceneSnapshot& snapshot);
    // Puts the picked class into a spare row, false when there is none left; or its gates into the row that
    // they are of.
    bool takePicked(Console& console);
    // An authored shape at a base point with the surface's normal.
    bool place(ShapeKind kind, const dvec3& base, const dvec3& normal);
    bool change(size_t row, const FixtureClass& to); // one step of history
    bool remove(size_t row);
    bool undo();
    bool redo();
    // What a pilot or the window is set to: part of the file, no part of the history.
    void keep(const Scene::Window& window, const std::string& pilot);
    // Writes `fixtures:`, `pilot:` and `window:` of the scene file anew and leaves the rest of it; returns
    // what happened in words.
    std::string save() const;
    // Of the scene file with the fixtures in force; spares: with rows for classes that wait for a pick, too,
    // so that each class has its row whatever was removed.
    std::string text(bool spares = false) const;
    // Other fixtures than the pilot's, told to nobody: those of another moment. The history ends.
    void showFixtures(const Scene& scene);

    const std::vector<uint8_t>& selection() const { return selection_; } // of the depth picture
    uint64_t selectionNumber() const { return selectionNumber_; }        // changes with it
    size_t selectedPoints() const { return selected_; }
    const std::array<float, 72>& hues() const { return hues_; } // of the picture, 5 degrees each, largest 1
    bool canUndo() const { return !past_.empty(); }
    bool canRedo() const { return !future_.empty(); }

private:
    void enact(Scene next);
    void tell();

    Scene scene_;
    std::vector<Shape> shapes_;
    std::function<void(const Scene&, const std::vector<Shape>&)> onChange_;
    std::vector<std::vector<FixtureClass>> past_, future_;
    std::vector<uint8_t> selection_;
    uint64_t selectionNumber_ = 0;
    size_t selected_ = 0;
    std::array<float, 72> hues_{};
};

// What a recording keeps of the fixtures in force.
RecordedScene recordedScene(const FixtureEditor& editor);

// Keys and buttons of the editor, whatever panel is open; once a frame.
void listenForFixtures(Console& console, FixtureEditor& editor, const SceneSnapshot& snapshot);
// The panel. Inside the tab that is open.
void drawFixtures(Console& console, FixtureEditor& editor, const SceneSnapshot& snapshot);

} // namespace fathom::operate
