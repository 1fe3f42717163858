// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/recorded_edits.h"

#include "apps/binding/scene_edits.h"
#include "engine/types/error.h"

#include <fstream>

namespace fathom::operate {

void RecordedEdits::begin(const std::filesystem::path& folder, const RecordedScene& scene) {
    file_.close();
    folder_ = folder;
    active_ = scene;
    upcoming_.clear();
    scenes_ = 0;
    allFrozen_ = false;
}

// The first edit also writes the scene file of the start.
void RecordedEdits::frame(const PublishedFrame& frame, uint64_t image) {
    const auto takesEffect = [&] { return !upcoming_.empty() && upcoming_.front().first <= frame.edit; };
    if (!takesEffect() && frame.allFrozen == allFrozen_) {
        return;
    }
    if (!file_.isOpen()) {
        file_.open(folder_ / SceneEdits::kFile, SceneEdits::kHeader);
        if (image > 0) {
            put(0);
        }
    }
    for (; takesEffect(); upcoming_.pop_front()) {
        active_ = std::move(upcoming_.front().second);
    }
    allFrozen_ = frame.allFrozen;
    put(image);
}

void RecordedEdits::put(uint64_t image) {
    const std::string name = "scene-" + std::to_string(scenes_++) + ".yaml";
    std::ofstream text(folder_ / name);
    text << active_.text << std::flush;
    if (!text) {
        throw Error((folder_ / name).string() + ": cannot be written");
    }
    std::ostream& out = file_.lines();
    out << image << "," << name << ",";
    for (size_t i = 0; i < active_.frozenRows.size(); ++i) {
        out << (i == 0 ? "" : " ") << active_.frozenRows[i];
    }
    out << "," << (allFrozen_ ? 1 : 0) << "\n";
    file_.flush();
}

} // namespace fathom::operate
