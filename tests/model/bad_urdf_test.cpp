// SPDX-License-Identifier: Apache-2.0
// What is wrong with a robot is said in one line that names the file.
#include "tests/model/urdf_text.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

bool saysOnly(const std::string& refusal, const std::string& words) {
    INFO(refusal);
    CHECK(refusal.find(".urdf: ") != std::string::npos);
    CHECK(refusal.find('\n') == std::string::npos);
    return refusal.find(words) != std::string::npos;
}

std::string withLimit(const std::string& limit) {
    return ballLink("a") + ballLink("b") + jointText("j", "revolute", "a", "b", "0 0 0", "0 0 1", limit);
}

} // namespace

TEST_CASE("Two roots, circles, limits that are crossed or no numbers, and too many links are rejected in one "
          "line") {
    CHECK(saysOnly(urdfRefusal(ballLink("a") + ballLink("b")), "root"));
    CHECK(saysOnly(urdfRefusal(ballLink("a") + ballLink("b") +
                               jointText("j", "revolute", "a", "b", "0 0 0", "0 0 1") +
                               jointText("k", "revolute", "b", "a", "0 0 0", "0 0 1")),
                   "root"));
    CHECK(saysOnly(urdfRefusal(withLimit("<limit lower='1' upper='-1' velocity='1' effort='1'/>")),
                   "joint j: limits missing or crossed (allowed: lower <= upper)"));
    CHECK(saysOnly(urdfRefusal(withLimit("<limit lower='nan' upper='1' velocity='1' effort='1'/>")),
                   "(allowed: "));
    CHECK(saysOnly(urdfRefusal(withLimit("<limit lower='0' upper='many' velocity='1' effort='1'/>")),
                   "(allowed: "));
    CHECK(saysOnly(urdfRefusal(withLimit("")), "(allowed: "));
    std::string many;
    for (int i = 0; i < 50'000; ++i) {
        many += "<link name='";
        many += std::to_string(i);
        many += "'/>";
    }
    CHECK(saysOnly(urdfRefusal(many), "(allowed: "));
    CHECK(saysOnly(urdfRefusal(many + std::string(16u << 20, ' ')), "16 MiB"));
}
