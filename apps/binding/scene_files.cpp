// SPDX-License-Identifier: Apache-2.0
#include "apps/binding/scene_files.h"

#include "engine/model/link_spheres.h"
#include "engine/model/urdf_file.h"
#include "engine/model/xml_text.h"
#include "engine/types/error.h"
#include "engine/types/output_file.h"
#include "engine/types/read_file.h"

#include <algorithm>
#include <fstream>
#include <iterator>
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

bool sameBytes(const fs::path& a, const fs::path& b) {
    std::error_code missing;
    if (!fs::is_regular_file(b, missing) || fs::file_size(a) != fs::file_size(b)) {
        return false;
    }
    std::ifstream one(a, std::ios::binary), other(b, std::ios::binary);
    using Bytes = std::istreambuf_iterator<char>;
    return one && other && std::equal(Bytes(one), Bytes(), Bytes(other), Bytes());
}

// Files that a scene names.
struct SceneFiles {
    fs::path home;                // folder of the scene file
    std::vector<fs::path> beside; // in this folder, relative to it
    std::string outside;          // list of the others, and of other folders with meshes
};

SceneFiles filesOf(const Scene& scene) {
    SceneFiles files{fs::absolute(scene.file).parent_path().lexically_normal(), {}, {}};
    std::vector<fs::path> named{scene.tool.file};
    std::set<fs::path> outside; // folders with meshes
    if (scene.arm) {
        named.push_back(scene.arm->urdf);
        for (const fs::path& file : filesOf(*scene.arm)) {
            if (file.empty() || !nameIn(files.home, file).empty()) {
                named.push_back(file);
            } else {
                outside.insert(file.parent_path().lexically_normal());
            }
        }
    }
    if (!scene.hand.builtIn) {
        named.emplace_back(scene.hand.path);
    }
    named.insert(named.end(), outside.begin(), outside.end());
    for (const fs::path& file : named) {
        if (file.empty() || !fs::exists(file)) {
            continue;
        }
        if (const fs::path name = nameIn(files.home, file); !name.empty()) {
            files.beside.push_back(name);
        } else {
            files.outside += (files.outside.empty() ? "" : ", ") + file.string();
        }
    }
    return files;
}

[[noreturn]] void refuseInWay(const fs::path& path, const char* allowed) {
    throw BadInput("--out", path.string(), "in the way of a copy of the scene's own, and not replaced",
                   allowed);
}

// Creates the folder `to`/name, or only checks that it can be.
void makeFolder(const fs::path& to, const fs::path& name, Copying how) {
    fs::path path = to;
    for (const fs::path& part : name) {
        path /= part;
        const fs::file_status there = fs::symlink_status(path);
        if (fs::exists(there) && !fs::is_directory(there)) {
            refuseInWay(path, "a folder, no link");
        }
    }
    if (how == Copying::Do) {
        fs::create_directories(path);
    }
}

} // namespace

void copyFile(const fs::path& file, const fs::path& to, const fs::path& name, Copying how) {
    const fs::path copy = to / name;
    if (sameBytes(file, copy)) {
        return;
    }
    if (fs::exists(fs::symlink_status(copy))) {
        refuseInWay(copy, "a file with the same bytes, or none");
    }
    makeFolder(to, name.parent_path(), how);
    if (how == Copying::Do) {
        std::ifstream in(file, std::ios::binary);
        OutputFile out(copy);
        std::vector<char> bytes(size_t{1} << 20);
        while (in.read(bytes.data(), static_cast<std::streamsize>(bytes.size())) || in.gcount() > 0) {
            out.write(bytes.data(), static_cast<size_t>(in.gcount()));
        }
        if (!in.eof()) {
            throw Error(file.string() + ": cannot be read");
        }
        out.commit();
    }
}

std::string copySceneFiles(const Scene& scene, const fs::path& folder, Copying how) {
    const SceneFiles files = filesOf(scene);
    if (scene.arm && !scene.arm->meshes.empty()) { // the scene requires the folder, also an empty one
        makeFolder(folder, nameIn(files.home, scene.arm->meshes), how);
    }
    for (const fs::path& name : files.beside) {
        copyFile(files.home / name, folder, name, how);
    }
    return files.outside;
}

std::vector<fs::path> filesBeside(const Scene& scene) {
    return filesOf(scene).beside;
}

} // namespace fathom
