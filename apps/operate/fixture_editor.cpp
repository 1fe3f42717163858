// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/fixture_editor.h"

#include "apps/session/session.h"
#include "engine/scene/load.h"
#include "engine/types/error.h"
#include "shaders/shared/frame_params.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace fathom::operate {

namespace {

constexpr size_t kMaxHistory = 64;

// base_q_shape with its z along n.
dquat turnTo(const dvec3& n) {
    const dvec3 z = glm::normalize(n);
    const dvec3 x = glm::normalize(glm::cross(std::abs(z.x) < 0.9 ? dvec3(1, 0, 0) : dvec3(0, 1, 0), z));
    return glm::quat_cast(glm::dmat3(x, glm::cross(z, x), z));
}

// Why no spare row is left for a new class of points.
std::string noSpare(const std::vector<FixtureClass>& fixtures) {
    const auto points = std::ranges::count_if(fixtures, [](const FixtureClass& f) { return f.isPoints(); });
    return points >= shared::kMaxClasses
               ? "not added: at most " + std::to_string(shared::kMaxClasses) + " classes of points"
               : "not added: two new classes per run; save (Ctrl S) and open the scene again for more";
}

std::string because(const char* what, const std::string& why) {
    return why.empty() ? "" : std::string(what) + ": " + why;
}

} // namespace

FixtureEditor::FixtureEditor(const Scene& scene,
                             std::function<void(const Scene&, const std::vector<Shape>&)> onChange)
    : scene_(scene)
    , shapes_(shapesOf(scene))
    , onChange_(std::move(onChange))
    , saved_(rows()) {}

std::string FixtureEditor::freeName(const std::string& stem) const {
    for (int i = 1;; ++i) {
        const std::string name = stem + " " + std::to_string(i);
        if (std::ranges::none_of(scene_.fixtures, [&](const auto& f) { return f.name == name; })) {
            return name;
        }
    }
}

std::string FixtureEditor::takePicked(Console& console) {
    Scene next = scene_;
    const auto count = static_cast<int>(next.fixtures.size());
    const int row = console.pick.row;
    const auto spare = row >= 0 ? next.fixtures.begin() + std::min(row, count)
                                : std::ranges::find_if(next.fixtures, isSpare);
    if (row < 0) { // the name may be taken or empty by now
        const std::string wanted = console.pick.gates.name;
        const bool free =
            wanted.find_first_not_of(' ') != std::string::npos &&
            std::ranges::none_of(next.fixtures, [&](const FixtureClass& f) { return f.name == wanted; });
        console.pick.gates.name = free ? wanted : freeName("picked");
    }
    std::string problem;
    if (!console.pick.taken) {
        problem = "not added: no colour is picked";
    } else if (spare == next.fixtures.end()) {
        problem = noSpare(next.fixtures);
    } else if (row >= 0 && spare->name != console.pick.gates.name) { // undo may have moved rows
        problem = "not changed: '" + console.pick.gates.name + "' is in another row now";
    } else {
        *spare = console.pick.gates;
        spare->largestPart =
            row < 0 ? spare->role == Role::Guidance && console.pick.rules.onlyClicked : spare->largestPart;
        lastTaken_ = spare->name;
        problem = because(row < 0 ? "not added" : "not changed", apply(std::move(next)));
    }
    console.pick = Pick{};
    selection_.clear();
    ++selectionNumber_;
    return problem;
}

FixtureClass FixtureEditor::shapeAt(ShapeKind kind, const dvec3& base, const dvec3& normal) const {
    constexpr const char* kNames[] = {"", "sphere", "box", "plane", "cylinder", "line", "axis"};
    FixtureClass shape;
    shape.name = freeName(kNames[static_cast<int>(kind)]);
    shape.shape = kind;
    shape.role = kind == ShapeKind::Line || kind == ShapeKind::Axis ? Role::Guidance : Role::Forbidden;
    shape.baseTshape = {base, turnTo(normal)};
    shape.size = kind == ShapeKind::Box        ? dvec3(0.1)
                 : kind == ShapeKind::Cylinder ? dvec3(0.04, 0.1, 0)
                                               : dvec3(0.05, 0, 0);
    return shape;
}

std::string FixtureEditor::place(const FixtureClass& shape) {
    const auto rows = std::ranges::count_if(scene_.fixtures, std::not_fn(isSpare));
    if (static_cast<size_t>(rows) >= Scene::kMaxFixtures) {
        return "not placed: at most " + std::to_string(Scene::kMaxFixtures) + " fixtures";
    }
    Scene next = scene_;
    next.fixtures.push_back(shape);
    return because("not placed", apply(std::move(next)));
}

std::string FixtureEditor::change(size_t row, const FixtureClass& to) {
    Scene next = scene_;
    next.fixtures.at(row) = to;
    return because("not changed", apply(std::move(next)));
}

std::string FixtureEditor::rename(size_t row, const std::string& name) {
    FixtureClass renamed = scene_.fixtures.at(row);
    if (name == renamed.name) {
        return "";
    }
    const bool taken =
        std::ranges::any_of(scene_.fixtures, [&](const FixtureClass& f) { return f.name == name; });
    renamed.name = name;
    if (name.find_first_not_of(' ') == std::string::npos || isSpare(renamed)) {
        return "not renamed: a name needs a letter or digit";
    }
    if (taken) {
        return "not renamed: '" + name + "' exists already";
    }
    return change(row, renamed);
}

// The row of a class of points becomes a spare row; the row of a shape is erased.
void FixtureEditor::remove(size_t row) {
    Scene next = scene_;
    FixtureClass& f = next.fixtures.at(row);
    if (f.isPoints()) {
        FixtureClass spare = withSpareClasses(Scene{}).fixtures.front();
        spare.role = f.role;
        f = spare;
    } else {
        next.fixtures.erase(next.fixtures.begin() + static_cast<std::ptrdiff_t>(row));
    }
    apply(std::move(next));
}

std::string FixtureEditor::apply(Scene next) {
    std::swap(scene_, next);
    try {
        Scene read;
        loadFixtures(YamlNode::parseText(scene_.file.filename(), "fixtures:\n" + rows()).at("fixtures"),
                     read);
    } catch (const BadInput& e) {
        std::swap(scene_, next);
        return e.what();
    }
    undo_.push_back(std::move(next.fixtures));
    if (undo_.size() > kMaxHistory) {
        undo_.erase(undo_.begin());
    }
    redo_.clear();
    notifyChange();
    return "";
}

void FixtureEditor::keepSettings(const Scene::Window& window, const std::string& pilot) {
    scene_.window = window;
    scene_.choosePilot(pilot);
}

bool FixtureEditor::restore(std::vector<std::vector<FixtureClass>>& from,
                            std::vector<std::vector<FixtureClass>>& to) {
    if (from.empty()) {
        return false;
    }
    to.push_back(std::exchange(scene_.fixtures, std::move(from.back())));
    from.pop_back();
    notifyChange();
    return true;
}

bool FixtureEditor::undo() {
    return restore(undo_, redo_);
}

bool FixtureEditor::redo() {
    return restore(redo_, undo_);
}

void FixtureEditor::showFixtures(const Scene& scene) {
    scene_.fixtures = scene.fixtures;
    shapes_ = shapesOf(scene_);
    undo_.clear();
    redo_.clear();
    saved_ = rows();
}

void FixtureEditor::notifyChange() {
    shapes_ = shapesOf(scene_);
    onChange_(scene_, shapes_);
}

} // namespace fathom::operate
