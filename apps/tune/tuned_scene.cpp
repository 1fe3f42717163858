// SPDX-License-Identifier: Apache-2.0
#include "apps/tune/tuned_scene.h"

#include "apps/binding/scene_files.h"
#include "apps/tune/camera_files.h"
#include "apps/tune/tune_words.h"
#include "engine/types/error.h"
#include "engine/types/inside.h"
#include "engine/types/number_text.h"
#include "engine/types/output_file.h"

#include <charconv>
#include <fstream>
#include <iterator>
#include <yaml-cpp/yaml.h>

namespace fathom::tune {

namespace {

namespace fs = std::filesystem;

constexpr const char* kSourceKinds[] = {"recorded", "v4l2", "ros2"}; // that may name files

// The shortest text that gives the same double again.
std::string exactly(double value) {
    char text[64]; // values are between 1e-7 and 1e3
    const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::fixed).ptr;
    return {text, end};
}

std::vector<std::string> keyOf(Vary vary) {
    switch (vary) {
    case Vary::Window:
        return {"filter", "radius"};
    case Vary::Sigma:
        return {"filter", "sigma"};
    case Vary::Memory:
        return {"filter", "memory"};
    case Vary::Budget:
        return {"error_budget"};
    case Vary::Friction:
        return {"haptics", "friction"};
    case Vary::Reach:
        return {"contact", "reach"};
    case Vary::Size:
        return {"camera", "decimation"};
    }
    return {};
}

std::string yamlOf(const Setting& s, Vary vary) {
    switch (vary) {
    case Vary::Window:
        return std::to_string(s.radius);
    case Vary::Sigma:
        return exactly(s.sigma);
    case Vary::Memory:
        return std::to_string(s.memory);
    case Vary::Budget:
        return exactly(s.errorBudget);
    case Vary::Friction:
        return exactly(s.friction);
    case Vary::Reach:
        return exactly(s.reach);
    case Vary::Size:
        return std::to_string(s.decimation);
    }
    return "";
}

std::string wholeText(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(in), {}};
    constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
    return text.starts_with(kByteOrderMark) ? text.substr(kByteOrderMark.size()) : text;
}

bool sameFile(const fs::path& a, const fs::path& b) {
    std::error_code none;
    return fs::equivalent(a, b, none);
}

// The value of nested keys; empty = missing, or not a scalar.
std::string scalarAt(const YAML::Node& root, const std::vector<std::string>& key) {
    YAML::Node node = YAML::Clone(root);
    for (const std::string& part : key) {
        const YAML::Node next = node.IsMap() ? YAML::Node(node[part]) : YAML::Node();
        node.reset(next);
    }
    return node.IsScalar() ? node.Scalar() : "";
}

// Files of the camera's options in the folder of the scene, which copySceneFiles() does not copy.
std::vector<fs::path> cameraFiles(const Scene& scene) {
    const YAML::Node root = YAML::Load(wholeText(scene.file));
    const fs::path home = fs::absolute(scene.file).parent_path();
    std::vector<fs::path> files;
    for (const char* kind : kSourceKinds) {
        for (const fs::path& file : filesBesideScene(scalarAt(root, {"camera", "source", kind}))) {
            if (fs::is_regular_file(home / file)) { // a missing one only matters where the camera is opened
                files.push_back(file);
            }
        }
    }
    return files;
}

void copyFiles(const Scene& scene, const fs::path& folder, Copying how) {
    const fs::path home = fs::absolute(scene.file).parent_path();
    if (!sameFile(home, folder)) {
        copySceneFiles(scene, folder, how);
        for (const fs::path& file : cameraFiles(scene)) {
            copyFile(home / file, folder, file, how);
        }
    }
}

// Results would replace such a file of the scene, or its copy.
void refuseNamesOfResults(const Scene& scene, const fs::path& folder) {
    const fs::path home = fs::absolute(scene.file).parent_path();
    std::vector<fs::path> files = filesBeside(scene);
    const std::vector<fs::path> more = cameraFiles(scene);
    files.insert(files.end(), more.begin(), more.end());
    for (const fs::path& file : files) {
        for (const char* result : {"scene.yaml", "scene.new.yaml", "points.csv", "tune.png"}) {
            if (*file.lexically_normal().begin() == result || sameFile(home / file, folder / result)) {
                throw BadInput(scene.file, "file", file.string(),
                               std::string("another name than that of a result of tune, ") + result);
            }
        }
    }
}

// Whether an earlier run wrote this scene, beside its points. A recording of a tuned scene has a copy of it,
// without points.
bool isResult(const fs::path& scene) {
    std::ifstream in(scene, std::ios::binary);
    std::string line;
    return std::getline(in, line) && line.starts_with(std::string(kMark) + " " + kWrittenBy) &&
           fs::exists(scene.parent_path() / "points.csv");
}

} // namespace

std::vector<SceneValue> chosenValues(const TuneResult& result, const TunePoint& chosen) {
    std::vector<SceneValue> values;
    for (const Trial& trial : result.trials) {
        if (!trial.points.empty()) {
            values.push_back(
                {keyOf(trial.vary), yamlOf(chosen.setting, trial.vary), reasonOf(result, trial, chosen)});
        }
    }
    return values;
}

std::vector<SceneValue> movedPaths(const std::string& text, const fs::path& home, const fs::path& folder) {
    const std::vector<std::vector<std::string>> keys{
        {"tool", "file"}, {"arm", "urdf"}, {"arm", "meshes"}, {"hand", "path"}};
    const YAML::Node root = YAML::Load(text);
    std::vector<SceneValue> values;
    for (const std::vector<std::string>& key : keys) {
        const std::string path = scalarAt(root, key);
        if (!path.empty() && !staysInside(path) && !fs::path(path).is_absolute()) {
            values.push_back({key, doubleQuoted(movedPath(path, home, folder))});
        }
    }
    for (const char* kind : kSourceKinds) {
        const std::vector<std::string> key{"camera", "source", kind};
        const std::string source = scalarAt(root, key), moved = movedSource(kind, source, home, folder);
        if (!source.empty() && moved != source) {
            values.push_back({key, doubleQuoted(moved)});
        }
    }
    return values;
}

fs::path tunedSceneFile(const Scene& scene, const fs::path& folder) {
    fs::path file = folder / "scene.yaml";
    if (sameFile(file, scene.file)) {
        throw BadInput("tune", "--out", folder.string(),
                       "a folder without the scene itself, which is not replaced");
    }
    if (fs::exists(fs::symlink_status(file)) && !isResult(file)) {
        throw BadInput("tune", "--out", folder.string() + ", whose scene.yaml is not a result of tune",
                       "a folder of its own, or that of an earlier tune");
    }
    refuseNamesOfResults(scene, folder);
    copyFiles(scene, folder, Copying::Check);
    return file;
}

void commitWithoutScene(std::span<OutputFile* const> others, const fs::path& scene) {
    for (OutputFile* file : others) {
        file->complete();
    }
    fs::remove(scene);
    for (OutputFile* file : others) {
        file->commit();
    }
}

fs::path writeTunedScene(const Scene& scene, const Setting& chosen, const std::vector<SceneValue>& values,
                         const std::string& head, const fs::path& folder,
                         std::span<OutputFile* const> others) {
    const fs::path file = tunedSceneFile(scene, folder), home = fs::absolute(scene.file).parent_path(),
                   fresh = folder / "scene.new.yaml";
    const std::string text = withoutComments(wholeText(scene.file));
    std::vector<SceneValue> all = values;
    copyFiles(scene, folder, Copying::Do);
    if (!sameFile(home, folder)) {
        const std::vector<SceneValue> moved = movedPaths(text, home, folder);
        all.insert(all.end(), moved.begin(), moved.end());
    }
    OutputFile out(fresh);
    out.write(commentLines(head) + withValues(text, all));
    out.commit();
    try {
        if (!(settingOf(loadScene(fresh)) == chosen)) {
            throw Error(fresh.string() + ": the settings read back differ from the chosen ones");
        }
        commitWithoutScene(others, file);
        fs::rename(fresh, file);
    } catch (...) {
        std::error_code ignored;
        fs::remove(fresh, ignored);
        throw;
    }
    return file;
}

} // namespace fathom::tune
