// SPDX-License-Identifier: Apache-2.0
// Values that are changed in the text of a scene file.
#include "apps/tune/scene_text.h"
#include "engine/scene/scene.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::tune;

namespace {

const std::vector<SceneValue> kValues{{{"filter", "radius"}, "3", "radius 3: fastest"},
                                      {{"filter", "memory"}, "8", "memory 8"},
                                      {{"error_budget"}, "0.0003", "budget"},
                                      {{"haptics", "friction"}, "0.05", "friction"},
                                      {{"contact", "reach"}, "0.02", "reach"}};
constexpr const char* kRest = "fixtures: [{name: a, role: forbidden}] # all of it\n"
                              "tool: {spheres: [[0, 0, 0, 0.01]]}\n";

Scene changed(const std::string& text) {
    return loadSceneText(withValues(text, kValues), "changed");
}

void checkValues(const Scene& scene) {
    CHECK(scene.filter.radius == 3);
    CHECK(scene.filter.memory == 8);
    CHECK(scene.errorBudget == 0.0003);
    CHECK(scene.haptics.friction == 0.05);
    CHECK(scene.contact.reach == 0.02);
}

} // namespace

TEST_CASE("Values are replaced in flow and in block style, and all other text stays") {
    const std::string flow = "# mine\nfilter: { radius: 2, sigma: 0.02 } # why\nerror_budget: 0.0001\n" +
                             std::string(kRest) + "haptics: {device: ideal, friction: 0.1}\n";
    checkValues(changed(flow));
    CHECK(withValues(flow, kValues) ==
          "# mine\n# tune: radius 3: fastest\n# tune: memory 8\n"
          "filter: { memory: 8, radius: 3, sigma: 0.02 } # why\n# tune: budget\nerror_budget: 0.0003\n" +
              std::string(kRest) + "# tune: friction\nhaptics: {device: ideal, friction: 0.05}\n" +
              "# tune: reach\ncontact: { reach: 0.02 }\n");
    const std::string block = "filter:\n  # inner\n  radius: 2 # px\n  sigma: 0.02\n" + std::string(kRest) +
                              "haptics:\n    device: ideal\ncontact:\n  where: cpu\n";
    checkValues(changed(block));
    CHECK(changed(block).filter.sigma == 0.02);
    CHECK(withValues(block, kValues).find("  radius: 3 # px\n  sigma: 0.02\n") != std::string::npos);
}

TEST_CASE("Missing sections are appended once with all of their values") {
    const std::string text = withValues(kRest, kValues);
    checkValues(loadSceneText(text, "appended"));
    CHECK(text.find("filter: { radius: 3, memory: 8 }\n") != std::string::npos);
    CHECK(text.find(kRest) == 0);
    checkValues(changed(std::string(kRest).substr(0, std::string(kRest).size() - 1))); // no end of line
}

TEST_CASE("A file in flow style, one with quoted keys and one with an anchor keep their meaning") {
    checkValues(changed("{fixtures: [{name: a, role: forbidden}], tool: {spheres: [[0, 0, 0, 0.01]]}}\n"));
    checkValues(changed("\"filter\": {\"radius\": 2}\n" + std::string(kRest)));
    const Scene scene = changed("error_budget: &small 0.0001\nhold_s: *small\n" + std::string(kRest));
    checkValues(scene);
    CHECK(scene.holdSeconds == 0.0001);
}

TEST_CASE("Quoted values are replaced whole, also with a longer text") {
    const std::string text = "hand: {path: 'a b.csv'}\n";
    CHECK(withValues(text, {{{"hand", "path"}, "\"../a b.csv\""}}) == "hand: {path: \"../a b.csv\"}\n");
}

TEST_CASE("Comments are wrapped and marked, and those of an earlier run are removed") {
    const std::string words = commentLines(std::string(60, 'x') + " " + std::string(60, 'y') + "\nz");
    CHECK(words ==
          "# tune: " + std::string(60, 'x') + "\n# tune:   " + std::string(60, 'y') + "\n# tune: z\n");
    CHECK(withoutComments("# mine\n" + words + "a: 1\n") == "# mine\na: 1\n");
}
