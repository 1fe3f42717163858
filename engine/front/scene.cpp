// SPDX-License-Identifier: Apache-2.0
#include "engine/front/core.h"
#include "engine/front/float_mode.h"
#include "engine/run/open_scene.h"

namespace fathom::v0 {

namespace {

std::shared_ptr<const Scene::Data> shared(fathom::Scene scene) {
    return std::make_shared<const Scene::Data>(Scene::Data{std::move(scene)});
}

} // namespace

Scene::Scene(std::shared_ptr<const Data> data)
    : data_(std::move(data)) {}

Scene Scene::fromFile(const std::filesystem::path& file) {
    return front::translated([&] {
        const front::FloatMode mode;
        return Scene(shared(openScene(file)));
    });
}

Scene Scene::fromText(const std::string& yaml) {
    return front::translated([&] {
        const front::FloatMode mode; // numbers of the text are rounded
        return Scene(shared(openSceneText(yaml)));
    });
}

std::size_t Scene::fixtures() const noexcept {
    return data_->scene.fixtures.size();
}

const std::string& Scene::fixtureName(std::size_t fixture) const {
    static const std::string kSurface = "visible surface";
    if (fixture == kNoFixture) {
        return kSurface;
    }
    if (fixture >= fixtures()) {
        throw BadInput("fixture " + std::to_string(fixture) + " (allowed: below " +
                       std::to_string(fixtures()) + ")");
    }
    return data_->scene.fixtures[fixture].name;
}

} // namespace fathom::v0
