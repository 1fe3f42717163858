// SPDX-License-Identifier: Apache-2.0
// A scene file in its own folder, removed at the end of the test.
#pragma once

#include "engine/scene/scene.h"
#include "engine/types/error.h"
#include "tests/support/refusal.h"

#include <filesystem>
#include <fstream>
#include <string>
#include <unistd.h>

namespace fathom {

class SceneFile {
public:
    explicit SceneFile(const std::string& text) {
        static int count = 0;
        folder_ = std::filesystem::temp_directory_path() /
                  ("fathom_scene_" + std::to_string(::getpid()) + "_" + std::to_string(count++));
        std::filesystem::create_directories(folder_);
        std::ofstream(path()) << text;
    }
    ~SceneFile() { std::filesystem::remove_all(folder_); }
    SceneFile(const SceneFile&) = delete;
    SceneFile& operator=(const SceneFile&) = delete;

    std::filesystem::path path() const { return folder_ / "scene.yaml"; }
    const std::filesystem::path& folder() const { return folder_; }

private:
    std::filesystem::path folder_;
};

// The message of the BadInput that loading the text throws; empty when it loads.
inline std::string refusal(const std::string& text) {
    const SceneFile file(text);
    return testing::refusalOf([&] { loadScene(file.path()); });
}

inline const std::string kTool = "tool: {spheres: [[0, 0, 0, 0.01]]}\n";
inline const std::string kMinimal = "fixtures: [{name: all, role: forbidden}]\n" + kTool;

} // namespace fathom
