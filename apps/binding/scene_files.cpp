// SPDX-License-Identifier: Apache-2.0
#include "apps/binding/scene_files.h"

#include <vector>

namespace fathom {

std::string copySceneFiles(const Scene& scene, const std::filesystem::path& folder) {
    namespace fs = std::filesystem;
    std::vector<fs::path> named{scene.tool.file};
    if (scene.arm) {
        named.push_back(scene.arm->urdf);
        named.push_back(scene.arm->meshes);
    }
    if (!scene.hand.builtIn) {
        named.emplace_back(scene.hand.path);
    }
    const fs::path home = fs::absolute(scene.file).parent_path().lexically_normal();
    std::string left;
    for (const fs::path& file : named) {
        if (file.empty() || !fs::exists(file)) {
            continue;
        }
        const fs::path name = fs::absolute(file).lexically_normal().lexically_relative(home);
        if (name.empty() || *name.begin() == "..") {
            left += (left.empty() ? "" : ", ") + file.string();
            continue;
        }
        fs::create_directories((folder / name).parent_path());
        fs::copy(file, folder / name, fs::copy_options::recursive | fs::copy_options::overwrite_existing);
    }
    return left;
}

} // namespace fathom
