// SPDX-License-Identifier: Apache-2.0
#include "engine/front/core.h"
#include "engine/run/open_scene.h"

namespace fathom::v0 {

namespace {

std::shared_ptr<const Scene::Data> checked(fathom::Scene scene) {
    front::requireSupported(scene);
    return std::make_shared<const Scene::Data>(Scene::Data{std::move(scene)});
}

} // namespace

Scene::Scene(std::shared_ptr<const Data> data)
    : data_(std::move(data)) {}

Scene Scene::fromFile(const std::filesystem::path& file) {
    return front::translated([&] { return Scene(checked(openScene(file))); });
}

Scene Scene::fromText(const std::string& yaml) {
    return front::translated([&] { return Scene(checked(openSceneText(yaml))); });
}

} // namespace fathom::v0
