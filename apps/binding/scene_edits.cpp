// SPDX-License-Identifier: Apache-2.0
#include "apps/binding/scene_edits.h"

#include "apps/binding/open_source.h"
#include "devices/recorded/text_file.h"
#include "engine/cloud/frame_params.h"
#include "engine/types/error.h"
#include "engine/types/split_words.h"

#include <algorithm>

namespace fathom {

namespace {

constexpr size_t kMaxEdits = 100'000;
// Name of a spare class in a recording's scene files; during the run its name is empty.
constexpr const char* kSpareName = "(spare ";

[[noreturn]] void refuse(const std::filesystem::path& file, const TextLine& line, const char* column,
                         std::string_view value, const std::string& allowed) {
    throw BadInput(file.string(), "line " + std::to_string(line.number) + ", " + column,
                   "'" + std::string(value.substr(0, 80)) + "'", allowed);
}

// A file name without a folder.
Scene sceneNamed(const std::filesystem::path& file, const TextLine& line, std::string_view name) {
    const std::filesystem::path path(name);
    if (path.empty() || path != path.filename()) {
        refuse(file, line, "scene", name, "the name of a scene file in the same folder");
    }
    return openScene(file.parent_path() / path);
}

void hold(Scene& scene, const std::filesystem::path& file, const TextLine& line, std::string_view rows) {
    for (const std::string_view word : splitWords(rows)) {
        uint32_t row = 0;
        if (!parseNumber(word, row) || row >= scene.fixtures.size() || !scene.fixtures[row].isPoints()) {
            refuse(file, line, "held", word, "row of a point class in the scene, from 0");
        }
        scene.fixtures[row].frozen = true;
    }
}

SceneEdit readEdit(const std::filesystem::path& file, const TextLine& line) {
    const std::vector<std::string_view> fields = splitFields(line.text, ',');
    if (fields.size() != 4) {
        refuse(file, line, "row", line.text, SceneEdits::kHeader);
    }
    SceneEdit edit;
    if (!parseNumber(fields[0], edit.firstFrame)) {
        refuse(file, line, "picture", fields[0], "a whole number from 0");
    }
    edit.scene = sceneNamed(file, line, fields[1]);
    hold(edit.scene, file, line, fields[2]);
    uint32_t still = 2;
    if (!parseNumber(fields[3], still) || still > 1) {
        refuse(file, line, "still", fields[3], "0 or 1");
    }
    edit.allFrozen = still == 1;
    return edit;
}

} // namespace

bool isSpare(const FixtureClass& fixture) {
    return fixture.isPoints() && (fixture.name.empty() || fixture.name.starts_with(kSpareName));
}

std::string spareName(size_t row) {
    return kSpareName + std::to_string(row) + ")";
}

SceneEdits::SceneEdits(const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / kFile;
    if (!std::filesystem::exists(file)) {
        return;
    }
    const std::vector<TextLine> lines = readDataLines(file);
    if (lines.empty() || lines[0].text != kHeader) {
        throw BadInput(file.string(), "line 1", lines.empty() ? "none" : "'" + lines[0].text + "'",
                       std::string("header ") + kHeader);
    }
    if (lines.size() > kMaxEdits) {
        throw BadInput(file.string(), "rows", std::to_string(lines.size() - 1),
                       "at most " + std::to_string(kMaxEdits));
    }
    for (size_t i = 1; i < lines.size(); ++i) {
        SceneEdit edit = readEdit(file, lines[i]);
        if (i == 1 ? edit.firstFrame != 0 : edit.firstFrame < edits_.back().firstFrame) {
            refuse(file, lines[i], "picture", std::to_string(edit.firstFrame),
                   i == 1 ? "0: the scene at the start" : "no earlier than the previous row");
        }
        if (i > 1 && cloud::classFixtures(edit.scene) != cloud::classFixtures(edits_.front().scene)) {
            refuse(file, lines[i], "scene", edit.scene.file.filename().string(),
                   "the point classes in the same rows as in the first scene");
        }
        edits_.push_back(std::move(edit));
    }
}

const SceneEdit& SceneEdits::at(uint32_t image) const {
    const auto after = std::ranges::upper_bound(edits_, image, {}, &SceneEdit::firstFrame);
    return *(after == edits_.begin() ? after : after - 1);
}

void SceneEdits::takeUncertainty(const Camera& camera) {
    for (SceneEdit& edit : edits_) {
        fathom::takeUncertainty(edit.scene, camera);
    }
}

SceneEdits takeEdits(Scene& scene, const std::filesystem::path& source) {
    std::error_code none;
    if (!std::filesystem::is_directory(source, none) ||
        !std::filesystem::equivalent(source, scene.file.parent_path(), none)) {
        return {};
    }
    SceneEdits edits(source);
    if (!edits.empty()) {
        const std::filesystem::path file = scene.file;
        scene = edits.at(0).scene;
        scene.file = file;
    }
    return edits;
}

// Radii can change during the run, so passes that the first scene's radii would skip stay in the plan.
Plan planToEdit(const Scene& scene, const CameraInfo& camera, const Tool& tool, const DeviceFacts& device) {
    Plan plan = makePlan(scene, camera, static_cast<uint32_t>(tool.leafCount()), device);
    plan.leaks = plan.spheres;
    return plan;
}

} // namespace fathom
