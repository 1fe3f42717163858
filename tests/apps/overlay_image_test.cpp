// SPDX-License-Identifier: Apache-2.0
#include "apps/replay/overlay_image.h"

#include "apps/output/image.h"
#include "apps/output/silhouette.h"
#include "engine/types/error.h"
#include "tests/apps/png_image.h"
#include "tests/support/scratch_folder.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <random>

using namespace fathom;
using namespace fathom::testing;

namespace {

CameraInfo smallCamera() {
    CameraInfo camera;
    camera.depth = {161, 121, 150.0, 148.0, 80.3, 60.7, {}};
    camera.colour = camera.depth;
    return camera;
}

// True when the ray through the centre of the enlarged pixel hits the sphere, which defines a silhouette.
bool hits(const ImageView& view, int u, int v, const dvec3& c, double radius) {
    const double x = ((u + 0.5) / view.scale - 0.5 - view.lens.cx) / view.lens.fx;
    const double y = ((v + 0.5) / view.scale - 0.5 - view.lens.cy) / view.lens.fy;
    const dvec3 ray = glm::normalize(dvec3(x, y, 1.0));
    const double along = glm::dot(ray, c);
    const double squared = glm::dot(c, c) - along * along;
    return glm::dot(c, c) <= radius * radius || (along > 0.0 && squared <= radius * radius);
}

struct Drawn {
    HostFixtures set;
    std::vector<uint32_t> colour;
    OverlayInput input;
};

void fill(Drawn& scene) {
    scene.set.frame = 3;
    scene.set.camera = smallCamera();
    scene.colour.assign(scene.set.camera.depth.pixels(), 0xff804020u); // red 0x20, green 0x40, blue 0x80
    RegionSpheres& s = scene.set.spheres;
    s.resize(1);
    s.x[0] = -0.1f, s.y[0] = 0.0f, s.z[0] = 0.5f, s.radius[0] = 0.06f, s.source[0] = 5, s.fixture[0] = 0;
    scene.input.camera = scene.set.camera;
    scene.input.colour = scene.colour;
    scene.input.set = &scene.set;
}

} // namespace

TEST_CASE("The silhouette of random spheres is the set of pixels whose ray hits one, also near and around "
          "the camera") {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> place(-0.6, 0.6), size(0.005, 0.3);
    const ImageView view =
        imageView(smallCamera(), Pose{{0.2, 0, -0.1}, rotationExp({0.1, -0.2, 0.3})}, false, 300);
    CHECK(view.scale == 2);
    for (const int count : {0, 1, 2, 3, 5}) {
        for (int repeat = 0; repeat < 12; ++repeat) {
            Silhouette silhouette(view);
            std::vector<Sphere> seen;
            for (int i = 0; i < count; ++i) {
                const dvec3 c(place(random), place(random), place(random) + 0.3);
                const double radius = size(random);
                silhouette.add(inverse(view.cameraTbase).apply(c), radius);
                seen.push_back({c, radius});
            }
            const auto mask = silhouette.mask();
            uint64_t wrong = 0;
            for (int v = 0; v < view.height(); ++v) {
                for (int u = 0; u < view.width(); ++u) {
                    const bool expected = std::any_of(seen.begin(), seen.end(), [&](const Sphere& s) {
                        return hits(view, u, v, s.centre, s.radius);
                    });
                    wrong += expected != (mask[static_cast<size_t>(v * view.width() + u)] != 0);
                }
            }
            CHECK(wrong <= 2); // rays that graze a sphere may differ by rounding
        }
    }
}

TEST_CASE("Masks of dense regions leave out covered spheres, and are the same as with all of them") {
    Drawn scene;
    scene.set.camera = smallCamera();
    scene.set.camera.depth.distortion = {0.1, -0.05, 0.001, 0.002, 0.0};
    const ImageView view = imageView(scene.set.camera, Pose{{0.0, 0.0, -0.1}, {}}, true, 300);
    std::mt19937_64 random(5);
    std::uniform_real_distribution<float> place(-0.12f, 0.12f), size(0.02f, 0.04f);
    for (int repeat = 0; repeat < 10; ++repeat) {
        RegionSpheres& s = scene.set.spheres;
        s.resize(1500);
        Silhouette seen(view), held(view);
        for (size_t i = 0; i < s.size(); ++i) {
            s.x[i] = place(random) + 0.06f * static_cast<float>(repeat); // the last ones leave the image
            s.y[i] = place(random), s.z[i] = 0.4f + place(random), s.radius[i] = size(random);
            s.source[i] = static_cast<uint32_t>(i) + (i % 3 == 0 ? scene.set.camera.depth.pixels() : 0u);
            (i % 3 == 0 ? held : seen).add(regionCentre(scene.set, i), double{s.radius[i]});
        }
        const RegionMasks masks = regionMasks(view, scene.set);
        std::vector<uint8_t> onlyHeld = held.mask();
        const std::vector<uint8_t> all = seen.mask();
        for (size_t i = 0; i < all.size(); ++i) {
            onlyHeld[i] = all[i] != 0 ? 0 : onlyHeld[i];
        }
        CHECK(masks.seen == all);
        CHECK(masks.held == onlyHeld);
    }
}

TEST_CASE("The outline of a mask is closed inside the image, open at its edge, and surrounds holes") {
    const int width = 40, height = 30;
    std::vector<uint8_t> mask(width * height);
    CHECK(traceOutline(mask, width, height, 0).empty());
    const auto box = [&](int u0, int v0, int u1, int v1, uint8_t value) {
        for (int v = v0; v < v1; ++v) {
            for (int u = u0; u < u1; ++u) {
                mask[static_cast<size_t>(v * width + u)] = value;
            }
        }
    };
    box(10, 8, 24, 22, 1);
    box(14, 12, 20, 18, 0);
    auto lines = traceOutline(mask, width, height, 0);
    REQUIRE(lines.size() == 2);
    for (const OutlineLine& line : lines) {
        CHECK(line.front() == line.back());
    }
    CHECK(lines[0].size() == 4 * 14 + 1);
    CHECK(lines[1].size() == 4 * 6 + 1);
    CHECK(traceOutline(mask, width, height, 30).size() == 1); // the hole's outline is shorter than 30
    box(0, 0, width, height, 0);
    box(0, 5, 6, 11, 1); // touches the left edge
    lines = traceOutline(mask, width, height, 0);
    REQUIRE(lines.size() == 1);
    CHECK(lines[0].size() == 3 * 6 + 1);
    CHECK(std::min(lines[0].front().x, lines[0].back().x) == 0.0);
    CHECK(lines[0].front() != lines[0].back());
    box(0, 0, width, height, 1);
    CHECK(traceOutline(mask, width, height, 0).empty()); // all of it is at the edge
}

TEST_CASE("A point projects to the pixel that the lens model gives, with distortion and the colour camera's "
          "offset") {
    CameraInfo camera = smallCamera();
    camera.registered = false;
    camera.colour = {320, 240, 310.0, 312.0, 158.0, 121.0, {0.1, -0.05, 0.001, 0.002, 0.0}};
    camera.colourTdepth = {{0.02, 0.001, 0.0}, rotationExp({0.0, 0.02, 0.0})};
    const Pose baseTcamera{{1, 2, 3}, rotationExp({0.2, 0.1, 0.0})};
    const ImageView view = imageView(camera, baseTcamera, false, 960);
    CHECK(view.scale == 3);
    const dvec3 inDepth(0.05, -0.04, 0.6);
    const glm::dvec2 expected = (camera.colour.project(camera.colourTdepth.apply(inDepth)) + 0.5) * 3.0;
    const auto pixel = view.ofBase(baseTcamera.apply(inDepth));
    REQUIRE(pixel.has_value());
    CHECK(glm::distance(*pixel, expected) < 1e-9);
    CHECK(!view.ofBase(baseTcamera.apply({0, 0, -0.5})).has_value());
}

TEST_CASE("The overlay is red over a region, has the image's colour outside, and is at least 960 wide") {
    const ScratchFolder folder;
    Drawn scene;
    fill(scene);
    drawOverlay(scene.input).writePng(folder.path() / "overlay.png");
    const PngImage image(folder.path() / "overlay.png");
    CHECK(image.width() == 161 * 6);
    CHECK(image.height() > 121 * 6);
    const int u = static_cast<int>((80.3 + 150.0 * -0.2 + 0.5) * 6), v = static_cast<int>((60.7 + 0.5) * 6);
    CHECK(image.red(u + 20, v + 20) > image.red(900, 60) + 30);
    CHECK(image.blue(u + 20, v + 20) < image.blue(900, 60));
    CHECK(image.blue(900, 60) > image.red(900, 60) + 50); // byte order: blue stays blue
}

TEST_CASE(
    "Without colour the overlay shows depth as grey, without both a plain background, also without a set") {
    const ScratchFolder folder;
    Drawn scene;
    fill(scene);
    std::vector<uint16_t> depth(scene.set.camera.depth.pixels());
    for (size_t i = 0; i < depth.size(); ++i) {
        depth[i] = static_cast<uint16_t>(i % 161 < 80 ? 400 : 900);
    }
    scene.input.colour = {};
    scene.input.depth = depth;
    scene.input.set = nullptr;
    const auto path = folder.path() / "overlay.png";
    drawOverlay(scene.input).writePng(path);
    {
        const PngImage image(path);
        CHECK(std::abs(image.red(100, 300) - image.blue(100, 300)) <= 2);
        CHECK(image.red(100, 300) > image.red(800, 300) + 50); // near is bright
    }
    scene.input.depth = {};
    const std::vector<Sphere> leaves{{{0, 0, 0}, 0.02}, {{0.03, 0, 0}, 0.02}};
    scene.input.leaves = leaves;
    scene.input.tick.tool.position = {0, 0, 0.4};
    scene.input.tick.device.position = {0, 0, -1.0}; // behind the camera
    scene.input.tick.wrench.force = {0, std::nan(""), 0};
    scene.input.tick.guidance = std::nan("");
    std::filesystem::remove(path); // read above, and inputs are never replaced
    drawOverlay(scene.input).writePng(path);
    scene.input.camera = CameraInfo{};
    CHECK_THROWS_AS(drawOverlay(scene.input).writePng(path), Error);
    CHECK(folder.files() == 1);
}

TEST_CASE("An overlay of 60 thousand spheres has twice the width of its camera's images") {
    const ScratchFolder folder;
    Drawn scene;
    fill(scene);
    CameraInfo camera;
    camera.depth = {640, 480, 570.0, 570.0, 320.0, 240.0, {}};
    camera.colour = camera.depth;
    scene.set.camera = scene.input.camera = camera;
    scene.colour.assign(camera.depth.pixels(), 0xff808080u);
    scene.input.colour = scene.colour;
    RegionSpheres& s = scene.set.spheres;
    s.resize(60000);
    for (size_t i = 0; i < s.size(); ++i) {
        const size_t row = i / 300;
        s.x[i] = 0.001f * static_cast<float>(i % 300) - 0.15f;
        s.y[i] = 0.001f * static_cast<float>(row) - 0.1f;
        s.z[i] = 0.5f;
        s.radius[i] = 0.04f;
        s.source[i] = static_cast<uint32_t>(i);
        s.fixture[i] = 0;
    }
    drawOverlay(scene.input).writePng(folder.path() / "overlay.png");
    CHECK(PngImage(folder.path() / "overlay.png").width() == 1280);
}

TEST_CASE("The outline of spheres is the border of their mask, also at the edges of the image") {
    ImageView view;
    view.lens.width = 160, view.lens.height = 120;
    view.lens.fx = view.lens.fy = 150.0;
    view.lens.cx = 79.5, view.lens.cy = 59.5;
    const std::vector<std::vector<Sphere>> all{{{{0.0, 0.0, 1.0}, 0.1}, {{0.15, 0.05, 1.2}, 0.05}},
                                               {{{0.5, 0.0, 1.0}, 0.1}},
                                               {{{-0.5, -0.4, 1.0}, 0.2}, {{0.2, 0.2, 0.9}, 0.02}},
                                               {{{0.0, 0.0, 0.1}, 0.2}},
                                               {{{3.0, 0.0, 1.0}, 0.1}}};
    for (const std::vector<Sphere>& spheres : all) {
        Silhouette silhouette(view);
        for (const Sphere& s : spheres) {
            silhouette.add(s.centre, s.radius);
        }
        const auto cropped = outlineOf(view, spheres), whole = traceOutline(silhouette.mask(), 160, 120, 0);
        REQUIRE(cropped.size() == whole.size());
        for (size_t line = 0; line < whole.size(); ++line) {
            REQUIRE(cropped[line].size() == whole[line].size());
            for (size_t k = 0; k < whole[line].size(); ++k) {
                CHECK(glm::distance(cropped[line][k], whole[line][k]) < 1e-9);
            }
        }
    }
}

TEST_CASE("The tint of a tool that leaves the image covers the tool in the image, and nothing else") {
    const ScratchFolder folder;
    Drawn scene;
    fill(scene);
    scene.input.set = nullptr;
    std::vector<Sphere>
        leaves; // a link that enters through the upper edge, turns, and leaves through the lower
    for (int i = 0; i <= 40; ++i) {
        leaves.push_back({{0.003 * std::abs(i - 20) - 0.53, 0.012 * (i - 20), 0.0}, 0.02});
    }
    scene.input.leaves = leaves;
    scene.input.tick.tool.position = scene.input.tick.device.position = {0.5, 0.0, 0.5}; // has a mark
    drawOverlay(scene.input).writePng(folder.path() / "overlay.png");
    const PngImage image(folder.path() / "overlay.png");
    const ImageView view = imageView(scene.set.camera, Pose{}, true, 960);
    const int plain = image.red(900, 60);
    uint64_t wrong = 0, tinted = 0;
    for (int v = 12; v < view.height() - 12; v += 7) {
        for (int u = 12; u < view.width() - 12; u += 7) {
            const auto near = [&](double more) { // inside the tool made larger by `more`
                return std::any_of(leaves.begin(), leaves.end(), [&](const Sphere& s) {
                    return hits(view, u, v, s.centre + scene.input.tick.tool.position, s.radius + more);
                });
            };
            const bool inside = near(-0.004), outside = !near(0.006);
            wrong +=
                (inside && image.red(u, v) < plain + 20) || (outside && image.red(u, v) > plain + 8) ? 1 : 0;
            tinted += inside ? 1 : 0;
        }
    }
    CHECK(tinted > 300);
    CHECK(wrong == 0);
}
