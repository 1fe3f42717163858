// SPDX-License-Identifier: Apache-2.0
// The pilot's changes during a recording, from the recorder to the scenes of a replay.
#include "apps/binding/scene_edits.h"

#include "apps/operate/fixture_editor.h"
#include "apps/session/session.h"
#include "engine/cloud/frame_params.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

#include <algorithm>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::operate;
using namespace fathom::testing;

namespace {

constexpr const char* kScene = R"(camera: {near: 0.1, far: 3.0}
fixtures:
  - {name: wall, role: forbidden, shape: plane, base_T_shape: {xyz: [0, 0, 1]}}
  - {name: red, role: forbidden, hue: [345, 20], radius: 0.04}
  - {name: yellow, role: guidance, hue: [40, 70]}
tool: {spheres: [[0, 0, 0, 0.01]]}
)";

// An editor, a recorder and frames, as in a session.
struct Pilot {
    Pilot()
        : scene(loaded()) {
        recorder.start(folder.path() / "rec", editor.text(), camera(), recordedScene(editor));
    }
    Scene loaded() {
        put(folder.path() / "scene.yaml", kScene);
        return withSpareClasses(loadScene(folder.path() / "scene.yaml"));
    }
    static CameraInfo camera() {
        CameraInfo info;
        info.depth = {8, 6, 10.0, 10.0, 3.5, 2.5};
        info.metresPerUnit = 0.001;
        info.hasColour = false;
        return info;
    }
    // edit: number of the newest change that the frame uses.
    void image(uint64_t edit, bool still = false) {
        PublishedFrame frame;
        frame.t = images / 30.0;
        frame.report.index = images++;
        frame.edit = edit;
        frame.allFrozen = still;
        HostFixtures set;
        set.depth.resize(48, 500);
        recorder.frame(frame, set);
    }
    SceneEdits end() {
        recorder.stop();
        recorder.finish();
        CHECK(recorder.failure().empty());
        return SceneEdits(folder.path() / "rec");
    }
    size_t rowOf(const std::string& name) const {
        const auto& rows = editor.scene().fixtures;
        return static_cast<size_t>(
            std::find_if(rows.begin(), rows.end(), [&](const auto& f) { return f.name == name; }) -
            rows.begin());
    }

    ScratchFolder folder;
    Scene scene;
    Recorder recorder;
    uint64_t changes = 0;
    uint32_t images = 0;
    FixtureEditor editor{scene, [this](const Scene&, const std::vector<Shape>&) {
                             recorder.edit(++changes, recordedScene(editor));
                         }};
};

std::vector<std::string> namesOf(const Scene& scene) {
    std::vector<std::string> names;
    for (const FixtureClass& f : scene.fixtures) {
        names.push_back(isSpare(f) ? "" : f.name);
    }
    return names;
}

} // namespace

TEST_CASE("Classes of points keep their rows when shapes are added and removed") {
    Pilot pilot;
    const std::vector<uint32_t> rows = cloud::classFixtures(pilot.editor.scene());
    CHECK(rows == std::vector<uint32_t>{0, 1, 2, 3}); // red, yellow, two spare
    pilot.editor.remove(pilot.rowOf("wall"));
    CHECK(cloud::classFixtures(pilot.editor.scene()) == rows);
    CHECK(pilot.editor.place(pilot.editor.shapeAt(ShapeKind::Sphere, dvec3(0.0), dvec3(0.0, 0.0, -1.0))) ==
          "");
    CHECK(cloud::classFixtures(pilot.editor.scene()) == rows);
}

TEST_CASE("A recording has each change of fixtures from the first frame that used it, in the rows that "
          "classes have in the run") {
    Pilot pilot;
    pilot.image(0);
    pilot.image(0);
    FixtureClass wide = pilot.editor.scene().fixtures[1];
    wide.radius = 0.05;
    wide.frozen = true;
    pilot.editor.remove(0);       // change 1: red is removed, its row becomes spare
    pilot.image(0);               // this frame was already in progress
    pilot.editor.change(1, wide); // change 2
    pilot.image(2);
    pilot.image(2, true);
    pilot.image(2);
    pilot.editor.undo(); // change 3
    const SceneEdits edits = pilot.end();
    REQUIRE_FALSE(edits.empty());
    using Names = std::vector<std::string>;
    const Names all{"red", "yellow", "", "", "wall"}, fewer{"", "yellow", "", "", "wall"};
    for (uint32_t image : {0u, 1u, 2u}) {
        CHECK(namesOf(edits.at(image).scene) == all);
        CHECK_FALSE(edits.at(image).allFrozen);
    }
    for (uint32_t image : {3u, 4u, 5u, 900u}) {
        const SceneEdit& edit = edits.at(image);
        CHECK(namesOf(edit.scene) == fewer);
        CHECK(edit.scene.fixtures[1].radius == 0.05);
        CHECK(edit.scene.fixtures[1].frozen);
        CHECK(edit.allFrozen == (image == 4));
    }
    CHECK(cloud::classFixtures(edits.at(0).scene) == cloud::classFixtures(edits.at(3).scene));
}

TEST_CASE("A recording without changes has no edits, nor does one that is played with another scene") {
    Pilot pilot;
    pilot.image(0);
    pilot.image(0);
    CHECK(pilot.end().empty());
    CHECK_FALSE(std::filesystem::exists(pilot.folder.path() / "rec" / SceneEdits::kFile));
    Pilot changed;
    changed.image(0);
    changed.editor.remove(0);
    changed.image(1);
    CHECK_FALSE(changed.end().empty());
    Scene other = changed.scene;
    CHECK(takeEdits(other, changed.folder.path() / "rec").empty());
    CHECK(other.contact.where == changed.scene.contact.where);
    Scene own = loadScene(changed.folder.path() / "rec" / "scene.yaml");
    CHECK_FALSE(takeEdits(own, changed.folder.path() / "rec").empty());
    CHECK(own.contact.where == changed.scene.contact.where);
    CHECK(own.file.filename() == "scene.yaml");
}

TEST_CASE("Damaged edits are rejected with file, line, column and what is allowed") {
    Pilot pilot;
    pilot.image(0);
    pilot.editor.remove(0);
    pilot.image(1);
    REQUIRE_FALSE(pilot.end().empty());
    const auto folder = pilot.folder.path() / "rec";
    const auto refused = [&](const std::string& rows) {
        put(folder / SceneEdits::kFile, rows);
        return refusalOf([&] { SceneEdits{folder}; });
    };
    const std::string head = "picture,scene,held,still\n";
    const std::vector<std::pair<std::string, std::string>> cases{
        {"", "header picture,scene,held,still"},
        {"picture,scene\n", "header picture,scene,held,still"},
        {head + "0,scene-0.yaml,\n", "picture,scene,held,still"},
        {head + "1,scene-0.yaml,,0\n", "0: the scene at the start"},
        {head + "0,scene-0.yaml,,0\n-1,scene-1.yaml,,0\n", "a whole number from 0"},
        {head + "0,scene-0.yaml,,0\n7,scene-1.yaml,,0\n6,scene-1.yaml,,0\n",
         "no earlier than the previous row"},
        {head + "0,../rec/scene-0.yaml,,0\n", "the name of a scene file in the same folder"},
        {head + "0,nothing.yaml,,0\n", "nothing.yaml"},
        {head + "0,scene-0.yaml,4,0\n", "row of a point class"},
        {head + "0,scene-0.yaml,x,0\n", "row of a point class"},
        {head + "0,scene-0.yaml,,2\n", "0 or 1"},
        {head + "0,scene.yaml,,0\n1,scene-0.yaml,,0\n", "the point classes in the same rows"},
    };
    for (const auto& [rows, words] : cases) {
        const std::string text = rows;
        CAPTURE(text);
        CHECK(refused(rows).find(words) != std::string::npos);
    }
}
