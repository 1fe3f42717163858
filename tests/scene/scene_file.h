// SPDX-License-Identifier: Apache-2.0
// A scene file in its own folder, removed at the end of the test.
#pragma once

#include "engine/scene/scene.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

#include <filesystem>
#include <string>

namespace fathom {

class SceneFile : public testing::ScratchFile {
public:
    explicit SceneFile(const std::string& text)
        : ScratchFile("scene.yaml", text) {}
    std::filesystem::path folder() const { return path().parent_path(); }
};

// The message of the BadInput that loading the text throws; empty when it loads.
inline std::string refusal(const std::string& text) {
    const SceneFile file(text);
    return testing::refusalOf([&] { loadScene(file.path()); });
}

inline const std::string kTool = "tool: {spheres: [[0, 0, 0, 0.01]]}\n";
inline const std::string kMinimal = "fixtures: [{name: all, role: forbidden}]\n" + kTool;

} // namespace fathom
