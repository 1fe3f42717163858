// SPDX-License-Identifier: Apache-2.0
// STL files as text: what the mesh library would lose without a word.
#include "engine/model/mesh_file.h"
#include "engine/types/error.h"
#include "tests/support/scratch_folder.h"

#include <algorithm>
#include <cctype>
#include <doctest/doctest.h>

using namespace fathom;

namespace {

std::string facetText(const std::string& corners) {
    return "facet normal 0 0 1\nouter loop\n" + corners + "endloop\nendfacet\n";
}

const std::string kFacet = facetText("vertex 0 0 0\nvertex 0.1 0 0\nvertex 0 0.1 0\n");
const std::string kOther = facetText("vertex 0 0 0\nvertex 0 0.1 0\nvertex 0 0 0.1\n");

// Number of triangles, or the refusal.
std::string readStl(const std::string& text) {
    const testing::ScratchFile file("text.stl", text);
    try {
        return std::to_string(loadMesh(file.path()).mesh.triangles.size());
    } catch (const BadInput& e) {
        return e.what();
    }
}

bool refusesStl(const std::string& text, const std::string& why) {
    const std::string result = readStl(text);
    INFO(result);
    CHECK(result.find(".stl: mesh: ") != std::string::npos);
    return result.find(why) != std::string::npos;
}

} // namespace

TEST_CASE("A text STL is read with names of any words, several solids and Windows line ends") {
    CHECK(readStl("solid a\n" + kFacet + kOther + "endsolid a\n") == "2");
    CHECK(readStl("solid vertex\n" + kFacet + "endsolid\n") == "1");
    CHECK(readStl("solid\n" + kFacet + "endsolid\nsolid b\n" + kOther + "endsolid b") == "2");
    std::string windows = "solid a\n" + kFacet + "endsolid a\n";
    for (size_t at = 0; (at = windows.find('\n', at)) != std::string::npos; at += 2) {
        windows.replace(at, 1, "\r\n");
    }
    CHECK(readStl(windows) == "1");
}

TEST_CASE("A text STL that is cut off anywhere is rejected") {
    const std::string whole = "solid a\n" + kFacet + kOther + "endsolid a\n";
    for (size_t size = 10; size <= whole.find("endsolid") + 7; ++size) {
        CHECK_MESSAGE(readStl(whole.substr(0, size)).size() > 3, whole.substr(0, size));
    }
    CHECK(refusesStl("solid a\n" + kFacet + kOther, "cut off: no endsolid behind facet 2"));
    CHECK(refusesStl("solid a\n" + kFacet + "endsolid a\nsolid b\n" + kOther,
                     "cut off: no endsolid behind facet 2"));
}

TEST_CASE("A text STL with a facet that is no triangle is rejected with its number") {
    CHECK(refusesStl("solid a\n" + kFacet +
                         facetText("vertex 0 0 0\nvertex 0 0.1 0\nvertex 0 0.1 0.1\nvertex 0 0 0.1\n") +
                         kOther + "endsolid a\n",
                     "facet 2 has 4 vertices"));
    CHECK(refusesStl("solid a\n" + facetText("vertex 0 0 0\nvertex 0 0.1 0\n") + kFacet + "endsolid a\n",
                     "facet 1 has 2 vertices"));
}

TEST_CASE("A text STL with capital keywords or behind blank lines is read like any other") {
    std::string capital = "solid a\n" + kFacet + kOther + "endsolid a\n";
    std::transform(capital.begin(), capital.end(), capital.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    CHECK(readStl(capital) == "2");
    CHECK(readStl("solid a\n" + kFacet + "endsolid a\n" + capital) == "2");
    CHECK(readStl("\n \n  solid a\n" + kFacet + "endsolid a\n") == "1");
    CHECK(refusesStl(capital.substr(0, capital.size() - 20), "cut off"));
}

TEST_CASE("An STL without facets is rejected as such, and one of several solids may have none") {
    CHECK(refusesStl("solid a\nendsolid a\n", "no facets"));
    CHECK(refusesStl(std::string(84, '\0'), "no facets"));
    const std::string none = "solid none\nendsolid none\n", one = "solid a\n" + kFacet + "endsolid a\n";
    CHECK(readStl(none + one) == "1");
    CHECK(readStl(one + "  SOLID none\r\nENDSOLID none\r\n" + "solid b\n" + kOther + "endsolid b\n") == "2");
    std::string returns = none + one + "solid b\n" + kOther + "endsolid b\n"; // line ends of old systems
    std::ranges::replace(returns, '\n', '\r');
    CHECK(readStl(returns) == "2");
}

TEST_CASE("A binary STL may end in padding, and is rejected with both sizes where its count is wrong") {
    const auto binary = [](const std::string& title, char facets) {
        std::string bytes = title;
        bytes.resize(80, ' ');
        bytes += std::string{facets, 0, 0, 0};
        const float corners[12] = {0, 0, 1, 0, 0, 0, 0.1f, 0, 0, 0, 0.1f, 0};
        return bytes + std::string(reinterpret_cast<const char*>(corners), sizeof corners) +
               std::string(2, '\0');
    };
    for (const char* title : {"", "solid cube"}) {
        CHECK(readStl(binary(title, 1)) == "1");
        CHECK(readStl(binary(title, 1) + "\n") == "1");
        CHECK(readStl(binary(title, 1) + std::string(49, '\0')) == "1");
        CHECK(refusesStl(binary(title, 1) + std::string(50, '\0'),
                         "1 facets take 134 bytes, the file has 184"));
        CHECK(refusesStl(binary(title, 2), "2 facets take 184 bytes, the file has 134"));
    }
    CHECK(refusesStl("an STL?", "neither a text that begins with 'solid' nor a binary STL"));
}

TEST_CASE("A text STL with a byte order mark, or with normals that are no numbers, is read") {
    const std::string text = "solid normal a\n" + kFacet + kOther + "endsolid normal a\n";
    CHECK(readStl("\xef\xbb\xbf" + text) == "2");
    for (const std::string odd : {"-nan(ind) -nan(ind) -nan(ind)", "-1.#IND 1.#QNAN 0"}) {
        std::string other = text;
        for (size_t at = 0; (at = other.find("0 0 1\nouter", at)) != std::string::npos; at += odd.size()) {
            other.replace(at, 5, odd);
        }
        CHECK(readStl(other) == "2");
    }
}
