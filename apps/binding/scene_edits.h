// SPDX-License-Identifier: Apache-2.0
// Fixture changes that the pilot made during a recording. Each is a complete scene, valid from one frame on,
// so that a replay uses the same fixtures as the hand felt.
#pragma once

#include "engine/scene/plan.h"
#include "engine/scene/scene.h"

#include <filesystem>
#include <string>
#include <vector>

namespace fathom {

class Camera;
class Tool;

// A class of points that selects nothing and waits for the pilot's pick.
bool isSpare(const FixtureClass& fixture);
std::string spareName(size_t row); // its name in a scene file

// One change, passed by the window to its recording.
struct SceneEdit {
    uint32_t firstFrame = 0; // the first frame of the recording that uses it
    Scene scene;             // with spare classes; FixtureClass::frozen unchanged
    bool allFrozen = false;  // frames make no new set
};

// edits.csv of a recording, `picture,scene,held,still`: scene is a file in the same folder, held lists the
// rows of frozen classes, separated by blanks. The first row is for frame 0.
class SceneEdits {
public:
    static constexpr const char* kFile = "edits.csv";
    static constexpr const char* kHeader = "picture,scene,held,still";

    SceneEdits() = default; // no edits
    // No edits if the folder has no such file. Throws BadInput with line and column.
    explicit SceneEdits(const std::filesystem::path& folder);

    bool empty() const { return edits_.empty(); }
    // The edit that is active at this frame. There must be edits.
    const SceneEdit& at(uint32_t image) const;
    void takeUncertainty(const Camera& camera); // in all scenes; see apps/binding/open_source.h

private:
    std::vector<SceneEdit> edits_;
};

// Edits of a recording that is played with its own scene (`scene` is in the folder `source`), else none. The
// scene becomes that of the first frame.
SceneEdits takeEdits(Scene& scene, const std::filesystem::path& source);

// A plan that supports all possible edits: radii, roles and frozen classes.
Plan planToEdit(const Scene& scene, const CameraInfo& camera, const Tool& tool, const DeviceFacts& device);

} // namespace fathom
