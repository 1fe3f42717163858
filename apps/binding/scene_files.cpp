// SPDX-License-Identifier: Apache-2.0
#include "apps/binding/scene_files.h"

#include "engine/model/link_spheres.h"
#include "engine/model/urdf_file.h"
#include "engine/model/xml_text.h"
#include "engine/types/read_file.h"

#include <set>
#include <vector>

namespace fathom {

namespace {

namespace fs = std::filesystem;

constexpr size_t kMaxIncludedBytes = size_t{64} << 20;

// Adds the files that an MJCF file includes, which are relative to the first file's folder.
void addIncludes(const fs::path& file, const fs::path& home, std::set<fs::path>& found) {
    const std::string text = readFileAtMost(file, kMaxIncludedBytes).value_or("");
    for (XmlPieces pieces(text); pieces.next();) {
        if (pieces.piece().name != "include") {
            continue;
        }
        const fs::path next = home / xmlAttribute(pieces.piece().text, "file");
        if (found.insert(next).second) {
            addIncludes(next, home, found);
        }
    }
}

// The files that the description of an arm names.
std::set<fs::path> filesOf(const SceneArm& arm) {
    std::set<fs::path> found;
    if (!fs::exists(arm.urdf)) {
        return found; // like other files that are gone since the scene was opened
    }
    addIncludes(arm.urdf, arm.urdf.parent_path(), found);
    const auto model = readUrdf(arm.urdf);
    for (const auto& [name, link] : model->links_) {
        for (const auto& collision : link->collision_array) {
            try {
                found.insert(meshFileOf(*collision->geometry, {arm.urdf, arm.meshes}).file);
            } catch (
                const ShapeRefused&) { // of a link that the scene does not use, or the scene had not opened
            }
        }
    }
    return found;
}

// The path in the folder of the scene file; empty = outside.
fs::path nameIn(const fs::path& home, const fs::path& file) {
    const fs::path name = fs::absolute(file).lexically_normal().lexically_relative(home);
    return name.empty() || *name.begin() == ".." ? "" : name;
}

} // namespace

std::string copySceneFiles(const Scene& scene, const fs::path& folder) {
    const fs::path home = fs::absolute(scene.file).parent_path().lexically_normal();
    std::vector<fs::path> named{scene.tool.file};
    std::set<fs::path> outside; // folders with meshes
    if (scene.arm) {
        named.push_back(scene.arm->urdf);
        for (const fs::path& file : filesOf(*scene.arm)) {
            if (file.empty() || !nameIn(home, file).empty()) {
                named.push_back(file);
            } else {
                outside.insert(file.parent_path().lexically_normal());
            }
        }
        if (!scene.arm->meshes.empty()) { // the scene requires the folder, also an empty one
            fs::create_directories(folder / nameIn(home, scene.arm->meshes));
        }
    }
    if (!scene.hand.builtIn) {
        named.emplace_back(scene.hand.path);
    }
    named.insert(named.end(), outside.begin(), outside.end());
    std::string left;
    for (const fs::path& file : named) {
        if (file.empty() || !fs::exists(file)) {
            continue;
        }
        const fs::path name = nameIn(home, file);
        if (name.empty()) {
            left += (left.empty() ? "" : ", ") + file.string();
            continue;
        }
        fs::create_directories((folder / name).parent_path());
        fs::copy(file, folder / name, fs::copy_options::overwrite_existing);
    }
    return left;
}

} // namespace fathom
