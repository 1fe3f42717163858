// SPDX-License-Identifier: Apache-2.0
// Edits fixtures during a run: picks colours, changes and places fixtures, undoes, saves.
#pragma once

#include "apps/operate/console.h"
#include "apps/operate/recorder.h"
#include "apps/operate/snapshots.h"
#include "engine/contact/shapes.h"

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace fathom::operate {

// The edited scene with its undo history. Calls `onChange` after every change.
class FixtureEditor {
public:
    FixtureEditor(const Scene& scene, std::function<void(const Scene&, const std::vector<Shape>&)> onChange);

    const Scene& scene() const { return scene_; }
    const std::vector<Shape>& shapes() const { return shapes_; }

    // Sets the gates around the colour of this pixel, and computes the preview.
    void pickAt(Console& console, const SceneSnapshot& snapshot, glm::uvec2 pixel);
    // Computes selection and hue histogram for the current gates.
    void preview(Console& console, const SceneSnapshot& snapshot);
    // Edits that can fail return why nothing has changed; empty = done. No edit makes a fixture that a scene
    // file could not contain.
    // Puts the picked class into a spare row, or the edited gates into their row.
    std::string takePicked(Console& console);
    const std::string& lastTaken() const { return lastTaken_; } // name of the class that it activated
    // A new placed shape at a point of the base frame with the normal of the surface.
    FixtureClass shapeAt(ShapeKind kind, const dvec3& base, const dvec3& normal) const;
    std::string place(const FixtureClass& shape);           // adds it, unless there are too many
    std::string change(size_t row, const FixtureClass& to); // makes one undo step
    // One undo step. The name must not be empty or another fixture's.
    std::string rename(size_t row, const std::string& name);
    void remove(size_t row);
    bool undo();
    bool redo();
    // Settings of window and pilot: saved in the file, not part of the undo history.
    void keepSettings(const Scene::Window& window, const std::string& pilot);
    // Replaces `fixtures:`, `pilot:` and `window:` in the scene file, keeps the rest, and returns a message.
    // A failure leaves the old file unchanged. A link stays a link to the file.
    std::string save();
    bool unsaved() const { return rows() != saved_; }
    // Text of the scene file with the current fixtures. spares: includes spare rows, so that each class keeps
    // its row number.
    std::string text(bool spares = false) const;
    // Shows the fixtures of another moment without calling onChange. Clears the history.
    void showFixtures(const Scene& scene);

    const std::vector<uint8_t>& selection() const { return selection_; } // size of the depth image
    uint64_t selectionNumber() const { return selectionNumber_; } // increases when the selection changes
    size_t selectedPoints() const { return selected_; }
    // of the image, 5 degrees per bin, largest bin = 1
    const std::array<float, 72>& hues() const { return hues_; }

private:
    void select(const FixtureClass& gates, const SceneSnapshot& snapshot);
    std::string freeName(const std::string& stem) const;
    std::string rows() const; // as in the scene file
    std::string textFrom(const std::string& old, bool spares) const;
    std::string apply(Scene next); // returns why a scene file cannot contain its fixtures; empty = done
    void notifyChange();
    bool restore(std::vector<std::vector<FixtureClass>>& from, std::vector<std::vector<FixtureClass>>& to);

    Scene scene_;
    std::vector<Shape> shapes_;
    std::function<void(const Scene&, const std::vector<Shape>&)> onChange_;
    std::vector<std::vector<FixtureClass>> undo_, redo_;
    std::vector<uint8_t> selection_;
    uint64_t selectionNumber_ = 0;
    size_t selected_ = 0;
    std::array<float, 72> hues_{};
    std::string lastTaken_;
    std::string saved_; // rows() as last saved, loaded or shown
};

// The fixtures as a recording stores them.
RecordedScene recordedScene(const FixtureEditor& editor);

// Whether a value is inside a band; without a band every value is.
bool inBand(const std::optional<Band>& band, double value);

// Handles keys and buttons of the editor, whatever panel is open; once per window frame.
void handleFixtureKeys(Console& console, FixtureEditor& editor, const SceneSnapshot& snapshot);
// Draws the panel inside the open tab.
void drawFixtures(Console& console, FixtureEditor& editor, const SceneSnapshot& snapshot);

} // namespace fathom::operate
