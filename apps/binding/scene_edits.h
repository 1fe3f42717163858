// SPDX-License-Identifier: Apache-2.0
// What a pilot changed while the window recorded: whole scenes, each from a picture on, so that a replay
// obeys what the hand obeyed.
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
std::string spareName(size_t row); // that it has in a scene file

// One change, told by the window to its recording.
struct SceneEdit {
    uint32_t image = 0; // first one of the recording that obeys it
    Scene scene;        // with spare classes; FixtureClass::frozen as it was
    bool still = false; // all fixtures are held: pictures make no set
};

// edits.csv of a recording, `picture,scene,held,still`: scene is a file beside it, held the rows of classes
// that are held still, with blanks between. The first row is of picture 0.
class SceneEdits {
public:
    static constexpr const char* kFile = "edits.csv";
    static constexpr const char* kHead = "picture,scene,held,still";

    SceneEdits() = default; // none: the scene stays as it is
    // None where the folder has no such file. Throws BadInput that names line and column.
    explicit SceneEdits(const std::filesystem::path& folder);

    bool empty() const { return edits_.empty(); }
    // In force at this picture. Not of none.
    const SceneEdit& at(uint32_t image) const;
    void takeUncertainty(const Camera& camera); // of all scenes; apps/binding/open_source.h

private:
    std::vector<SceneEdit> edits_;
};

// Of a recording whose own scene is played: `scene` is in the folder `source`. Else none. The scene then is
// that of the first picture.
SceneEdits takeEdits(Scene& scene, const std::filesystem::path& source);

// A plan under which everything that can be edited may be: radii, roles, what is held still.
Plan planToEdit(const Scene& scene, const CameraInfo& camera, const Tool& tool, const DeviceFacts& device);

} // namespace fathom
